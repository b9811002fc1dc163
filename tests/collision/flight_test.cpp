// SPDX-License-Identifier: BSD-3-Clause
// Free bodies that touch nothing.
#include "collision/flight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/collision/worlds.h"

namespace cprsim {
namespace {

BodySpec spinning_brick() {
  BodySpec body = cube(Vec3(0, 0, 0));
  body.inertia = Vec3(1e-5, 2e-5, 3e-5).asDiagonal();
  body.angular_velocity = Vec3(0.1, 12, 0.2);  // near the unstable axis: it flips over
  return body;
}

Vec3 angular_momentum(const BodyMotion& motion, const Mat3& inertia) {
  const Mat3& R = motion.X_WB.R;
  return R * inertia * R.transpose() * motion.angular_velocity;
}

TEST(Flight, FreeFallIsExact) {
  for (double dt : {1e-3, 5e-3, 0.1}) {
    BodySpec body = cube(Vec3(1, 2, 3));
    body.linear_velocity = Vec3(0.5, -1, 2);
    World world(scene_of({body}));
    world.run(1, dt);
    const Vec3 expected = Vec3(1, 2, 3) + Vec3(0.5, -1, 2) + 0.5 * Vec3(0, 0, -9.81);
    EXPECT_LT((world[0].X_WB.p - expected).norm(), 1e-12) << dt;  // round-off of 1000 steps
    EXPECT_LT((world[0].linear_velocity - Vec3(0.5, -1, 2 - 9.81)).norm(), 1e-12) << dt;
  }
}

TEST(Flight, EnergyIsKeptInFreeFall) {
  BodySpec body = spinning_brick();
  body.linear_velocity = Vec3(0.5, -1, 2);
  World world(scene_of({body}));
  const double before = world.energy();
  world.run(1, 1e-3);
  EXPECT_NEAR(world.energy(), before, 1e-11);  // fourth-order error of the rotation
}

TEST(Flight, TumblingKeepsAngularMomentumAndEnergy) {
  const BodySpec body = spinning_brick();
  World world(scene_of({body}));
  const Vec3 L = angular_momentum(world[0], body.inertia);
  const double T = world.free->kinetic_energy();
  bool flipped = false;
  for (int i = 0; i < 2000; ++i) {
    world.step(1e-3);
    flipped = flipped || world[0].X_WB.R.col(1).dot(world[0].angular_velocity) < 0;
  }
  EXPECT_TRUE(flipped);
  // round-off of 2000 rotations
  EXPECT_LT((angular_momentum(world[0], body.inertia) - L).norm(), 1e-11 * L.norm());
  const double fallen = 0.1 * 9.81 * 2 * 9.81 * 2 / 2;
  EXPECT_NEAR(world.free->kinetic_energy() - fallen, T, 1e-10 * fallen);
}

TEST(Flight, RotationIsOfFourthOrder) {
  const auto end = [](int steps) {
    RigidMotion motion;
    motion.w = Vec3(1, 12, 3);
    for (int i = 0; i < steps; ++i)
      fly_axes(motion, Vec3(1, 2, 3), 0, 0.5 / steps);
    return motion.X.R;
  };
  const Mat3 exact = end(4000);
  EXPECT_NEAR(std::log2((end(50) - exact).norm() / (end(100) - exact).norm()), 4, 0.2);
}

TEST(Flight, VelocitiesDecayAsSdfSays) {
  BodySpec body = cube(Vec3::Zero());
  body.linear_velocity = Vec3(1, 0, 0);
  body.angular_velocity = Vec3(0, 0, 3);
  body.linear_decay = 0.2;
  body.angular_decay = 0.5;
  Scene scene = scene_of({body});
  scene.effects.set(Effect::kGravity, false);
  World world(scene);
  world.run(1, 1e-3);
  EXPECT_NEAR(world[0].linear_velocity.x(), 0.8, 1e-12);
  EXPECT_NEAR(world[0].X_WB.p.x(), 0.2 / -std::log(0.8), 1e-12);
  EXPECT_NEAR(world[0].angular_velocity.z(), 1.5, 1e-12);
  EXPECT_NEAR(std::atan2(world[0].X_WB.R(1, 0), world[0].X_WB.R(0, 0)), 1.5 / std::log(2), 1e-11);
}

TEST(Flight, OffsetCentreOfMassAndSkewInertiaTumbleAboutTheCentre) {
  // the same body once described at its centre and once from a link frame elsewhere
  const Mat3 R = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  BodySpec at_centre = spinning_brick();
  at_centre.linear_velocity = Vec3(0.3, 0.2, 1);
  BodySpec from_link = at_centre;
  const Pose X_GB{R, Vec3(0.01, -0.02, 0.03)};  // link frame in the axes of the centre of mass
  from_link.X_WB = at_centre.X_WB * X_GB;
  from_link.com = X_GB.inverse().p;
  from_link.inertia = R.transpose() * at_centre.inertia * R;
  from_link.linear_velocity += at_centre.angular_velocity.cross(from_link.X_WB.p);
  World a(scene_of({at_centre})), b(scene_of({from_link}));
  a.run(0.5, 1e-3);
  b.run(0.5, 1e-3);
  const Pose expected = a[0].X_WB * X_GB;
  EXPECT_LT((b[0].X_WB.p - expected.p).norm(), 1e-11);
  EXPECT_LT((b[0].X_WB.R - expected.R).norm(), 1e-10);
  EXPECT_NEAR(b.free->kinetic_energy(), a.free->kinetic_energy(), 1e-13);
}

TEST(Flight, WithoutTheGravityEffectNothingFalls) {
  Scene scene = scene_of({cube(Vec3(0, 0, 1))});
  scene.effects.set(Effect::kGravity, false);
  World world(scene);
  world.run(1, 1e-3);
  EXPECT_EQ(world[0].X_WB.p, Vec3(0, 0, 1));
  scene = scene_of({cube(Vec3(0, 0, 1))});
  scene.bodies[0].gravity = false;
  World alone(scene);
  alone.run(1, 1e-3);
  EXPECT_EQ(alone[0].X_WB.p, Vec3(0, 0, 1));
}

TEST(Flight, LoadsAccelerate) {
  LoadSpec load;
  load.at.body = 0;
  load.force = Vec3(0.2, 0, 0);
  Scene scene = scene_of({cube(Vec3::Zero())});
  scene.effects.set(Effect::kGravity, false);
  scene.loads = {load};
  World world(scene);
  world.run(1, 1e-3);
  EXPECT_NEAR(world[0].X_WB.p.x(), 1, 1e-12);  // a = 2 m/s²

  scene.loads[0].force.setZero();
  scene.loads[0].torque = Vec3(0, 0, 1e-5);
  World turning(scene);
  turning.run(1, 1e-3);
  EXPECT_NEAR(turning[0].angular_velocity.z(), 1e-5 / scene.bodies[0].inertia(2, 2), 1e-10);
}

TEST(FreeBodySearch, LeavesOutWhatIsHeld) {
  Scene scene = scene_of(
      {ground(), cube(Vec3::Zero()), cube(Vec3::Zero()), cube(Vec3::Zero()), cube(Vec3::Zero())});
  JointSpec joint;
  joint.child = 1;
  scene.joints = {joint};
  RodSpec rod;
  rod.base = {EndJoint::kFixed, {2, {}}, Vec3::UnitX(), false, {}};
  scene.rods = {rod};
  EXPECT_EQ(find_free_bodies(scene), (std::vector<int>{3, 4}));
}

}  // namespace
}  // namespace cprsim
