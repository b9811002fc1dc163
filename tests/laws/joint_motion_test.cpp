// SPDX-License-Identifier: BSD-3-Clause
// Joints that slide, screw, rub and stop.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/math/so3.h"
#include "tests/support/jointed_bodies.h"

namespace cprsim {
namespace {

constexpr double kMass = 0.4;
const Vec3 kInertia(2e-3, 3e-3, 1e-3);

Scene on_joint(JointKind kind, const Vec3& axis = Vec3::UnitX()) {
  Scene scene;
  scene.bodies.push_back(lump("slider", {}, kMass, kInertia));
  scene.joints.push_back(joint_at(scene, kind, Vec3::Zero(), kWorld, 0, axis));
  return scene;
}

void give_velocity(Scene& scene, const Vec3& v, const Vec3& omega = Vec3::Zero()) {
  scene.bodies[0].velocity_given = true;
  scene.bodies[0].linear_velocity = v;
  scene.bodies[0].angular_velocity = omega;
}

Snapshot run(const Scene& scene) {
  Simulation simulation(scene);
  Snapshot end = run_to_end(simulation);
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  return end;
}

// Links that are welded together move as one, whichever of them the scene gives the velocity.
TEST(Welded, LinksTakeTheVelocityOfAnyOfThem) {
  const Vec3 v(0.3, -0.2, 0.1), omega(1, 2, -0.5), apart(0.2, 0.1, -0.3);
  std::vector<Snapshot> ends;
  for (const std::size_t given : {0U, 1U}) {
    Scene scene;
    scene.bodies = {lump("a", {}, kMass, kInertia),
                    lump("b", {Mat3::Identity(), apart}, kMass, kInertia)};
    scene.joints = {joint_at(scene, JointKind::kFixed, Vec3::Zero(), 0, 1)};
    BodySpec& body = scene.bodies[given];
    body.velocity_given = true;
    body.linear_velocity = given == 0 ? v : Vec3(v + omega.cross(apart));
    body.angular_velocity = omega;
    move_for(scene, 0.1, 1e-9);
    Simulation simulation(scene);
    simulation.start();
    EXPECT_LT((simulation.now().bodies[0].linear_velocity - v).norm(), 1e-12);
    ends.push_back(run(scene));
  }
  EXPECT_GT(ends[0].bodies[0].X_WB.p.norm(), 0.01);
  EXPECT_LT((ends[0].bodies[1].X_WB.p - ends[1].bodies[1].X_WB.p).norm(), 1e-12);
}

// (I + m (p / 2 pi)²) q_tt = M
TEST(Screw, TurnsAndAdvancesUnderATorque) {
  constexpr double kPitch = 0.02, kTorque = 1e-3, kTime = 0.5;
  const double lead = kPitch / (2 * std::numbers::pi);
  const double q = 0.5 * kTorque / (kInertia.x() + kMass * lead * lead) * kTime * kTime;
  for (bool load : {false, true}) {
    Scene scene = on_joint(JointKind::kScrew);
    scene.joints[0].screw_pitch = kPitch;
    if (load) {
      LoadSpec torque;
      torque.at.body = 0;
      torque.torque = {kTorque, 0, 0};
      scene.loads.push_back(torque);
    } else {
      drive(scene, 0, DriveQuantity::kEffort, kTorque);
    }
    move_for(scene, kTime, 1e-8);
    const Snapshot end = run(scene);
    EXPECT_NEAR(end.joints[0].position.x(), q, 1e-8 * q);
    EXPECT_NEAR(end.bodies[0].X_WB.p.x(), lead * q, 1e-8 * lead * q);
    EXPECT_NEAR(end.energy.work, kTorque * q, 1e-6 * kTorque * q);
    EXPECT_LT(std::abs(end.energy.balance), 1e-6 * kTorque * q);
  }
}

// A force along a screw that cannot turn is held by its torque, F lead.
TEST(Screw, HoldsAThrustWithTheTorqueOfItsLead) {
  Scene scene = on_joint(JointKind::kScrew);
  scene.joints[0].screw_pitch = 0.02;
  LoadSpec thrust;
  thrust.at.body = 0;
  thrust.force = {-50, 0, 0};
  scene.loads.push_back(thrust);
  drive(scene, 0, DriveQuantity::kPosition, 3);
  const Snapshot end = run(scene);
  EXPECT_NEAR(end.joints[0].effort.x(), 50 * 0.02 / (2 * std::numbers::pi), 1e-12);
  EXPECT_NEAR(end.bodies[0].X_WB.p.x(), 3 * 0.02 / (2 * std::numbers::pi), 1e-12);
}

// A slider is at speed at once, and stops at once: m v²/2 goes in, and comes out again.
TEST(PositionDrive, GivesAndTakesTheEnergyOfAJumpOfItsSpeed) {
  constexpr double kSpeed = 0.5, kEnergy = 0.5 * kMass * kSpeed * kSpeed;
  for (SchemeKind scheme : {SchemeKind::kEsdirk32, SchemeKind::kEsdirk43, SchemeKind::kBdfAlpha,
                            SchemeKind::kGeneralizedAlpha}) {
    const auto after = [&](double time) {
      Scene scene = on_joint(JointKind::kPrismatic);
      ProfileTerm& ramp = drive(scene, 0, DriveQuantity::kPosition, 0).profile.terms.front();
      ramp.shape = ShapeOfTime::kRamp;
      ramp.to = 0.1 * kSpeed;
      ramp.start = 0.1;
      ramp.end = 0.2;
      move_for(scene, time, 1e-6);
      scene.solver.scheme = scheme;
      scene.solver.step = 0.01;
      return run(scene).energy;
    };
    const EnergySample going = after(0.15), stopped = after(0.3);
    EXPECT_NEAR(going.kinetic, kEnergy, 1e-9 * kEnergy) << static_cast<int>(scheme);
    EXPECT_NEAR(going.work, kEnergy, 1e-9 * kEnergy) << static_cast<int>(scheme);
    EXPECT_NEAR(stopped.kinetic, 0, 1e-9 * kEnergy) << static_cast<int>(scheme);
    EXPECT_NEAR(stopped.work, 0, 1e-9 * kEnergy) << static_cast<int>(scheme);
  }
}

TEST(EffortDrive, SaturatesAtTheEffortLimit) {
  Scene scene = on_joint(JointKind::kPrismatic);
  scene.joints[0].effort_limit = 2;
  drive(scene, 0, DriveQuantity::kEffort, -7);
  move_for(scene, 0.3, 1e-8);
  const Snapshot end = run(scene);
  EXPECT_NEAR(end.joints[0].effort.x(), -2, 1e-8);
  EXPECT_NEAR(end.joints[0].position.x(), -0.5 * 2 / kMass * 0.09, 1e-9);
  EXPECT_LT(std::abs(end.energy.balance), 1e-8);
}

// Slide and turn of a cylindrical joint do not know of each other.
TEST(Cylindrical, SlidesAndTurnsIndependently) {
  Scene scene = on_joint(JointKind::kCylindrical);
  drive(scene, 0, DriveQuantity::kVelocity, 0.3, 0);
  drive(scene, 0, DriveQuantity::kEffort, 1e-3, 1);
  move_for(scene, 0.5, 1e-8);
  const Snapshot end = run(scene);
  EXPECT_NEAR(end.joints[0].position[0], 0.15, 1e-9);
  EXPECT_NEAR(end.joints[0].position[1], 0.5 * 1e-3 / kInertia.x() * 0.25, 1e-8);
  EXPECT_NEAR(end.bodies[0].X_WB.p.x(), 0.15, 1e-9);
  EXPECT_NEAR(log_so3(end.bodies[0].X_WB.R).x(), end.joints[0].position[1], 1e-9);
}

// A free body in the plane: the centre goes straight, the body turns evenly, and gravity across the
// plane does nothing.
TEST(Planar, GlidesFreely) {
  Scene scene = on_joint(JointKind::kPlanar);
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {0, 0, -9.81};
  scene.joints[0].second.axis = Vec3::UnitY();
  give_velocity(scene, {0.3, -0.2, 0}, {0, 0, 4});
  move_for(scene, 0.5, 1e-8);
  const Snapshot end = run(scene);
  EXPECT_LT((end.joints[0].position - Vec3(0.15, -0.1, 2)).norm(), 1e-6);
  EXPECT_LT((end.joints[0].velocity - Vec3(0.3, -0.2, 4)).norm(), 1e-5);
  EXPECT_LT((end.bodies[0].X_WB.p - Vec3(0.15, -0.1, 0)).norm(), 1e-6);
}

// v²/(2 F/m) and there it stays, against a load below F.
TEST(DryFriction, StopsASliderAfterTheAnalyticDistanceAndHoldsIt) {
  constexpr double kFriction = 0.8, kSpeed = 0.5;
  const double distance = kMass * kSpeed * kSpeed / (2 * kFriction);
  const double stop = kMass * kSpeed / kFriction;
  const auto at = [&](double time, double* energy = nullptr) {
    Scene scene = on_joint(JointKind::kPrismatic);
    scene.joints[0].friction = kFriction;
    give_velocity(scene, {kSpeed, 0, 0});
    move_for(scene, time, 1e-7);
    const Snapshot end = run(scene);
    if (energy) *energy = end.energy.dissipated;
    EXPECT_LT(std::abs(end.energy.balance), 1e-4 * 0.5 * kMass * kSpeed * kSpeed);
    return end.joints[0];
  };
  double lost = 0;
  const JointSample soon = at(2 * stop, &lost), late = at(20 * stop);
  // the elastic range of friction is 1e-5 of the length, 0.1 m here
  EXPECT_NEAR(soon.position.x(), distance, 5e-6);
  EXPECT_NEAR(late.position.x(), soon.position.x(), 1e-7);
  EXPECT_LT(std::abs(late.velocity.x()), 1e-9);
  EXPECT_NEAR(lost, 0.5 * kMass * kSpeed * kSpeed, 1e-4 * 0.5 * kMass * kSpeed * kSpeed);
}

TEST(DryFriction, HoldsBelowItsLimitAndYieldsAbove) {
  for (double force : {0.79, 1.0}) {
    Scene scene = on_joint(JointKind::kPrismatic);
    scene.joints[0].friction = 0.8;
    drive(scene, 0, DriveQuantity::kEffort, force);
    move_for(scene, 0.5, 1e-7);
    const JointSample end = run(scene).joints[0];
    if (force < 0.8) {
      EXPECT_LT(std::abs(end.position.x()), 1e-6);
      EXPECT_LT(std::abs(end.velocity.x()), 1e-9);
    } else {
      // it first fills the elastic range
      EXPECT_NEAR(end.position.x(), 0.5 * (force - 0.8) / kMass * 0.25, 1e-3);
    }
  }
}

// Drawn by a spring that lengthens and returns: what friction does quasi-statically, a hysteresis
// of twice F / k.
TEST(DryFriction, LeavesAHysteresisInQuasiStatics) {
  constexpr double kStiffness = 40, kFriction = 0.8;
  Scene scene = on_joint(JointKind::kPrismatic);
  scene.joints[0].friction = kFriction;
  scene.joints[0].spring_stiffness = kStiffness;
  DriveSpec& pull = drive(scene, 0, DriveQuantity::kEffort, 0);
  ProfileTerm& keys = pull.profile.terms[0];
  keys.shape = ShapeOfTime::kKeyframes;
  keys.times = {0, 1, 2};
  keys.values = {0, 4, 0};
  finish_keyframes(keys);
  scene.simulation.mode = Mode::kQuasistatic;
  scene.simulation.duration = 2;
  scene.solver.step = 0.1;
  Simulation simulation(scene);
  simulation.start();
  double forth = -1, back = -1;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    if (std::abs(simulation.time() - 0.5) < 1e-9) forth = simulation.now().joints[0].position.x();
    if (std::abs(simulation.time() - 1.5) < 1e-9) back = simulation.now().joints[0].position.x();
  }
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_NEAR(forth, (2 - kFriction) / kStiffness, 1e-6);
  EXPECT_NEAR(back, (2 + kFriction) / kStiffness, 1e-6);
  const EnergySample& energy = simulation.now().energy;
  EXPECT_GT(energy.dissipated, 0);
  EXPECT_LT(std::abs(energy.balance), 1e-4);
}

/// Speed after a stop of stiffness k, hit at 1 m/s.
double rebound(double dissipation, EnergySample& energy, double& deepest) {
  Scene scene = on_joint(JointKind::kPrismatic);
  JointSpec& joint = scene.joints[0];
  joint.upper = 0.05;
  joint.stop_stiffness = 1000;
  joint.stop_dissipation = dissipation;
  give_velocity(scene, {1, 0, 0});
  move_for(scene, 0.2, 1e-8);
  Simulation simulation(scene);
  simulation.start();
  double pressed = 0;
  deepest = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    deepest = std::max(deepest, simulation.now().joints[0].position.x() - joint.upper);
    pressed = std::min(pressed, simulation.now().joints[0].limit.x());
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_LT(pressed, -5);  // the run says that the stop was active
  EXPECT_EQ(simulation.now().joints[0].limit.x(), 0);
  energy = simulation.now().energy;
  return -simulation.now().joints[0].velocity.x();
}

// d v - ln(1 + d v) = -d u - ln(1 - d u) relates the speeds before and after (Hunt and Crossley
// 1975).
TEST(Limit, GivesBackWhatItsDissipationLeaves) {
  EnergySample energy;
  double deepest = 0;
  EXPECT_NEAR(rebound(0, energy, deepest), 1, 1e-5);
  EXPECT_LT(std::abs(energy.balance), 1e-5);
  EXPECT_LT(std::abs(energy.dissipated), 1e-12);
  // v sqrt(m / k) and half the width of the soft part, 1e-5 m
  EXPECT_NEAR(deepest, std::sqrt(kMass / 1000), 3e-4);
  for (double d : {0.2, 1.0}) {
    const double u = rebound(d, energy, deepest);
    EXPECT_NEAR(d - std::log(1 + d), -d * u - std::log(1 - d * u), 1e-5);
    EXPECT_LT(u, 0.95);
    EXPECT_NEAR(energy.dissipated, 0.5 * kMass * (1 - u * u), 1e-5);
    EXPECT_LT(std::abs(energy.balance), 1e-5);
  }
}

TEST(Limit, HoldsALoadInStatics) {
  Scene scene = on_joint(JointKind::kPrismatic);
  scene.joints[0].lower = -0.02;
  scene.joints[0].stop_stiffness = 1e5;
  LoadSpec push;
  push.at.body = 0;
  push.force = {-6, 0, 0};
  scene.loads.push_back(push);
  const JointSample end = run(scene).joints[0];
  EXPECT_NEAR(end.limit.x(), 6, 1e-8);
  EXPECT_NEAR(end.position.x(), -0.02 - 6 / 1e5 - 0.5e-5, 1e-9);
}

TEST(VelocityDrive, IsIntegratedInQuasiStatics) {
  Scene scene = on_joint(JointKind::kScrew);
  scene.joints[0].screw_pitch = 0.01;
  DriveSpec& turn = drive(scene, 0, DriveQuantity::kVelocity, 0);
  ProfileTerm& ramp = turn.profile.terms[0];
  ramp.shape = ShapeOfTime::kRamp;
  ramp.to = 3;
  ramp.end = 1;
  scene.simulation.mode = Mode::kQuasistatic;
  scene.simulation.duration = 2;
  scene.solver.step = 0.3;
  const Snapshot end = run(scene);
  EXPECT_NEAR(end.joints[0].position.x(), 1.5 + 3, 1e-9);
}

}  // namespace
}  // namespace cprsim
