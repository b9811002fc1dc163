// SPDX-License-Identifier: BSD-3-Clause
// cprsim workspace as people and scripts meet it.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/tools/scratch_folder.h"

namespace cprsim {
namespace {

using Json = nlohmann::json;

struct Outcome {
  int code = -1;
  std::string out, err;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Lines of a text that hold a part.
long lines_with(const std::string& text, const std::string& part) {
  std::istringstream stream(text);
  long count = 0;
  for (std::string line; std::getline(stream, line);)
    if (has(line, part)) ++count;
  return count;
}

/// The shipped RFRFR, and the same with limits on both motors.
class Workspace : public testing::Test {
 protected:
  void SetUp() override {
    std::string text = contents(std::string(CPRSIM_SOURCE_DIR) + "/scenes/robots/planar_rfrfr.xml");
    spill(folder_ / "free.xml", text);
    const std::string axis = "<axis><xyz>0 0 1</xyz></axis></joint>";
    for (std::size_t at = 0; (at = text.find(axis, at)) != std::string::npos; at += 60)
      text.replace(at, axis.size(),
                   "<axis><xyz>0 0 1</xyz><limit><lower>0.6</lower><upper>2.5</upper>"
                   "<effort>0.5</effort></limit></axis></joint>");
    spill(folder_ / "limited.xml", text);
  }

  Outcome run(const std::string& words) const {
    const std::string command = "cd '" + folder_.path().string() + "' && '" + CPRSIM_BINARY_DIR +
                                "/bin/cprsim' workspace " + words + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder_ / "out.txt"),
            contents(folder_ / "err.txt")};
  }

  Json report(const std::string& output) const {
    return Json::parse(contents(folder_ / (output + "/workspace.json")));
  }

  void expect_same_files(const std::string& a, const std::string& b) const {
    for (const char* name : {"/points.csv", "/points.vtp", "/workspace.svg"}) {
      const std::string text = contents(folder_ / (a + name));
      EXPECT_GT(text.size(), 100U) << a << name;
      EXPECT_EQ(text, contents(folder_ / (b + name))) << name;
    }
  }

  const std::string grid_ =
      "free.xml --accuracy 1e-5 --vary robot::left=1.8:2.4:4 --vary robot::right=0.8:1.4:3 ";

  ScratchFolder folder_;
};

TEST_F(Workspace, BytesDoNotDependOnTheNumberOfThreads) {
  ASSERT_EQ(run(grid_ + "-j 1 -o one").code, 0);
  ASSERT_EQ(run(grid_ + "-j 2 -o two").code, 0);
  expect_same_files("one", "two");
  const std::string csv = contents(folder_ / "one/points.csv");
  EXPECT_EQ(lines_with(csv, ""), 13);
  EXPECT_TRUE(has(csv, "robot::left.position [rad]"));
  EXPECT_TRUE(has(csv, "robot::pin.position.y [m]"));
  EXPECT_EQ(report("one")["counts"]["reached"], 12);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "one/points.journal"));
}

TEST_F(Workspace, GoesOnWhereItWasInterrupted) {
  ASSERT_EQ(run(grid_ + "-o whole").code, 0);
  ASSERT_EQ(run(grid_ + "-o part").code, 0);
  // what a kill leaves: some lines in the order of their solution, the last one cut off
  std::istringstream csv(contents(folder_ / "whole/points.csv"));
  std::vector<std::string> rows;
  for (std::string line; std::getline(csv, line);)
    rows.push_back(line + "\n");
  spill(folder_ / "part/points.journal", rows[5] + rows[2] + rows[9] + rows[7].substr(0, 20));
  std::filesystem::remove(folder_ / "part/points.csv");
  const Outcome resumed = run(grid_ + "-o part --resume");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_TRUE(has(resumed.out, "3 points were solved before"));
  EXPECT_EQ(report("part")["timings"]["points_before"], 3);
  expect_same_files("whole", "part");
  // another sweep is not mixed with it
  const Outcome other = run(grid_ + "-o part --resume --max-effort 1");
  EXPECT_EQ(other.code, 2);
  EXPECT_TRUE(has(other.err, "another scene, with other options"));
  expect_same_files("whole", "part");
}

