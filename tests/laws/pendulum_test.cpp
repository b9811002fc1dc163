// SPDX-License-Identifier: BSD-3-Clause
// Pendulums on revolute, universal and ball joints.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/math/so3.h"
#include "tests/support/jointed_bodies.h"

namespace cprsim {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMass = 0.4, kArm = 0.25, kGravity = 9.81;
const Vec3 kInertia(2e-3, 3e-3, 1e-3);

/// A body that hangs from the origin, turned by `angle` about the world's y axis out of the plumb.
Scene pendulum(JointKind kind, double angle) {
  Scene scene;
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {0, 0, -kGravity};
  const Mat3 R = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
  scene.bodies.push_back(lump("bob", {R, R * Vec3(0, 0, -kArm)}, kMass, kInertia));
  scene.joints.push_back(joint_at(scene, kind, Vec3::Zero(), kWorld, 0, Vec3::UnitY()));
  return scene;
}

// Period 4 K(sin(angle / 2)) sqrt(I / (m g l)); after it the body is where it began.
TEST(PhysicalPendulum, HasThePeriodOfTheEllipticIntegral) {
  constexpr double kAngle = 2;
  const double inertia = kInertia.y() + kMass * kArm * kArm;
  const double period =
      4 * std::comp_ellint_1(std::sin(kAngle / 2)) * std::sqrt(inertia / (kMass * kGravity * kArm));
  for (JointKind kind : {JointKind::kRevolute, JointKind::kUniversal, JointKind::kBall}) {
    Scene scene = pendulum(kind, kAngle);
    scene.joints[0].second.axis = Vec3::UnitX();
    move_for(scene, period / 4, 1e-8);
    Simulation simulation(scene);
    const Snapshot end = run_to_end(simulation);
    ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    // upright after a quarter of the period
    const Vec3 p = end.bodies[0].X_WB.p;
    const double rate = std::sqrt(2 * kMass * kGravity * kArm * (1 - std::cos(kAngle)) / inertia);
    EXPECT_NEAR(std::atan2(-p.x(), -p.z()) / rate, 0, 1e-6 * period) << static_cast<int>(kind);
    EXPECT_NEAR(end.bodies[0].angular_velocity.y(), -rate, 1e-5 * rate);
    const Vec3 turned = end.joints[0].position;
    EXPECT_NEAR(kind == JointKind::kBall ? turned.y() : turned.x(), -kAngle, 1e-5);
    EXPECT_LT(std::abs(end.energy.balance), 1e-5 * kMass * kGravity * kArm);
  }
}

/// The bob circles the plumb line: steady precession of a symmetric body whose attitude turns with
/// its azimuth. Rate² cos(angle) (m l² + I_1 - I_3) = m g l.
Scene circling(JointKind kind, double angle, double& rate) {
  Scene scene = pendulum(kind, angle);
  const double I1 = kInertia.x(), I3 = kInertia.z();
  BodySpec& bob = scene.bodies[0];
  bob.inertia.diagonal() = Vec3(I1, I1, I3);
  rate = std::sqrt(kMass * kGravity * kArm / (std::cos(angle) * (kMass * kArm * kArm + I1 - I3)));
  bob.velocity_given = true;
  bob.angular_velocity = rate * Vec3::UnitZ();
  bob.linear_velocity = bob.angular_velocity.cross(bob.X_WB.p);
  return scene;
}

TEST(SphericalPendulum, OnABallPrecessesSteadily) {
  double rate = 0;
  Scene scene = circling(JointKind::kBall, 0.6, rate);
  move_for(scene, 0.6 * kPi / rate, 1e-8);
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  const Mat3 turn = exp_so3(0.6 * kPi * Vec3::UnitZ());
  EXPECT_LT((end.bodies[0].X_WB.p - turn * scene.bodies[0].X_WB.p).norm(), 1e-6 * kArm);
  EXPECT_LT((end.bodies[0].X_WB.R - turn * scene.bodies[0].X_WB.R).norm(), 1e-5);
  EXPECT_NEAR(end.joints[0].velocity.z(), rate, 1e-5 * rate);
  EXPECT_LT(std::abs(end.energy.balance), 1e-6 * kMass * kGravity * kArm);
}

// On a universal the spin about the bob's own line is held; a point mass does not feel that.
TEST(SphericalPendulum, OnAUniversalCirclesLikeAPointMass) {
  double rate = 0;
  Scene scene = circling(JointKind::kUniversal, 0.6, rate);
  BodySpec& bob = scene.bodies[0];
  bob.inertia.diagonal().setConstant(1e-9);
  rate = std::sqrt(kGravity / (kArm * std::cos(0.6)));
  // velocity of the two axes that carry the point: omega = rate_1 y + rate_2 R x
  const Vec3 v = rate * Vec3::UnitZ().cross(bob.X_WB.p);
  scene.joints[0].second.axis = bob.X_WB.R.col(0);
  bob.angular_velocity = -v.y() / kArm * bob.X_WB.R.col(0);
  bob.angular_velocity = bob.X_WB.p.cross(v) / (kArm * kArm);
  const Vec3 y = Vec3::UnitY(), x = scene.joints[0].second.axis;
  bob.angular_velocity = bob.angular_velocity.dot(y) * y + bob.angular_velocity.dot(x) * x;
  bob.linear_velocity = bob.angular_velocity.cross(bob.X_WB.p);
  ASSERT_LT((bob.linear_velocity - v).norm(), 1e-12);
  move_for(scene, 1.2 * kPi / rate, 1e-8);
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  const Mat3 turn = exp_so3(1.2 * kPi * Vec3::UnitZ());
  EXPECT_LT((end.bodies[0].X_WB.p - turn * bob.X_WB.p).norm(), 1e-4 * kArm);
  EXPECT_LT(std::abs(end.energy.balance), 1e-6 * kMass * kGravity * kArm);
}

// I theta_tt = -k theta - c theta_t on every kind that turns about y, without gravity.
TEST(TorsionPendulum, DecaysByItsSpringAndDamper) {
  const double I = kInertia.y(), k = 0.5, c = 0.01, t = 0.1;
  const double decay = c / (2 * I), omega = std::sqrt(k / I - decay * decay);
  // from rest at theta = 0, the spring relaxed at 0.4; a ball from -0.4, its spring relaxed at 0
  for (JointKind kind : {JointKind::kRevolute, JointKind::kBall, JointKind::kScrew,
                         JointKind::kPlanar, JointKind::kCylindrical}) {
    Scene scene = pendulum(kind, 0);
    scene.effects.set(Effect::kGravity, false);
    scene.bodies[0].X_WB.p.setZero();
    scene.joints[0] = joint_at(scene, kind, Vec3::Zero(), kWorld, 0, Vec3::UnitY());
    JointSpec& joint = scene.joints[0];
    joint.screw_pitch = 1e-9;  // m per turn: hardly any mass to move
    const int turning = freedom_count(kind) - 1;
    if (kind == JointKind::kPlanar) {
      joint.axis = Vec3::UnitZ();
      joint.second.axis = Vec3::UnitX();
    }
    AxisSpec& axis = kind == JointKind::kBall ? joint : axis_of(joint, turning);
    axis.spring_stiffness = k;
    axis.damping = c;
    axis.spring_reference = 0.4;
    if (kind == JointKind::kBall) {
      axis.spring_reference = 0;
      joint.X_PJ.R = exp_so3(0.4 * Vec3::UnitY());
    }
    move_for(scene, t, 1e-8);
    Simulation simulation(scene);
    const Snapshot end = run_to_end(simulation);
    ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    const double left =
        -0.4 * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
    const double angle = log_so3(end.bodies[0].X_WB.R).y();
    EXPECT_NEAR(angle - 0.4, left, 1e-6) << static_cast<int>(kind);
    EXPECT_GT(end.energy.dissipated, 0.05 * 0.5 * k * 0.16);
    EXPECT_LT(std::abs(end.energy.balance), 1e-6 * 0.5 * k * 0.16);
  }
}

}  // namespace
}  // namespace cprsim
