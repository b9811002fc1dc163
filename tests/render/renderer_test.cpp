// SPDX-License-Identifier: BSD-3-Clause
// A handful of coarse looks at pixels; on a machine without OpenGL the reason given is looked at
// instead.
#include "render/renderer.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/support/six_rods.h"

namespace cprsim {
namespace {

constexpr int kWidth = 640, kHeight = 360;

class Pictures : public testing::Test {
 protected:
  /// @return whether this machine can draw; if not, the reason must name what to install
  bool start(const Scene& scene, const RenderOptions& options = {}) {
    std::string why_not;
    renderer_ = Renderer::create(scene, kWidth, kHeight, options, why_not);
    if (renderer_) return true;
    std::printf("no OpenGL here: %s\n", why_not.c_str());
    EXPECT_NE(why_not.find("libegl-mesa0"), std::string::npos);
    return false;
  }

  std::unique_ptr<Renderer> renderer_;
};

double difference(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    sum += std::abs(a.pixels[i] - b.pixels[i]);
  return sum / static_cast<double>(a.pixels.size());
}

FrameDecor plain() {
  FrameDecor decor;
  decor.show_time = false;
  return decor;
}

TEST_F(Pictures, ShowSkyAboveThePlatformAndItsColour) {
  const Scene scene = six_rods_scene();
  if (!start(scene)) return;
  const Image image = renderer_->draw(six_rods_at(0), scene.cameras[0], plain());
  EXPECT_GT(image.at(kWidth / 2, 3)[2], 200) << "light sky at the top";
  int orange = 0, blue = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const std::uint8_t* p = image.at(x, y);
      EXPECT_EQ(p[3], 255);
      if (p[0] > 120 && p[0] > 2 * p[2]) ++orange;
      if (p[2] > 100 && p[2] > p[0] + 60) ++blue;
    }
  }
  EXPECT_GT(orange, 500) << "the platform";
  EXPECT_GT(blue, 300) << "the rods";
}

TEST_F(Pictures, AreTheSameTwice) {
  const Scene scene = six_rods_scene();
  if (!start(scene)) return;
  const Image a = renderer_->draw(six_rods_at(0.4), scene.cameras[0], plain());
  renderer_->draw(six_rods_at(0.8), scene.cameras[0], plain());
  EXPECT_EQ(renderer_->draw(six_rods_at(0.4), scene.cameras[0], plain()).pixels, a.pixels);
}

TEST_F(Pictures, OnAStoredBackgroundAreThoseDrawnAnew) {
  const Scene scene = six_rods_scene();
  if (!start(scene)) return;
  renderer_->draw(six_rods_at(0), scene.cameras[0], plain());
  const Image stored = renderer_->draw(six_rods_at(1.2), scene.cameras[0], plain());
  CameraSpec turning = scene.cameras[0];
  turning.orbit_rate = 1e-9;
  const Image anew = renderer_->draw(six_rods_at(1.2), turning, plain());
  // of 255; the half shadows of things above things differ a little
  EXPECT_LT(difference(stored, anew), 0.25);
}

TEST_F(Pictures, LegendAndTextAreWritten) {
  const Scene scene = six_rods_scene();
  if (!start(scene)) return;
  FrameDecor decor = plain();
  const Image bare = renderer_->draw(six_rods_at(0), scene.cameras[0], decor);
  decor.scene_name = scene.name;
  const Image titled = renderer_->draw(six_rods_at(0), scene.cameras[0], decor);
  decor.scene_name = "";
  decor.color_by = ColorBy::kBendingMoment;
  const Image colored = renderer_->draw(six_rods_at(0), scene.cameras[0], decor);
  EXPECT_GT(difference(titled, bare), 0);
  int yellow = 0;
  for (int y = 0; y < kHeight / 2; ++y) {
    for (int x = kWidth * 3 / 4; x < kWidth; ++x) {
      const std::uint8_t* p = colored.at(x, y);
      if (p[0] > 200 && p[1] > 200 && p[2] < 80) ++yellow;
    }
  }
  EXPECT_GT(yellow, 20) << "the bright end of the bar";
}

TEST_F(Pictures, ShadowsDarkenTheGround) {
  Scene scene = six_rods_scene();
  if (!start(scene)) return;
  const Image with = renderer_->draw(six_rods_at(0), scene.cameras[0], plain());
  scene.environment.shadows = false;
  ASSERT_TRUE(start(scene));
  const Image without = renderer_->draw(six_rods_at(0), scene.cameras[0], plain());
  int darker = 0, lighter = 0;
  for (std::size_t i = 0; i < with.pixels.size(); i += 4) {
    darker += with.pixels[i] + 20 < without.pixels[i];
    lighter += with.pixels[i] > without.pixels[i] + 20;
  }
  EXPECT_GT(darker, 1000);
  EXPECT_EQ(lighter, 0);
}

TEST_F(Pictures, OfAnEmptySceneAreOfGroundAndSky) {
  const Scene scene;
  if (!start(scene)) return;
  const Snapshot now;
  const Image image = renderer_->draw(now, camera_or_default(scene, -1, now), plain());
  EXPECT_GT(image.at(kWidth / 2, kHeight - 3)[1], 100);
}

TEST_F(Pictures, OfAStillAreWrittenWhole) {
  const Scene scene = six_rods_scene();
  if (!start(scene)) return;
  const std::string path = testing::TempDir() + "cprsim_still.png";
  CameraSpec camera = scene.cameras[0];
  camera.width = kWidth;
  camera.height = kHeight;
  write_still(path, scene, six_rods_at(0), camera, plain());
  EXPECT_GT(std::filesystem::file_size(path), 10000U);
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  std::filesystem::remove(path);
  EXPECT_THROW(write_still("/nowhere/still.png", scene, six_rods_at(0), camera, plain()),
               std::runtime_error);
}

TEST_F(Pictures, OfImpossibleSizeAreRefusedWithTheLimit) {
  std::string why_not;
  EXPECT_EQ(Renderer::create(six_rods_scene(), 20000, 100, {}, why_not), nullptr);
  EXPECT_NE(why_not.find("16384"), std::string::npos);
}

}  // namespace
}  // namespace cprsim
