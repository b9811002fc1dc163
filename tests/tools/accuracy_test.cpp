// SPDX-License-Identifier: BSD-3-Clause
// <accuracy>: the error that a run reports, against the one that a tight solution shows.
#include "tests/tools/program.h"

namespace cprsim {
namespace {

using Json = nlohmann::json;

class Accuracy : public ProgramTest {
 protected:
  /// Largest error of all recorded positions of run `a` against those of run `b`.
  double error_between(const std::string& a, const std::string& b, const std::string& csv) const {
    const Answer answer = run("compare " + a + " " + b + "/" + csv + " --json -o c");
    EXPECT_EQ(answer.code, 0) << answer.err;
    double most = 0;
    const Json report = Json::parse(answer.out);
    for (const Json& quantity : report["quantities"])
      if (quantity["name"].get<std::string>().ends_with("position"))
        most = std::max(most, quantity["max"].get<double>());
    return most;
  }
};

TEST_F(Accuracy, IsKeptAndItsEstimateIsNeitherTooSmallNorAThousandTimesTooLarge) {
  const std::string rod =
      shipped("scenes/mechanics/released_rod.xml") + " --duration 0.2 --no-video -q ";
  ASSERT_EQ(run("run " + rod + "--set tolerance=1e-10 --set points=12 -o tight").code, 0);
  for (const char* asked : {"1e-3", "1e-4", "1e-5"}) {
    // 1: the scene expects another tip than a coarse run has
    ASSERT_LE(run("run " + rod + "--accuracy " + asked + " -o asked").code, 1);
    const Json accuracy = json("asked/run.json")["accuracy"];
    const double error = error_between("asked", "tight", "released_rod.csv");
    EXPECT_LE(error, std::stod(asked));
    EXPECT_TRUE(accuracy["reached"]);
    EXPECT_GT(accuracy["estimate"].get<double>(), 0.5 * error) << asked;
    EXPECT_LT(accuracy["estimate"].get<double>(), 1000 * error) << asked;
    EXPECT_GE(accuracy["runs"], 2);
  }
}

TEST_F(Accuracy, IsKeptByEquilibria) {
  const std::string robot = shipped("scenes/robots/csg_published.xml") + " --no-video -q ";
  for (const char* asked : {"1e-4", "1e-7"}) {
    ASSERT_LE(run("run " + robot + "--accuracy " + asked + " -o asked").code, 1);
    EXPECT_TRUE(json("asked/run.json")["accuracy"]["reached"]);
  }
}

// Ten times more accurate costs more, and less is not run for: one cell of a straight leg will do.
TEST_F(Accuracy, IsNotPaidForUnasked) {
  const std::string robot = shipped("scenes/robots/csg_published.xml") + " --no-video -q ";
  long last = 0;
  for (const char* asked : {"1e-2", "1e-4", "1e-6", "1e-8"}) {
    ASSERT_LE(run("run " + robot + "--accuracy " + asked + " -o asked").code, 1);
    const Json report = json("asked/run.json");
    const long work = report["statistics"]["section_evaluations"];
    EXPECT_TRUE(report["accuracy"]["reached"]) << asked;
    EXPECT_GT(work, last) << asked;
    EXPECT_LT(report["accuracy"]["section_evaluations_before"], 4 * work) << asked;
    last = work;
  }
}

// A coil of 26 radians and four straight legs: what the coil takes is not what they take.
TEST_F(Accuracy, CutsEveryRodForItself) {
  ASSERT_LE(run("run " + shipped("scenes/robots/legs_that_differ.xml") +
                " --no-video -q --accuracy 1e-4 -o asked")
                .code,
            1);
  int least = 1000, most = 0;
  const Json report = json("asked/run.json");
  for (const Json& rod : report["method"]["rods"]) {
    least = std::min(least, rod["elements"].get<int>());
    most = std::max(most, rod["elements"].get<int>());
  }
  EXPECT_GT(most, 4 * least);
}

// Its ends are held: what there is to be wrong is between them.
TEST_F(Accuracy, CountsBetweenTheEndsOfARod) {
  constexpr double kDepth = -0.19492431137557384;  // scenes/rods/arch.xml
  const std::string arch = shipped("scenes/rods/arch.xml") + " --no-video -q ";
  for (const char* asked : {"1e-3", "1e-5", "1e-7"}) {
    ASSERT_LE(run("run " + arch + "--accuracy " + asked + " -o asked").code, 1);
    const Json report = json("asked/run.json");
    EXPECT_TRUE(report["accuracy"]["reached"]);
    EXPECT_GT(report["accuracy"]["estimate"].get<double>(), 0);
    for (const Json& check : report["expectations"][0]["checks"]) {
      if (check.value("channel", "").ends_with("position.z")) {
        EXPECT_NEAR(check["value"].get<double>(), kDepth, std::stod(asked));
      }
    }
  }
}

// The moment at the clamp, by its largest value, and positions, by the length of the rod.
TEST_F(Accuracy, MayBeRelativeAndOfAChannel) {
  const std::string scene = contents(shipped("scenes/mechanics/released_rod.xml"));
  const std::size_t from = scene.find("<cprsim:solver"), to = scene.find("</physics>");
  const auto asking = [&](const std::string& accuracy) {
    std::string text = scene;
    text.replace(from, to - from,
                 "<cprsim:solver method=\"auto\">" + accuracy + "</cprsim:solver>");
    return with(text, "<channel>energy.*</channel>",
                "<channel>wire::rod.base.wrench.moment.y</channel>");
  };
  spill(folder_ / "tight.xml", asking("<space points=\"14\"/><time scheme=\"esdirk43\" "
                                      "tolerance=\"1e-10\"/>"));
  ASSERT_LE(run("run tight.xml --duration 0.1 --no-video -q -o tight").code, 1);
  const auto error = [&](const std::string& of) {
    const Answer answer = run("compare asked tight/released_rod.csv --json -o c");
    const Json report = Json::parse(answer.out);
    for (const Json& quantity : report["quantities"])
      if (quantity["name"].get<std::string>().find(of) != std::string::npos)
        return quantity["max"].get<double>();
    ADD_FAILURE() << "no " << of << " in " << answer.out;
    return 0.;
  };
  constexpr double kLength = 0.4, kMoment = 0.39;  // under 1 N and its weight

  spill(folder_ / "asked.xml", asking("<accuracy relative=\"true\">1e-4</accuracy>"));
  ASSERT_LE(run("run asked.xml --duration 0.1 --no-video -q -o asked").code, 1);
  EXPECT_TRUE(json("asked/run.json")["accuracy"]["reached"]);
  EXPECT_EQ(json("asked/run.json")["accuracy"]["unit"], "of the longest rod");
  EXPECT_LT(error("tip.position"), 1e-4 * kLength);

  const std::string moment = "wire::rod.base.wrench.moment.y";
  spill(folder_ / "asked.xml",
        asking("<accuracy of=\"" + moment + "\" relative=\"true\">1e-3</accuracy>"));
  ASSERT_LE(run("run asked.xml --duration 0.1 --no-video -q -o asked").code, 1);
  EXPECT_TRUE(json("asked/run.json")["accuracy"]["reached"]);
  EXPECT_EQ(json("asked/run.json")["accuracy"]["unit"], "of " + moment);
  EXPECT_LT(error("moment"), 1e-3 * kMoment);
}

TEST_F(Accuracy, ThatTheSceneDoesNotLeaveRoomForIsSaidNotToBeReached) {
  const Answer answer =
      run("run " + shipped("scenes/mechanics/released_rod.xml") +
          " --duration 0.1 --no-video --set accuracy=1e-6 --set scheme=bdf2 --set step=0.002");
  EXPECT_TRUE(answer.complains("1e-06 m asked for")) << answer.err;
  EXPECT_TRUE(answer.complains("the scene fixes step")) << answer.err;
  const Json accuracy = json("out/released_rod/run.json")["accuracy"];
  EXPECT_FALSE(accuracy["reached"]);
  EXPECT_EQ(accuracy["fixed_by_the_scene"], "step");
}

TEST_F(Accuracy, IsNotReportedWhereNoneIsAskedFor) {
  ASSERT_EQ(
      run("run " + shipped("scenes/mechanics/released_rod.xml") + " --duration 0.05 --no-video")
          .code,
      0);
  EXPECT_FALSE(json("out/released_rod/run.json").contains("accuracy"));
}

}  // namespace
}  // namespace cprsim
