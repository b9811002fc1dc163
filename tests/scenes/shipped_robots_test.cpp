// SPDX-License-Identifier: BSD-3-Clause
// Every shipped robot stands and moves: the program runs its scene to the end and finds all that
// the scene expects. What two of them say about the laboratory's robots is checked against the
// elastica.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "tests/scenes/scene_text.h"
#include "tests/support/elastica.h"
#include "tests/tools/scratch_folder.h"

namespace cprsim {
namespace {

using Json = nlohmann::json;

const std::string kRobots = std::string(CPRSIM_SOURCE_DIR) + "/scenes/robots/";

std::vector<std::string> robots() {
  std::vector<std::string> names;
  for (const auto& path : shipped_scenes())
    if (path.parent_path() == std::filesystem::path(kRobots).parent_path())
      names.push_back(path.stem().string());
  return names;
}

class ShippedRobot : public testing::TestWithParam<std::string> {};

/// Exit code of the program; what it prints is in out.txt and err.txt of the folder.
int run(const ScratchFolder& folder, const std::string& words) {
  const std::string command = "cd '" + folder.path().string() + "' && '" + CPRSIM_BINARY_DIR +
                              "/bin/cprsim' run " + words + " >out.txt 2>err.txt";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_P(ShippedRobot, RunsToTheEndAndMeetsWhatItExpects) {
  const ScratchFolder folder;
  ASSERT_EQ(run(folder, "'" + kRobots + GetParam() + ".xml' --json --no-video --no-record"), 0)
      << contents(folder / "err.txt");
  const Json report = Json::parse(contents(folder / "out.txt"));
  EXPECT_EQ(report["status"], "done");
  std::size_t checks = 0;
  for (const Json& expectation : report["expectations"])
    for (const Json& check : expectation["checks"]) {
      EXPECT_EQ(check["verdict"], "met") << check;
      checks += check["kind"] != "converged";
    }
  EXPECT_GT(checks, 0u) << "expects nothing but an end";
}

INSTANTIATE_TEST_SUITE_P(Robots, ShippedRobot, testing::ValuesIn(robots()),
                         [](const auto& robot) { return robot.param; });

TEST(ShippedRobots, AreThoseOfTheirSources) {
  const std::vector<std::string> all = robots();
  for (const char* name :
       {"csg_published", "slider_crank", "planar_lab_revolute", "planar_lab_tied", "planar_2pr",
        "planar_2rr", "planar_3pr", "planar_3rr", "planar_3er", "planar_rerrfr", "planar_rfrfr",
        "stewart_gough_6pfs", "stewart_gough_6pfr", "stewart_gough_6pff", "stewart_gough_6efr",
        "stewart_gough_6ffr", "stewart_gough_6rfs", "spatial_3pfr", "legs_that_differ"})
    EXPECT_TRUE(std::find(all.begin(), all.end(), name) != all.end()) << name;
}

/// The last record, by channel.
std::map<std::string, double> last_record(const std::string& csv) {
  std::istringstream lines(csv);
  std::string header, line, last;
  std::getline(lines, header);
  while (std::getline(lines, line))
    if (!line.empty()) last = line;
  std::map<std::string, double> record;
  std::istringstream names(header), values(last);
  for (std::string name, value; std::getline(names, name, ',') && std::getline(values, value, ',');)
    record[name.substr(0, name.find(' '))] = std::stod(value);
  return record;
}

std::map<std::string, double> pose(const std::string& scene, const std::string& settings) {
  const ScratchFolder folder;
  EXPECT_EQ(run(folder, "'" + kRobots + scene + ".xml' --no-video -o out " + settings), 0)
      << contents(folder / "err.txt");
  return last_record(contents(folder / "out" / (scene + ".csv")));
}

constexpr double kStiffness = 36.0e9 * std::numbers::pi / 4 * 1e-12;  // E pi r4 / 4, r = 1 mm

// Half the robot with joined tips is a cantilever that its tip's force bends sideways. Half a beam
// of the robot with tied tips is the same at half the size: equal tips whatever the length, with
// four times the force and twice the moment.
TEST(LaboratoryRobot, IsACantileverAndItsTiedVariantTheSameAtHalfTheSize) {
  for (const double length : {0.4, 0.48})
    for (const double right : {0.19, 0.51}) {
      const std::string settings =
          "--set robot::left_beam/length=" + std::to_string(length) +
          " --set robot::right_beam/length=" + std::to_string(length) +
          " --set 'robot/drive[right]/smoothstep/@to=" + std::to_string(right) + "'";
      auto joined = pose("planar_lab_revolute", settings), tied = pose("planar_lab_tied", settings);
      const double force = joined["robot::left_beam.base.wrench.force.x"];
      const Elastica exact = solve_elastica(std::abs(force) * length * length / kStiffness);
      EXPECT_NEAR(joined["robot::tip.position.x"], right / 2, 1e-9);
      EXPECT_NEAR(exact.x * length, right / 2, 1e-7);
      EXPECT_NEAR(joined["robot::tip.position.z"], exact.z * length, 1e-7);
      EXPECT_NEAR(tied["robot::tip.position.x"], right / 2, 1e-9);
      EXPECT_NEAR(tied["robot::tip.position.z"], joined["robot::tip.position.z"], 1e-7);
      EXPECT_NEAR(tied["robot::left_beam.base.wrench.force.x"] / force, 4, 1e-6);
      EXPECT_NEAR(tied["robot::left_beam.base.wrench.moment.y"] /
                      joined["robot::left_beam.base.wrench.moment.y"],
                  2, 1e-6);
    }
}

// Nothing but its joints loads the beam, so that its shape scales with its length.
TEST(LaboratorySliderCrank, ScalesWithTheBeam) {
  const std::string crank = "--set 'robot/drive[motor]/smoothstep/@to=1.0471975511965976' ";
  const double x = pose("slider_crank", crank)["robot::slider.position.x"];
  const double shorter =
      pose("slider_crank", crank + "--set robot::beam/length=0.3")["robot::slider.position.x"];
  EXPECT_NEAR(shorter / x, 0.75, 1e-7);
  // a fibre half as stiff: the same tip
  const std::string soft =
      crank + "--set 'robot/rod_class[fibreglass]/material/youngs_modulus=18e9'";
  EXPECT_NEAR(pose("slider_crank", soft)["robot::slider.position.x"], x, 1e-9);
}

}  // namespace
}  // namespace cprsim
