// SPDX-License-Identifier: BSD-3-Clause
#include "render/film.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "render/film_recorder.h"
#include "tests/support/six_rods.h"

namespace cprsim {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return std::string((std::istreambuf_iterator<char>(in)), {});
}

class Films : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(testing::TempDir()) /
        ("cprsim_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::create_directories(folder_);
  }

  void TearDown() override { fs::remove_all(folder_); }

  std::string at(const std::string& name) const { return (folder_ / name).string(); }

  /// Is there ffmpeg? If not, the reason must name what to install.
  static bool can_encode() {
    const std::string reason = film_unavailable();
    if (reason.empty()) return true;
    std::printf("no films here: %s\n", reason.c_str());
    EXPECT_NE(reason.find("package ffmpeg"), std::string::npos);
    return false;
  }

  static bool can_draw(const Scene& scene) {
    std::string why_not;
    if (Renderer::create(scene, 64, 64, {}, why_not)) return true;
    EXPECT_NE(why_not.find("libegl-mesa0"), std::string::npos) << why_not;
    return false;
  }

  fs::path folder_;
};

TEST_F(Films, AreWrittenAsideAndThenRenamed) {
  if (!can_encode()) return;
  Film film;
  film.open(at("a.mp4"), 65, 49, 30);
  Image image(65, 49);
  for (int k = 0; k < 5; ++k)
    film.add(image);
  EXPECT_FALSE(fs::exists(at("a.mp4")));
  film.close();
  const std::string bytes = bytes_of(at("a.mp4"));
  EXPECT_EQ(bytes.substr(4, 4), "ftyp");
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat")) << "the index comes first";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(Films, ThatAreDroppedLeaveNothing) {
  if (!can_encode()) return;
  {
    Film film;
    film.open(at("a.mp4"), 64, 48, 30);
    film.add(Image(64, 48));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Films, SayWhyTheyCannotBeWritten) {
  if (!can_encode()) return;
  Film film;
  EXPECT_THROW(film.open(at("no/such/folder/a.mp4"), 64, 48, 30), std::runtime_error);
  EXPECT_THROW(film.open(at("a.mp4"), 64, 48, 0), std::runtime_error);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Films, NameThePackageIfFfmpegIsMissing) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  Film film;
  try {
    film.open(at("a.mp4"), 64, 48, 30);
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("package ffmpeg"), std::string::npos);
  }
  setenv("PATH", path.c_str(), 1);
}

TEST_F(Films, TakeFramesAtExactlyKOverFps) {
  Scene scene = six_rods_scene();
  scene.cameras[0].width = 160;
  scene.cameras[0].height = 90;
  if (!can_encode() || !can_draw(scene)) return;
  // steps that never meet a frame, a slow film, and a frame at the very end
  for (const auto& [speed, frames] : {std::pair{1.0, 11}, {0.5, 21}}) {
    VideoSpec video = scene.videos[0];
    video.speed = speed;
    video.fps = 20;
    FilmRecorder recorder(scene, video, at("a.mp4"));
    Snapshot before = six_rods_at(0);
    const int steps = 70;
    for (int k = 1; k <= steps; ++k) {
      Snapshot now = six_rods_at(0.5 * k / steps);
      recorder.observe(before, now);
      before = std::move(now);
    }
    recorder.finish();
    EXPECT_EQ(recorder.frames(), frames);
    EXPECT_GT(fs::file_size(at("a.mp4")), 1000U);
  }
}

TEST_F(Films, AreTheSameBytesTwice) {
  Scene scene = six_rods_scene();
  scene.cameras[0].width = 320;
  scene.cameras[0].height = 180;
  if (!can_encode() || !can_draw(scene)) return;
  for (const char* name : {"a.mp4", "b.mp4"}) {
    FilmRecorder recorder(scene, scene.videos[0], at(name));
    recorder.observe(six_rods_at(0), six_rods_at(0.2));
    recorder.observe(six_rods_at(0.2), six_rods_at(0.5));
    recorder.finish();
    EXPECT_EQ(recorder.frames(), 16);
  }
  EXPECT_EQ(bytes_of(at("a.mp4")), bytes_of(at("b.mp4")));
}

TEST_F(Films, OfAStaticSceneHaveOneFrame) {
  Scene scene = six_rods_scene();
  scene.cameras[0].width = 160;
  scene.cameras[0].height = 90;
  if (!can_encode() || !can_draw(scene)) return;
  FilmRecorder recorder(scene, scene.videos[0], at("a.mp4"));
  recorder.observe(six_rods_at(0), six_rods_at(0));
  recorder.finish();
  EXPECT_EQ(recorder.frames(), 1);
}

}  // namespace
}  // namespace cprsim
