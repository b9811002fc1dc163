// SPDX-License-Identifier: BSD-3-Clause
// <initial file>: what a table of shapes says, and what is wrong with one.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

class StartTable : public ::testing::Test {
 protected:
  StartTable() { std::filesystem::create_directory(folder_); }

  ~StartTable() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  LoadResult load(const std::string& table) const {
    std::ofstream(folder_ / "start.csv") << table;
    std::string text = scene_text();
    const std::string duration = "<duration>1</duration>";
    text.replace(text.find(duration), duration.size(), duration + "<initial file=\"start.csv\"/>");
    return load_scene_text(text, (folder_ / "scene.xml").string(), {});
  }

  /// Why the table is refused.
  std::string complaint(const std::string& table) const {
    const LoadResult result = load(table);
    EXPECT_EQ(error_codes(result), std::vector<std::string>{"E110"}) << table;
    for (const Diagnostic& d : result.diagnostics)
      if (d.severity == Severity::kError) return d.message;
    return "";
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("cprsim-start-" + std::to_string(getpid()));
};

constexpr const char* kNames = "s,robot::leg.x [m],robot::leg.y [m],robot::leg.z [m]\n";

TEST_F(StartTable, IsReadIntoItsRods) {
  const LoadResult result =
      load(std::string(kNames) + "0,0,0,0\n0.3,0,0.01,0.12\n0.7,0,0.01,0.28\n1,0,0,0.4\n");
  ASSERT_NE(result.scene, nullptr) << to_text(result.diagnostics);
  const std::vector<CurveSample>& start = result.scene->rods[0].start;
  ASSERT_EQ(start.size(), 4u);
  EXPECT_EQ(start[1].s, 0.3);
  EXPECT_EQ(start[1].position, Vec3(0, 0.01, 0.12));
}

TEST_F(StartTable, SaysWhatIsWrong) {
  const std::string names = kNames, rows = "0,0,0,0\n0.3,0,0,0.1\n0.7,0,0,0.3\n1,0,0,0.4\n";
  const auto says = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_PRED2(says, complaint(names + "0,0,0,0\n0.5,0,0,0.2\n1,0,0,0.4\n"), "fewer than four");
  EXPECT_PRED2(says, complaint(rows), "no column 's'");
  EXPECT_PRED2(says, complaint(names + "0,0,0,0\n0.7,0,0,0.1\n0.3,0,0,0.3\n1,0,0,0.4\n"),
               "line 4: s does not ascend");
  EXPECT_PRED2(says, complaint(names + "0.1,0,0,0\n0.3,0,0,0.1\n0.7,0,0,0.3\n1,0,0,0.4\n"),
               "does not go from 0 to 1");
  EXPECT_PRED2(says, complaint("s,robot::lag.x,robot::lag.y,robot::lag.z\n" + rows),
               "no rod 'robot::lag': 'robot::leg'?");
  EXPECT_PRED2(says, complaint("s,robot::leg.x,robot::leg.y,robot::leg.w\n" + rows),
               "column 'robot::leg.w' is none");
  EXPECT_PRED2(says, complaint("s,robot::leg.x,robot::leg.y,robot::log.z\n" + rows),
               "no column 'robot::leg.z'");
  EXPECT_PRED2(says, complaint(names + "0,0,0,0\n0.3,0,0,0\n0.7,0,0,0.3\n1,0,0,0.4\n"),
               "line 3: robot::leg is where it was");
  EXPECT_PRED2(says, complaint(names + "0,0,0,0\n0.3,0,0,0.1\n0.7,0,0,0.3\n1,0,0,0.7\n"),
               "is 0.7 m long there, and has a <length> of 0.4 m");
  EXPECT_PRED2(says, complaint(names + "0,0,0,0\n0.3,0,zero,0.1\n0.7,0,0,0.3\n1,0,0,0.4\n"),
               "'zero' is not a number");
}

TEST(Solver, ADoglegIsLevenbergMarquardtsAndSaysSo) {
  const LoadResult result =
      load_text(std::regex_replace(scene_text(), std::regex("</physics>"),
                                   "<cprsim:solver method=\"auto\"><nonlinear "
                                   "algorithm=\"dogleg\"/></cprsim:solver></physics>"));
  ASSERT_NE(result.scene, nullptr) << to_text(result.diagnostics);
  EXPECT_EQ(result.scene->solver.algorithm, NonlinearAlgorithm::kLevenbergMarquardt);
  EXPECT_TRUE(has_code(result, "W592"));
}

}  // namespace
}  // namespace cprsim
