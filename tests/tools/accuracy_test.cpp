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
