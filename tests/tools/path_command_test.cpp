// SPDX-License-Identifier: BSD-3-Clause
// `cprsim path` as scripts meet it: exit codes, files, what is refused.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/tools/scratch_folder.h"

namespace cprsim {
namespace {

const std::string kColumn = std::string(CPRSIM_SOURCE_DIR) + "/scenes/paths/euler_column.xml";

int path(const std::string& words) {
  const int status = std::system(
      (std::string(CPRSIM_BINARY_DIR) + "/bin/cprsim path " + words + " >/dev/null 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(PathCommand, WritesTheBucklingOfTheColumn) {
  const ScratchFolder scratch;
  const auto out = scratch.path() / "euler";
  const std::string words = kColumn +
                            " --load column::slider.force.z --from 0 --to -6 --branch "
                            "--largest-step 0.5 -o " +
                            out.string();
  ASSERT_EQ(path(words), 0);
  std::ifstream stream(out / "path.json");
  const nlohmann::json json = nlohmann::json::parse(stream);
  EXPECT_EQ(json["schema"], "cprsim-path/1");
  ASSERT_EQ(json["paths"].size(), 3U);
  const auto& event = json["paths"][0]["events"][0];
  EXPECT_EQ(event["kind"], "branch point");
  const double euler = std::pow(std::numbers::pi, 2) * 200e9 * 0.004e-9 / 12 / 0.16;
  EXPECT_NEAR(event["parameter"].get<double>(), -euler, 1e-8 * euler);
  std::ifstream csv(out / "path.csv");
  std::string header;
  std::getline(csv, header);
  EXPECT_EQ(header.rfind("path,event,arclength [1],column::slider.force.z [N],verdict", 0), 0U);
  // its own folder is used again, another's is not
  EXPECT_EQ(path(words), 0);
  std::ofstream(scratch.path() / "other.txt") << "mine";
  EXPECT_EQ(path(kColumn + " --load column::slider.force.z --to -6 -o " + scratch.path().string()),
            5);
}

TEST(PathCommand, RefusesWordsThatMeanNothing) {
  EXPECT_EQ(path(kColumn), 2);
  EXPECT_EQ(path(kColumn + " --load column::slider.force.z"), 2);
  EXPECT_EQ(path(kColumn + " --load column::sldier.force.z --to -6"), 2);
  EXPECT_EQ(path(kColumn + " --load column::slider.power --to -6"), 2);
  EXPECT_EQ(path(kColumn + " --drive nothing --to 1"), 2);
  EXPECT_EQ(path(kColumn + " --pose column::slider --to 0,0,0.3"), 2);
  EXPECT_EQ(path("/nowhere.xml --drive a --to 1"), 3);
}

}  // namespace
}  // namespace cprsim
