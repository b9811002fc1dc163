// SPDX-License-Identifier: BSD-3-Clause
// cprsim render: a recording in, pictures out.
#include "tests/tools/program.h"

namespace cprsim {
namespace {

class RenderCommand : public ProgramTest {
 protected:
  /// The released rod, recorded coarsely in folder r.
  void record() {
    const std::string csv = "<csv/>";
    std::string text = contents(shipped("scenes/mechanics/released_rod.xml"));
    spill(folder_ / "rod.xml", with(text, csv, "<csv/><hdf5/>"));
    const Answer answer =
        run("run rod.xml -o r --duration 0.1 --no-video --still asked.png@0.05 --still last.png");
    ASSERT_EQ(answer.code, 0) << answer.err;
  }

  std::string recording() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "r"))
      if (entry.path().extension() == ".h5") return entry.path().filename();
    return "";
  }

  double size_of(const std::string& file) const {
    return static_cast<double>(contents(folder_ / file).size());
  }

  bool is_png(const std::string& file) const {
    return contents(folder_ / file).substr(1, 3) == "PNG";
  }
};

TEST_F(RenderCommand, DrawsWhatTheRunWouldHaveDrawn) {
  record();
  const Answer answer = run("render r last2.png asked2.png@0.05 frames/ --fps 50 --speed 0.1");
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_TRUE(answer.says("wrote last2.png")) << answer.out;
  EXPECT_TRUE(is_png("last2.png") && is_png("asked2.png"));
  EXPECT_TRUE(exists("frames/000050.png"));
  EXPECT_FALSE(exists("frames/000051.png"));
  const Answer usual = run("render r again.png asked3.png@0.05");
  ASSERT_EQ(usual.code, 0) << usual.err;
  // quaternions for matrices: a few pixels at edges are other ones
  EXPECT_NEAR(size_of("again.png"), size_of("last.png"), 0.01 * size_of("last.png"));
  EXPECT_NEAR(size_of("asked3.png"), size_of("asked.png"), 0.01 * size_of("asked.png"));
}

TEST_F(RenderCommand, ColoursAndLooksAsItIsTold) {
  record();
  const std::string file = "r/" + recording();
  ASSERT_EQ(run("render " + file + " plain.png").code, 0) << "run.json beside it names the scene";
  ASSERT_EQ(run("render " + file + " grey.png --color-by none --scene rod.xml").code, 0);
  EXPECT_TRUE(contents(folder_ / "grey.png") != contents(folder_ / "plain.png"));
}

TEST_F(RenderCommand, RefusesWhatItCannotDraw) {
  record();
  const std::string file = "r/" + recording();
  spill(folder_ / "none.h5", "no HDF5");
  const std::string robot = shipped("scenes/robots/stewart_gough.xml");
  for (const auto& [words, part] :
       {std::pair<std::string, std::string>(file + " rod.obj", "ends in none of"),
        {file + " a.png --camera nowhere", "has no camera 'nowhere'"},
        {file + " a.png --color-by mood", "--color-by is one of"},
        {file + " a.png --speed -1", "--speed"},
        {"none.h5 a.png --scene rod.xml", "not readable as HDF5"},
        {"none.h5 a.png", "Name it with --scene"},
        {"rod.xml a.png", "neither a run's folder nor an HDF5 file"},
        {". a.png", "no run.json"},
        {file + " a.png --scene " + robot, "the file has no rod"}}) {
    const Answer answer = run("render " + words);
    EXPECT_EQ(answer.code, 2) << words;
    EXPECT_TRUE(answer.complains(part)) << words << answer.err;
  }
  EXPECT_EQ(run("render none.h5 a.png --scene none.xml").code, 3);
  EXPECT_FALSE(exists("a.png"));
}

}  // namespace
}  // namespace cprsim
