// SPDX-License-Identifier: BSD-3-Clause
// A planar four-bar of four revolutes with parallel axes: 24 closure rows for 18 + 4 unknown
// motions, three of them redundant, one freedom left.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/so3.h"
#include "tests/support/jointed_bodies.h"

namespace cprsim {
namespace {

// Grashof: crank 0.1 m, coupler 0.3, rocker 0.25, ground 0.3
constexpr double kCrank = 0.1, kCoupler = 0.3, kRocker = 0.25, kGround = 0.3;

struct Shape {
  double coupler, rocker;  ///< angles to the ground link
};

/// Closed form: the two circles about the crank's end and the rocker's pivot, upper crossing.
Shape closed_form(double crank) {
  const double x = kGround - kCrank * std::cos(crank), y = -kCrank * std::sin(crank);
  const double d = std::hypot(x, y), towards = std::atan2(y, x);
  const double inner =
      std::acos((d * d + kCoupler * kCoupler - kRocker * kRocker) / (2 * d * kCoupler));
  const double a = towards + inner;
  const double ex = kCoupler * std::cos(a) - x, ey = kCoupler * std::sin(a) - y;
  return {a, std::atan2(ey, ex)};
}

Vec3 along(double angle) {
  return {std::cos(angle), std::sin(angle), 0};
}

/// Links in the x-y plane, gravity along -y, everything rotated as a whole by R.
Scene four_bar(double crank, const Mat3& R) {
  Scene scene;
  switch_on(scene, {Effect::kGravity});
  scene.gravity = R * Vec3(0, -9.81, 0);
  const Shape shape = closed_form(crank);
  const Vec3 A = Vec3::Zero(), B = kCrank * along(crank), C = B + kCoupler * along(shape.coupler),
             D(kGround, 0, 0);
  const auto link = [&](const char* name, const Vec3& from, const Vec3& to, double angle,
                        double m) {
    const double l = (to - from).norm();
    const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
    scene.bodies.push_back(
        lump(name, {R * turn, R * (0.5 * (from + to))}, m, m * l * l / 12 * Vec3(0.01, 1, 1)));
  };
  link("crank", A, B, crank, 0.1);
  link("coupler", B, C, shape.coupler, 0.3);
  link("rocker", D, C, shape.rocker, 0.25);
  const Vec3 axis = R * Vec3::UnitZ();
  scene.joints.push_back(joint_at(scene, JointKind::kRevolute, R * A, kWorld, 0, axis));
  scene.joints.push_back(joint_at(scene, JointKind::kRevolute, R * B, 0, 1, axis));
  scene.joints.push_back(joint_at(scene, JointKind::kRevolute, R * C, 1, 2, axis));
  scene.joints.push_back(joint_at(scene, JointKind::kRevolute, R * D, kWorld, 2, axis));
  return scene;
}

double height(const Shape& shape, double crank) {
  const double b = kCrank * std::sin(crank), c = b + kCoupler * std::sin(shape.coupler);
  return 0.1 * 0.5 * b + 0.3 * 0.5 * (b + c) + 0.25 * 0.5 * c;
}

const Mat3 kAttitudes[] = {Mat3::Identity(), exp_so3(Vec3(0.4, -0.7, 0.3))};

// Position driven in statics: the other angles are the closed form's, the torque is the derivative
// of the potential energy.
TEST(FourBar, StandsInItsClosedFormWithTheTorqueOfVirtualWork) {
  for (const Mat3& R : kAttitudes) {
    const double start = 1, crank = 1.7;
    Scene scene = four_bar(start, R);
    drive(scene, 0, DriveQuantity::kPosition, crank - start);
    Simulation simulation(scene);
    const Snapshot end = run_to_end(simulation);
    ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    const Shape from = closed_form(start), to = closed_form(crank);
    EXPECT_NEAR(end.joints[3].position.x(), to.rocker - from.rocker, 1e-8);
    EXPECT_NEAR(end.joints[1].position.x(), to.coupler - from.coupler - (crank - start), 1e-8);
    const double h = 1e-5;
    const double torque =
        9.81 *
        (height(closed_form(crank + h), crank + h) - height(closed_form(crank - h), crank - h)) /
        (2 * h);
    EXPECT_NEAR(end.joints[0].effort.x(), torque, 1e-7);
  }
}

TEST(FourBar, FindsItsEquilibriumUnderASpring) {
  Scene scene = four_bar(1, kAttitudes[1]);
  scene.joints[0].spring_stiffness = 2;
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  const double q = end.joints[0].position.x(), h = 1e-5;
  const double slope =
      (height(closed_form(1 + q + h), 1 + q + h) - height(closed_form(1 + q - h), 1 + q - h)) /
      (2 * h);
  EXPECT_NEAR(2 * q, -9.81 * slope, 1e-7);
}

// Let go: energy is kept, the loop stays closed, through more than a turn of the crank.
TEST(FourBar, KeepsItsEnergyInFreeMotion) {
  for (const Mat3& R : kAttitudes) {
    Scene scene = four_bar(1.2, R);
    move_for(scene, 1, 1e-7);
    Simulation simulation(scene);
    const SolveReport& start = simulation.start();
    ASSERT_TRUE(start.converged());
    double most = 0, open = 0, fastest = 0;
    while (simulation.status() == RunStatus::kRunning) {
      simulation.advance();
      const Snapshot& now = simulation.now();
      most = std::max(most, std::abs(now.energy.balance));
      fastest = std::max(fastest, now.energy.kinetic);
      const double crank = 1.2 + now.joints[0].position.x();
      const Shape shape = closed_form(crank);
      const double rocker = closed_form(1.2).rocker + now.joints[3].position.x();
      open = std::max(open, std::abs(std::remainder(shape.rocker - rocker, 2 * M_PI)));
    }
    ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    EXPECT_EQ(simulation.statistics().retried, 0);
    EXPECT_GT(fastest, 0.1);
    EXPECT_LT(most, 1e-4 * fastest);
    EXPECT_LT(open, 1e-7);
  }
}

}  // namespace
}  // namespace cprsim
