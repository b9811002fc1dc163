// SPDX-License-Identifier: BSD-3-Clause
// Where a motion ends: folds and dead centres. The run stops there and says so; it neither jumps
// nor goes on with a wrong number.
#include <gtest/gtest.h>

#include "scenes/loader/load.h"
#include "tests/stability/measure.h"
#include "tests/support/jointed_bodies.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

ProfileTerm ramp(double from, double to) {
  ProfileTerm term;
  term.shape = ShapeOfTime::kRamp;
  term.from = from;
  term.to = to;
  term.end = 1;
  return term;
}

/// Lee's frame (scenes/paths) under a load that grows, in quasi-static steps of 0.01 s.
Scene pressed_frame(double load, const ProfileTerm& growth, double duration) {
  Scene scene = *load_scene(CPRSIM_SOURCE_DIR "/scenes/paths/lees_frame.xml").scene;
  scene.simulation.mode = Mode::kQuasistatic;
  scene.simulation.duration = duration;
  scene.solver.step = 0.01;
  scene.loads[0].force = {0, 0, -load};
  scene.loads[0].has_profile = true;
  scene.loads[0].profile.terms = {growth};
  return scene;
}

// N11: Lee's frame under a load that grows past the fold at 18546.5587 (scenes/paths).
TEST(QuasiStatics, StopsAtAFold) {
  const Scene scene = pressed_frame(20000, ramp(0, 1), 1);
  Simulation simulation(by_method(scene));
  simulation.start();
  double farthest = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    farthest =
        std::max(farthest,
                 (simulation.now().bodies[0].X_WB.p - simulation.before().bodies[0].X_WB.p).norm());
  }
  EXPECT_EQ(simulation.status(), RunStatus::kFailed);
  EXPECT_NE(simulation.failure().find("no equilibrium found beyond"), std::string::npos)
      << simulation.failure();
  measure("distance of the last load to the fold", 1 - simulation.time() * 20000 / 18546.5587,
          2e-3);
  EXPECT_LT(simulation.time() * 20000, 18546.5587);
  EXPECT_LT(farthest, 5) << "no jump, of legs of 120";
}

// A load that turns at 0.013 s is met there; the steps after that come back to those of the scene.
TEST(QuasiStatics, KeepsToItsInstants) {
  ProfileTerm late = ramp(0, 1);
  late.start = 0.013;
  const Scene scene = pressed_frame(100, late, 0.04);
  Simulation simulation(by_method(scene));
  simulation.start();
  std::vector<double> times;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    times.push_back(simulation.time());
  }
  const std::vector<double> expected{0.01, 0.013, 0.02, 0.03, 0.04};
  ASSERT_EQ(times.size(), expected.size());
  for (std::size_t i = 0; i < times.size(); ++i)
    EXPECT_NEAR(times[i], expected[i], 1e-12);
}

// N13: a crank of 0.1 m and a rod of 0.3 m, whose slider is driven towards 0.45 m: dead centre is
// at 0.4 m.
TEST(DeadCentre, StopsTheRunAndIsNamed) {
  for (const Mode mode : {Mode::kQuasistatic, Mode::kDynamic}) {
    Scene scene;
    const double x = 0.35, crank = std::acos((0.01 + x * x - 0.09) / (2 * 0.1 * x));
    const Vec3 A(0.1 * std::cos(crank), 0.1 * std::sin(crank), 0), B(x, 0, 0);
    const double coupler = std::atan2(B.y() - A.y(), B.x() - A.x());
    const auto turned = [](double angle) {
      return Mat3(Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix());
    };
    scene.bodies.push_back(lump("crank", {turned(crank), 0.5 * A}, 0.1, {1e-4, 1e-4, 1e-4}));
    scene.bodies.push_back(
        lump("coupler", {turned(coupler), 0.5 * (A + B)}, 0.3, {2e-3, 2e-3, 2e-3}));
    scene.bodies.push_back(lump("slider", {Mat3::Identity(), B}, 0.1, {1e-4, 1e-4, 1e-4}));
    const Vec3 z = Vec3::UnitZ();
    scene.joints.push_back(joint_at(scene, JointKind::kRevolute, Vec3::Zero(), kWorld, 0, z));
    scene.joints.push_back(joint_at(scene, JointKind::kRevolute, A, 0, 1, z));
    scene.joints.push_back(joint_at(scene, JointKind::kRevolute, B, 1, 2, z));
    scene.joints.push_back(joint_at(scene, JointKind::kPrismatic, B, kWorld, 2, Vec3::UnitX()));
    DriveSpec drive;
    drive.joint = 3;
    drive.profile.terms = {ramp(0, 0.1)};
    scene.drives.push_back(drive);
    scene.simulation.mode = mode;
    scene.simulation.duration = 1;
    scene.solver.step = 0.01;
    Simulation simulation(by_method(scene));
    simulation.start();
    while (simulation.status() == RunStatus::kRunning)
      simulation.advance();
    EXPECT_EQ(simulation.status(), RunStatus::kFailed);
    const double reached = simulation.now().bodies[2].X_WB.p.x();
    measure(std::string("distance left to the dead centre, m, ") +
                (mode == Mode::kDynamic ? "dynamic" : "quasi-static"),
            std::abs(0.4 - reached), 1.1e-3);
    EXPECT_FALSE(simulation.last_report().worst_row.empty());
    EXPECT_TRUE(simulation.now().bodies[0].X_WB.p.allFinite());
  }
}

}  // namespace
}  // namespace cprsim
