// SPDX-License-Identifier: BSD-3-Clause
// cprsim export: a scene in; files for other programs out.
#include "tests/tools/program.h"

namespace cprsim {
namespace {

class Export : public ProgramTest {
 protected:
  const std::string rod_ = shipped("scenes/mechanics/released_rod.xml");
};

TEST_F(Export, WritesASceneAsAModelAndForParaView) {
  const Answer answer =
      run("export " + rod_ + " rod.glb rod.pvd --duration 0.1 --fps 50 --rate 100");
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_TRUE(answer.says("wrote rod.glb, rod.pvd")) << answer.out;
  const std::string model = contents(folder_ / "rod.glb");
  EXPECT_EQ(model.substr(0, 4), "glTF");
  EXPECT_NE(model.find("\"generator\":\"cprsim\""), std::string::npos);
  EXPECT_NE(contents(folder_ / "rod.pvd").find("timestep=\"0.1\""), std::string::npos);
  EXPECT_TRUE(exists("rod_vtk/000010.vtp"));
  EXPECT_FALSE(exists("out"));
}

TEST_F(Export, WritesTheChannelsAskedFor) {
  ASSERT_EQ(run("export " + rod_ + " tip.csv -c wire::rod.tip.position --duration 0.1").code, 0);
  const std::string csv = contents(folder_ / "tip.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "time [s],wire::rod.tip.position.x [m],wire::rod.tip.position.y [m],"
            "wire::rod.tip.position.z [m]");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 102) << "at the rate of the scene's record";
  EXPECT_EQ(run("export tip.csv again.csv").code, 0);
  EXPECT_EQ(contents(folder_ / "again.csv"), csv);
  EXPECT_EQ(run("export tip.csv x.csv -c wire::rod.tip.position.x").code, 0);
  EXPECT_EQ(contents(folder_ / "x.csv").find("position.y"), std::string::npos);
}

TEST_F(Export, RefusesWhatItCannotDo) {
  spill(folder_ / "bad.xml", "<sdf/>");
  spill(folder_ / "table.csv", "t,a\n0,1\n");
  for (const auto& [words, code, part] :
       {std::tuple("rod.obj", 2, "ends in none of .glb"),
        std::tuple("a.csv -c wire::rod.tip.positoin", 2, "there is no channel"),
        std::tuple("a.csv a.csv", 2, "named twice"), std::tuple("a.glb --fps -1", 2, "--fps"),
        std::tuple("a.glb --fps 1e9", 2, "more than 100000 keyframes"),
        std::tuple("nowhere/a.glb", 5, "No such file"),
        std::tuple("nowhere/a.csv", 5, "No such file")}) {
    const Answer answer = run("export " + rod_ + " " + words + " --duration 0.01");
    EXPECT_EQ(answer.code, code) << words;
    EXPECT_TRUE(answer.complains(part)) << words << answer.err;
  }
  EXPECT_EQ(run("export bad.xml a.glb").code, 3);
  EXPECT_EQ(run("export table.csv a.glb").code, 2);
  EXPECT_EQ(run("export table.csv a.csv -c b").code, 2);
  EXPECT_EQ(run("export none.h5 a.csv").code, 2);
  EXPECT_FALSE(exists("a.glb") || exists("a.csv"));
}

TEST_F(Export, KeepsWhatWasComputedWhenAStepFails) {
  std::string text = contents(rod_);
  spill(folder_ / "rod.xml", with(text, "<force>-1 0 0</force><step from=\"1\" to=\"0\" at=\"0\"/>",
                                  "<force>1e9 0 0</force><step from=\"0\" to=\"1\" at=\"0.1\"/>"));
  const Answer answer = run("export rod.xml rod.csv");
  EXPECT_EQ(answer.code, 4);
  EXPECT_TRUE(answer.complains("the run failed at t = 0.1 s")) << answer.err;
  const std::string csv = contents(folder_ / "rod.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 102);
}

#ifdef CPRSIM_ALL_WRITERS
TEST_F(Export, OfAnHdf5FileIsTheCsvFile) {
  ASSERT_EQ(run("export " + rod_ + " rod.h5 rod.npz rod.csv --duration 0.1").code, 0);
  EXPECT_EQ(contents(folder_ / "rod.npz").substr(0, 2), "PK");
  ASSERT_EQ(run("export rod.h5 copy.csv").code, 0);
  EXPECT_EQ(contents(folder_ / "copy.csv"), contents(folder_ / "rod.csv"));
}
#endif

}  // namespace
}  // namespace cprsim
