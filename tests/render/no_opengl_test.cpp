// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdlib>

#include "render/film_recorder.h"
#include "render/renderer.h"
#include "tests/support/six_rods.h"

namespace cprsim {
namespace {

TEST(WithoutOpenGl, TheReasonNamesThePackages) {
  // the EGL library then finds no driver, as if Mesa were not installed
  setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere", 1);
  const Scene scene = six_rods_scene();
  std::string why_not;
  EXPECT_EQ(Renderer::create(scene, 640, 360, {}, why_not), nullptr);
  EXPECT_NE(why_not.find("libegl-mesa0"), std::string::npos) << why_not;
  EXPECT_NE(why_not.find("libgl1-mesa-dri"), std::string::npos) << why_not;
  const std::string path = testing::TempDir() + "cprsim_never.mp4";
  EXPECT_THROW(FilmRecorder(scene, scene.videos[0], path), std::runtime_error);
}

}  // namespace
}  // namespace cprsim
