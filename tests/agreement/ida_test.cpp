// SPDX-License-Identifier: BSD-3-Clause
// Motion by IDA of SUNDIALS, whose formulas, error control and step sizes are its own, against the
// engine's schemes: every method, rods and bodies that turn far, closed loops, jumps.
#include <gtest/gtest.h>

#include <numbers>

#include "engine/math/so3.h"
#include "tests/support/jointed_bodies.h"
#include "tests/support/methods.h"
#include "tests/support/planar_robots.h"
#include "tests/support/released_rod.h"

namespace cprsim {
namespace {

Scene by(Scene scene, SchemeKind scheme, double tolerance) {
  scene.solver.scheme = scheme;
  scene.solver.tolerance = tolerance;
  scene.solver.residual_tolerance = 1e-11;
  return scene;
}

Snapshot finish(const Scene& scene, RunStatistics* statistics = nullptr) {
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  if (statistics != nullptr) *statistics = simulation.statistics();
  return end;
}

/// Largest distance of any link or tip.
double farthest(const Snapshot& a, const Snapshot& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.bodies.size(); ++i)
    most = std::max(most, (a.bodies[i].X_WB.p - b.bodies[i].X_WB.p).norm());
  for (std::size_t i = 0; i < a.rods.size(); ++i)
    most = std::max(most,
                    (a.rods[i].points.back().position - b.rods[i].points.back().position).norm());
  return most;
}

/// Finely enough for 1e-7 of a length, in space.
Scene cut(Scene scene, Method method) {
  scene.solver.method = method;
  scene.solver.points = 6;
  scene.solver.order = 6;
  scene.solver.elements = method == Method::kCollocation ? 6 : 1;
  return scene;
}

// Every method against one solution by the engine's own scheme, and by shooting.
class Ida : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Methods, Ida, ::testing::ValuesIn(kEveryMethod), test_name);

TEST_P(Ida, ReleasesARod) {
  Scene scene = released_rod_scene();
  scene.simulation.duration = 0.05;
  EXPECT_LT(farthest(finish(by(cut(scene, GetParam()), SchemeKind::kIda, 1e-7)),
                     finish(by(cut(scene, Method::kShooting), SchemeKind::kEsdirk43, 1e-8))),
            4e-7);  // 1e-6 L
}

// A clamp that turns twice takes the frames, in which rotation vectors are measured, along.
TEST_P(Ida, TurnsAnArmTwice) {
  Scene scene;
  switch_on(scene, {Effect::kGravity, Effect::kRotaryInertia, Effect::kDamping});
  scene.gravity = {0, 0, -9.81};
  scene.rods.push_back(steel_rod(0.5, 2e-3));
  damp(scene.rods[0], 2e-3);
  scene.bodies.push_back(lump("hub", Pose{}, 1, Vec3(1e-3, 1e-3, 1e-3)));
  scene.joints.push_back(joint_at(scene, JointKind::kContinuous, Vec3::Zero(), kWorld, 0));
  scene.rods[0].base.at.body = 0;
  scene.rods[0].base.at.X_BF.R = exp_so3(Vec3(0, 0.5 * std::numbers::pi, 0));
  drive(scene, 0, DriveQuantity::kPosition, 0).profile = ramp(0, 4 * std::numbers::pi, 0.5);
  set_dynamic(scene, 0.5, 0.01, SchemeKind::kIda);
  scene.simulation.initial_static = true;
  scene.solver.step.reset();
  const Snapshot ours = finish(by(cut(scene, Method::kShooting), SchemeKind::kEsdirk43, 1e-8)),
                 ida = finish(by(cut(scene, GetParam()), SchemeKind::kIda, 1e-8));
  EXPECT_LT(farthest(ida, ours), 5e-7);  // 1e-6 L
  EXPECT_NEAR(ida.energy.total, ours.energy.total, 1e-5 * ours.energy.work);
}

TEST(IdaScheme, MovesClosedLoopsOfRodsAndBodies) {
  Scene scene = rfrfr(coordinate_plane(), 0.4);
  switch_on(scene, {Effect::kGravity, Effect::kDamping});
  for (RodSpec& rod : scene.rods)
    damp(rod, 3e-3);
  set_dynamic(scene, 0.3, 0.01, SchemeKind::kIda);
  scene.solver.step.reset();
  scene.solver.points = 4;
  const Snapshot ours = finish(by(scene, SchemeKind::kEsdirk43, 1e-9));
  EXPECT_LT(farthest(finish(by(scene, SchemeKind::kIda, 1e-8)), ours), 1e-6);
  scene.planar_normal = coordinate_plane().col(2);
  EXPECT_LT(farthest(finish(by(scene, SchemeKind::kIda, 1e-8)), ours), 1e-6);
}

TEST(IdaScheme, ErrorsFallWithTheToleranceAndStepsGrowOnlyWithItsRoot) {
  Scene scene = released_rod_scene();
  scene.simulation.duration = 0.05;
  scene.solver.points = 3;
  const Snapshot ours = finish(by(scene, SchemeKind::kEsdirk43, 1e-10));
  double error = 1;
  RunStatistics before, after;
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    before = after;
    const double now = farthest(finish(by(scene, SchemeKind::kIda, tolerance), &after), ours);
    EXPECT_LT(now, 0.1 * error) << tolerance;
    error = now;
  }
  // of first order there would be ten times as many steps
  EXPECT_LT(after.steps, 8 * before.steps);
  EXPECT_LE(after.worst_residual, 1e-11);
}

// What jumps is met with the end of a step, and a step of the engine's own follows.
TEST(IdaScheme, MeetsJumps) {
  Scene scene = released_rod_scene();
  scene.solver.points = 3;
  scene.simulation.duration = 0.02;
  LoadSpec& knock = add_load(scene, 1, {0, 0.3, 0});
  ProfileTerm step;
  step.shape = ShapeOfTime::kStep;
  step.start = 0.01;
  step.to = 1;
  knock.has_profile = true;
  knock.profile.terms.push_back(step);
  Simulation simulation(by(scene, SchemeKind::kIda, 1e-7));
  simulation.start();
  bool met = false;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    met = met || simulation.time() == 0.01;
  }
  EXPECT_TRUE(met);
  EXPECT_LT(farthest(simulation.now(), finish(by(scene, SchemeKind::kEsdirk43, 1e-9))), 4e-7);
}

}  // namespace
}  // namespace cprsim