TEST_F(Workspace, ReportsPosesThatAreOutOfReach) {
  // rods of 1 m on motors 0.4 m apart: 1.2 m is too far
  const Outcome outcome = run(
      "free.xml --accuracy 1e-5 --pose robot::pin --vary x=0:0.1:2 --vary y=0.85:1.2:2 -o poses");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json counts = report("poses")["counts"];
  EXPECT_EQ(counts["reached"], 2);
  EXPECT_EQ(counts["status"]["not reached"], 2);
  EXPECT_FALSE(counts["not_reached_because"][0]["why"].get<std::string>().empty());
  EXPECT_EQ(lines_with(contents(folder_ / "poses/points.csv"), ",inverse,"), 2);
  EXPECT_TRUE(has(contents(folder_ / "poses/workspace.svg"), "not reached: 2"));
}

TEST_F(Workspace, FlagsLimits) {
  // by default the box of the joints' limits: none is beyond it
  ASSERT_EQ(run("limited.xml --accuracy 1e-5 --random 10 --seed 3 -o inside").code, 0);
  EXPECT_EQ(report("inside")["counts"]["beyond_joint_limits"], 0);
  EXPECT_EQ(report("inside")["axes"][0]["low"], 0.6);
  const std::string wide =
      "limited.xml --accuracy 1e-5 --vary robot::left=1.8:2.8:3 --vary robot::right=0.4:1.2:3 ";
  ASSERT_EQ(run(wide + "-o beyond").code, 0);
  const Json counts = report("beyond")["counts"];
  EXPECT_EQ(counts["beyond_joint_limits"], 5);  // left at 2.8, right at 0.4
  const std::string csv = contents(folder_ / "beyond/points.csv");
  EXPECT_EQ(lines_with(csv, ",robot::left.position robot::right.position"), 1);
  // the scene's limit on efforts, then a tighter one
  EXPECT_LT(counts["beyond_effort_limits"], 9);
  ASSERT_EQ(run(wide + "--max-effort 1e-3 -o weak").code, 0);
  EXPECT_GE(report("weak")["counts"]["beyond_effort_limits"], 8);
  EXPECT_TRUE(has(contents(folder_ / "weak/workspace.svg"), "stable, a limit broken"));
}

TEST_F(Workspace, AnswersTwoToWhatMakesNoSense) {
  const std::pair<const char*, const char*> cases[] = {
      {"free.xml", "robot::left.position has no limits in the scene"},
      {"free.xml --vary robot::lft.position=1:2", "Did you mean 'robot::left.position'?"},
      {"free.xml --vary robot::left=2:1", "ends below where it begins"},
      {"free.xml --vary robot::left=1:2:0", "is not a number of values"},
      {"free.xml --vary robot::left=1:2 --vary robot::left=1:2", "varied twice"},
      {"free.xml --vary robot::left=1:2:9 --random 4", "a count is for grids"},
      {"free.xml --vary x=1:2", "is for poses"},
      {"free.xml --pose robot::pim --vary x=0:1", "Did you mean 'robot::pin'?"},
      {"free.xml --pose robot::pin --vary w=0:1", "is none of x, y, z, roll, pitch, yaw"},
      {"free.xml --pose robot::pin", "say what is varied"},
      {"free.xml --vary robot::left_rod=-1:1", "must be greater than 0"},
      {"free.xml --vary robot::left=1:2:9999 --vary robot::right=1:2:9999", "more than 10000000"}};
  for (const auto& [words, complaint] : cases) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 2) << words << outcome.err;
    EXPECT_TRUE(has(outcome.err, complaint)) << words << ": " << outcome.err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace
}  // namespace cprsim
