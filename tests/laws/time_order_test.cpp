// SPDX-License-Identifier: BSD-3-Clause
// Order in time on the whole six-rod robot: smooth motion, all the machinery between step and
// plate.
#include <gtest/gtest.h>

#include "tests/support/robots.h"

namespace cprsim {
namespace {

Scene driven_robot(SchemeKind scheme, double step) {
  Scene scene = stewart_gough({0.4, 0.4, 0.41, 0.42, 0.41, 0.4}, false);
  switch_on(scene, {Effect::kDamping});
  for (RodSpec& leg : scene.rods)
    damp(leg, 2e-3);
  for (int i = 0; i < 2; ++i) {
    DriveSpec drive;
    drive.quantity = DriveQuantity::kLength;
    drive.rod = i;
    ProfileTerm rest, rise;
    rest.value = 0.4;
    rise.shape = ShapeOfTime::kSmoothstep;
    rise.to = 0.02;
    rise.end = 0.2;
    drive.profile.terms = {rest, rise};
    scene.drives.push_back(drive);
  }
  scene.solver.points = 4;
  scene.solver.scheme = scheme;
  scene.solver.step = step;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.1;
  return scene;
}

Vec3 plate_after(SchemeKind scheme, double step) {
  const Scene scene = driven_robot(scheme, step);
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  return end.bodies[0].X_WB.p;
}

class RobotOrder : public ::testing::TestWithParam<SchemeKind> {};

TEST_P(RobotOrder, IsTwoAtLeast) {
  static const Vec3 reference = plate_after(SchemeKind::kEsdirk43, 2.5e-4);
  const double coarse = (plate_after(GetParam(), 1e-3) - reference).norm();
  const double fine = (plate_after(GetParam(), 5e-4) - reference).norm();
  EXPECT_GT(std::log2(coarse / fine), 1.8) << coarse << " " << fine;
}

// In steps eight times as long; stiff strains cost some of its five orders.
TEST(Radau5Order, OnARobotIsThreeAtLeast) {
  const Vec3 reference = plate_after(SchemeKind::kEsdirk43, 2.5e-4);
  const double coarse = (plate_after(SchemeKind::kRadau5, 0.01) - reference).norm();
  const double fine = (plate_after(SchemeKind::kRadau5, 0.005) - reference).norm();
  EXPECT_GT(std::log2(coarse / fine), 3) << coarse << " " << fine;
  EXPECT_LT(fine, 0.1 * (plate_after(SchemeKind::kEsdirk43, 0.005) - reference).norm());
}

INSTANTIATE_TEST_SUITE_P(Schemes, RobotOrder,
                         ::testing::Values(SchemeKind::kBdf2, SchemeKind::kBdfAlpha,
                                           SchemeKind::kGeneralizedAlpha, SchemeKind::kTrBdf2,
                                           SchemeKind::kEsdirk32));

}  // namespace
}  // namespace cprsim
