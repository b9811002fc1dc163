// SPDX-License-Identifier: BSD-3-Clause
// The published continuum Stewart-Gough robot (Till, Bryson, Chung, Orekhov, Rucker, ICRA 2015;
// code JohnDTill/ContinuumRobotExamples), from its scene alone: straight legs, no guess.
#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kTilt = 10 * std::numbers::pi / 180;

void expect_published_pose(const Scene& scene, const Vec3& base_force) {
  const Equilibrium equilibrium(scene, 1e-10);
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  const RigidBody& plate = equilibrium.robot.bodies[0];
  // lengths are given to 1e-10 m
  EXPECT_LT((plate.p - Vec3(0, 0, 0.4)).norm(), 1e-8);
  EXPECT_LT((log_so3(plate.R) - Vec3(0, kTilt, 0)).norm(), 1e-7);
  EXPECT_LT((equilibrium.rod(0).points.front().force - base_force).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(StewartGough, StandsWhereItsPublishedLegLengthsPutIt) {
  Scene scene = stewart_gough(
      {0.3973263874, 0.3973263874, 0.3997201023, 0.4216240113, 0.4216240113, 0.3997201023}, false);
  scene.solver.points = 10;
  expect_published_pose(scene, {-1.502392, -0.879075, -4.495003});
}

TEST(StewartGough, StandsThereWithClampedLegsToo) {
  Scene scene = stewart_gough(
      {0.3973214576, 0.3973214576, 0.3997200876, 0.4216198875, 0.4216198875, 0.3997200876}, true);
  scene.solver.points = 10;
  expect_published_pose(scene, {-1.504236, -0.885422, -4.479855});
}

// Leg lengths of the home pose (-0.05, 0, 0.4), 10 degrees, and poses under forces: an independent
// solver's.
TEST(StewartGough, MovesUnderPlateForcesAsAnIndependentSolverSays) {
  struct Case {
    Vec3 force, position, rotation;
  };

  const Case cases[] = {{{0, 0, 0}, {-0.05, 0, 0.4}, {0, 0.174532925199, 0}},
                        {{4, 0, 0}, {-0.0454817370897, 0, 0.40018055553}, {0, 0.184220094812, 0}},
                        {{0, 0.5, 0},
                         {-0.0499959447725, 0.000763303615357, 0.399998670298},
                         {7.99430974514e-05, 0.174514424169, -0.00159262097097}},
                        {{1, 1, -1},
                         {-0.0491102923221, 0.00157399989054, 0.400028580367},
                         {0.000139500896596, 0.176133077361, -0.00294910355327}}};
  for (const Case& c : cases) {
    Scene scene = stewart_gough({0.407718055774, 0.407718055774, 0.39532696447, 0.431598378093,
                                 0.431598378093, 0.39532696447},
                                true, 0.0921);
    for (RodSpec& leg : scene.rods) {
      leg.material->youngs_modulus = 207e9;
      leg.material->shear_modulus = 207e9 / 2.6;
    }
    scene.solver.points = 10;
    LoadSpec load;
    load.at.body = 0;
    load.force = c.force;
    scene.loads.push_back(load);
    const Equilibrium equilibrium(scene, 1e-10);
    ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
    const RigidBody& plate = equilibrium.robot.bodies[0];
    EXPECT_LT((plate.p - c.position).norm(), 1e-7) << c.force.transpose();
    EXPECT_LT((log_so3(plate.R) - c.rotation).norm(), 1e-6) << c.force.transpose();
  }
}

TEST(StewartGough, ConvergesWithoutShearAndExtensionFromStraightLegs) {
  Scene scene = stewart_gough({0.40, 0.41, 0.42, 0.40, 0.39, 0.41}, false);
  scene.effects.set(Effect::kShear, false);
  scene.effects.set(Effect::kExtension, false);
  const Equilibrium equilibrium(scene);
  EXPECT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  EXPECT_LE(equilibrium.report.iterations, 30);
}

TEST(StewartGough, ForgetsItsGridWithTheSixthPowerOfTheCells) {
  const std::vector<double> lengths{0.3973263874, 0.3973263874, 0.3997201023,
                                    0.4216240113, 0.4216240113, 0.3997201023};
  auto plate = [&](int cells) {
    Scene scene = stewart_gough(lengths, false);
    scene.solver.points = cells;
    const Equilibrium equilibrium(scene);
    EXPECT_TRUE(equilibrium.report.converged());
    return equilibrium.robot.bodies[0].p;
  };
  const Vec3 fine = plate(32);
  EXPECT_NEAR(std::log2((plate(5) - fine).norm() / (plate(10) - fine).norm()), 6, 0.4);
}

}  // namespace
}  // namespace cprsim
