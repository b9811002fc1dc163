// SPDX-License-Identifier: BSD-3-Clause
// What derivatives of runs and equilibria are made of: runs that take another's steps, and single
// Newton steps from another's equilibrium.
#include <gtest/gtest.h>

#include "engine/robot/robot.h"
#include "engine/run/observe.h"
#include "engine/run/simulation.h"
#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

const std::string kReleased = std::string(CPRSIM_SOURCE_DIR) + "/scenes/mechanics/released_rod.xml";

Scene released(double youngs_modulus, double duration = 0.05) {
  LoadOptions load;
  load.duration = duration;
  load.set.emplace_back("wire::rod/material/youngs_modulus", std::to_string(youngs_modulus));
  return *load_scene(kReleased, load).scene;
}

std::vector<double> run(Simulation& simulation, const std::vector<double>& course = {}) {
  simulation.start();
  simulation.retrace(course);
  std::vector<double> instants;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    instants.push_back(simulation.time());
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  return instants;
}

Vec3 tip(const Simulation& simulation) {
  const Scene& scene = *simulation.robot().scene;
  const std::vector<Channel> channels = find_channels(scene, "wire::rod.tip.position");
  Vec3 p;
  for (int i = 0; i < 3; ++i)
    p[i] = evaluate(channels[static_cast<std::size_t>(i)], scene, simulation.now());
  return p;
}

TEST(Retrace, TakesTheStepsOfTheOtherRun) {
  Simulation first(released(200e9)), other(released(180e9)), alone(released(180e9));
  const std::vector<double> course = run(first);
  EXPECT_EQ(run(other, course), course);
  EXPECT_NE(run(alone), course);
  EXPECT_EQ(other.statistics().rejected, 0);
  // as good as with steps of its own
  EXPECT_LT((tip(other) - tip(alone)).norm(), 1e-5);
  EXPECT_GT((tip(other) - tip(first)).norm(), 5e-4);
}

TEST(Retrace, OfItselfIsTheSameRun) {
  Simulation first(released(200e9)), again(released(200e9));
  const std::vector<double> course = run(first);
  EXPECT_EQ(run(again, course), course);
  EXPECT_LT((tip(first) - tip(again)).norm(), 1e-11);
}

TEST(Retrace, MeetsJumpsThatTheCourseDoesNotKnow) {
  Simulation coarse(released(200e9));
  const std::vector<double> instants = run(coarse, {0.02, 0.05});
  EXPECT_EQ(instants.front(), 0.02);
  EXPECT_EQ(instants.back(), 0.05);
}

// Differences of answers to neighbouring values shrink with their square: nothing jumps.
TEST(Retrace, MakesTheAnswerASmoothFunctionOfTheScene) {
  Simulation centre(released(200e9));
  const std::vector<double> course = run(centre);
  const auto derivative = [&](double change) {
    Simulation up(released(200e9 * (1 + change))), down(released(200e9 * (1 - change)));
    run(up, course);
    run(down, course);
    return Vec3((tip(up) - tip(down)) / (2 * change));
  };
  const Vec3 fine = derivative(1e-5);
  const double wide = (derivative(0.04) - fine).norm(), half = (derivative(0.02) - fine).norm();
  EXPECT_GT(fine.norm(), 0.01);
  EXPECT_NEAR(wide / half, 4, 0.3);
  EXPECT_LT((derivative(1e-4) - fine).norm(), 1e-6 * fine.norm());
}

TEST(Beside, IsTheDerivativeOfTheEquilibrium) {
  Simulation centre(released(200e9));
  centre.start();
  const auto near = centre.unknowns();
  const auto solved = [](double E) {
    Simulation there(released(E));
    there.start();
    return tip(there);
  };
  const auto moved = [&](double E) {
    Simulation there(released(E));
    EXPECT_TRUE(there.start_beside(*near));
    return tip(there);
  };
  const double h = 1e-5 * 200e9;
  const Vec3 derivative = (moved(200e9 + h) - moved(200e9 - h)) / 2e-5;
  // of solutions, to fourth order
  const auto across = [&](double k) {
    return Vec3(solved(200e9 * (1 + k * 1e-2)) - solved(200e9 * (1 - k * 1e-2)));
  };
  const Vec3 reference = (8 * across(1) - across(2)) / 0.12;
  EXPECT_LT((derivative - reference).norm(), 1e-7 * reference.norm());
  // one step is not the solution: what remains is of second order
  const double one = (moved(202e9) - solved(202e9)).norm();
  const double two = (moved(204e9) - solved(204e9)).norm();
  EXPECT_NEAR(two / one, 4, 0.2);
}

TEST(Beside, RefusesTheShapeOfAnotherRobot) {
  const auto other =
      load_scene(std::string(CPRSIM_SOURCE_DIR) + "/scenes/robots/stewart_gough.xml");
  Simulation robot(*other.scene), rod(released(200e9));
  robot.start();
  EXPECT_FALSE(rod.start_beside(*robot.unknowns()));
  rod.start();
  EXPECT_EQ(rod.status(), RunStatus::kRunning);
}

}  // namespace
}  // namespace cprsim
