// SPDX-License-Identifier: BSD-3-Clause
// `cprsim solve` and `cprsim modes` as scripts meet them: exit codes, JSON, what is refused.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/tools/scratch_folder.h"

namespace cprsim {
namespace {

const std::string kRobots = std::string(CPRSIM_SOURCE_DIR) + "/scenes/robots/";

struct Answer {
  int code = -1;
  nlohmann::json json;
};

Answer ask(const std::string& words) {
  const ScratchFolder scratch;
  const std::string out = (scratch / "out.json").string();
  const int status = std::system((std::string(CPRSIM_BINARY_DIR) + "/bin/cprsim " + words +
                                  " --json > " + out + " 2>/dev/null")
                                     .c_str());
  Answer answer;
  if (WIFEXITED(status)) answer.code = WEXITSTATUS(status);
  std::ifstream stream(out);
  answer.json = nlohmann::json::parse(stream, nullptr, false);
  return answer;
}

TEST(SolveCommand, FindsThePublishedPose) {
  const Answer answer = ask("solve " + kRobots + "csg_published.xml");
  ASSERT_EQ(answer.code, 0);
  EXPECT_EQ(answer.json["schema"], "cprsim-solve/1");
  EXPECT_EQ(answer.json["stability"]["verdict"], "stable");
  EXPECT_NEAR(answer.json["links"]["robot::platform"]["position"][2].get<double>(), 0.4, 1e-8);
}

TEST(SolveCommand, InverseAndForwardAgree) {
  const std::string scene = "solve " + kRobots + "stewart_gough.xml";
  const Answer inverse = ask(scene + " --pose robot::platform=0.01,0,0.39,0,10deg,0");
  ASSERT_EQ(inverse.code, 0);
  EXPECT_TRUE(inverse.json["goal"]["reached"].get<bool>());
  std::string drives;
  for (const auto& [name, drive] : inverse.json["drives"].items())
    drives += " --drive " + name + "=" + drive["value"].dump();
  const Answer forward = ask(scene + drives);
  ASSERT_EQ(forward.code, 0);
  const auto position = forward.json["links"]["robot::platform"]["position"];
  EXPECT_NEAR(position[0].get<double>(), 0.01, 1e-9);
  EXPECT_NEAR(position[1].get<double>(), 0, 1e-9);
  EXPECT_NEAR(position[2].get<double>(), 0.39, 1e-9);
}

// A mesh, and another rod: what scenes/contact expects of runs.
TEST(SolveCommand, FindsWhatRestsOnSomething) {
  const std::string scenes = std::string(CPRSIM_SOURCE_DIR) + "/scenes/contact/";
  const Answer ropes = ask("solve " + scenes + "ropes.xml --channel contact.force");
  ASSERT_EQ(ropes.code, 0);
  EXPECT_NEAR(ropes.json["contact"]["force"].get<double>(), 0.06561242, 1e-6);
  EXPECT_NEAR(ropes.json["channels"]["contact.force"].get<double>(), 0.06561242, 1e-6);
  EXPECT_EQ(ropes.json["contact"]["count"], 1);
  EXPECT_FALSE(ropes.json.contains("stability"));
  const Answer rock = ask("solve " + scenes + "cantilever_on_rock.xml");
  ASSERT_EQ(rock.code, 0);
  EXPECT_GT(rock.json["contact"]["force"].get<double>(), 0.1);
  // its stability and drives that lead to a pose are not worked out
  EXPECT_EQ(ask("solve " + scenes + "robot_and_bar.xml --pose robot::platform=0,0,0.3").code, 3);
}

TEST(SolveCommand, BringsAFrameToTheTargetOfItsScene) {
  const std::string scene =
      "solve " + std::string(CPRSIM_SOURCE_DIR) + "/scenes/inverse/csg_published.xml";
  const Answer answer = ask(scene);
  ASSERT_EQ(answer.code, 0);
  // leg lengths on which two independent solvers agree to 1e-10 m
  const double lengths[] = {0.3973263874, 0.3973263874, 0.3997201023,
                            0.4216240113, 0.4216240113, 0.3997201023};
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(answer.json["drives"]["robot::leg_" + std::to_string(i + 1) + ".length"]["value"]
                    .get<double>(),
                lengths[i], 1e-8);
  const Answer forward = ask(scene + " --as-it-is");
  ASSERT_EQ(forward.code, 0);
  EXPECT_EQ(forward.json["drives"]["robot::leg_1.length"]["value"].get<double>(), 0.4);
  EXPECT_EQ(ask(scene + " --as-it-is --pose robot::platform=0,0,0.4").code, 2);
}

TEST(SolveCommand, ChangesOnlyTheDrivesThatTheTargetFrees) {
  const std::string scene = "solve " + std::string(CPRSIM_SOURCE_DIR) +
                            "/scenes/inverse/csg_published.xml --set 'robot/target/@freedoms=x z' "
                            "--set 'robot/target/@free=leg_3 leg_4 leg_5 leg_6'";
  const Answer answer = ask(scene);
  ASSERT_EQ(answer.code, 0);
  EXPECT_NEAR(answer.json["links"]["robot::platform"]["position"][2].get<double>(), 0.4, 1e-9);
  EXPECT_EQ(answer.json["drives"]["robot::leg_2.length"]["value"].get<double>(), 0.4);
  EXPECT_NE(answer.json["drives"]["robot::leg_3.length"]["value"].get<double>(), 0.4);
}

TEST(SolveCommand, SaysThatAPoseIsOutOfReach) {
  const Answer answer = ask("solve " + kRobots +
                            "stewart_gough.xml --pose robot::platform=0.03,0,0.38,0,0,0 "
                            "--free robot::leg_1");
  EXPECT_EQ(answer.code, 4);
  EXPECT_FALSE(answer.json["goal"]["reached"].get<bool>());
  EXPECT_FALSE(answer.json["goal"]["why"].get<std::string>().empty());
}

TEST(SolveCommand, RefusesWordsThatMeanNothing) {
  const std::string scene = "solve " + kRobots + "stewart_gough.xml";
  EXPECT_EQ(ask(scene + " --pose robot::plattform=0,0,0.4").code, 2);
  EXPECT_EQ(ask(scene + " --pose robot::platform=0,0").code, 2);
  EXPECT_EQ(ask(scene + " --pose robot::platform=0,0,high").code, 2);
  EXPECT_EQ(ask(scene + " --drive robot::leg_9=0.4").code, 2);
  EXPECT_EQ(ask(scene + " --wrench robot::platform=1,2").code, 2);
  EXPECT_EQ(ask(scene + " --unknown-wrench robot::platform").code, 2);
  EXPECT_EQ(ask(scene + " --channel nothing.at.all").code, 2);
  EXPECT_EQ(ask("solve /nowhere.xml").code, 3);
}

TEST(ModesCommand, ListsFrequenciesInOrder) {
  const Answer answer = ask("modes " + kRobots + "stewart_gough.xml --count 4");
  ASSERT_EQ(answer.code, 0);
  EXPECT_EQ(answer.json["schema"], "cprsim-modes/1");
  ASSERT_EQ(answer.json["modes"].size(), 4U);
  double last = 0;
  for (const auto& mode : answer.json["modes"]) {
    const double frequency = mode["frequency_Hz"].get<double>();
    EXPECT_GE(frequency, last * (1 - 1e-12));
    EXPECT_GT(frequency, 1);
    last = frequency;
  }
}

TEST(ModesCommand, RefusesWordsThatMeanNothing) {
  const std::string scene = "modes " + kRobots + "stewart_gough.xml";
  EXPECT_EQ(ask(scene + " --count 0").code, 2);
  EXPECT_EQ(ask(scene + " --amplitude -1").code, 2);
  EXPECT_EQ(ask("modes /nowhere.xml").code, 3);
}

}  // namespace
}  // namespace cprsim
