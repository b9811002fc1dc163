// SPDX-License-Identifier: BSD-3-Clause
// Bodies that meet bodies as unknowns of the rods' system: a rod far off could touch them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/jointed_bodies.h"

namespace cprsim {
namespace {

ColliderSpec collider(ShapeKind kind, const Vec3& size) {
  ColliderSpec out;
  out.name = "c";
  out.shape.kind = kind;
  out.shape.size = size;
  return out;
}

/// Without gravity, with a rod that stands far away.
Scene empty_scene() {
  Scene scene;
  switch_on(scene, {Effect::kContact});
  RodSpec rod = steel_rod(0.1, 2e-3);
  rod.base.at.X_BF.p = {10, 0, 1};
  scene.rods.push_back(rod);
  scene.solver.points = 4;
  scene.max_step_size = 1e-3;
  scene.solver.step = 1e-3;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.duration = 0.2;
  return scene;
}

BodySpec& add_ball(Scene& scene, const std::string& name, double x, double mass, double speed) {
  BodySpec ball = lump(name, {Mat3::Identity(), {x, 0, 0}}, mass, Vec3::Constant(1e-4 * mass));
  ball.linear_velocity = {speed, 0, 0};
  ball.velocity_given = true;
  ball.colliders.push_back(collider(ShapeKind::kSphere, {0.02, 0, 0}));
  scene.bodies.push_back(ball);
  return scene.bodies.back();
}

// Newton's law of restitution: v_1 - v_2 = -e (u_1 - u_2), with momentum kept.
TEST(MeetingBodies, PartAtTheirRestitutionAndKeepMomentum) {
  for (const double e : {0.0, 0.5, 1.0}) {
    Scene scene = empty_scene();
    add_ball(scene, "one", 0, 0.2, 1).colliders[0].surface.restitution = e;
    add_ball(scene, "two", 0.1, 0.1, -0.5).colliders[0].surface.restitution = 1;
    Simulation simulation(scene);
    simulation.start();
    const auto speed = [&](std::size_t b) { return simulation.robot().bodies[b].velocity().x(); };
    while (simulation.status() == RunStatus::kRunning) {
      simulation.advance();
      EXPECT_NEAR(0.2 * speed(0) + 0.1 * speed(1), 0.15, 1e-10) << simulation.time();
    }
    ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    EXPECT_NEAR(speed(1) - speed(0), 1.5 * e, 1e-3) << e;
    EXPECT_NEAR(speed(0), 0.5 - 0.5 * e, 1e-3) << e;
  }
}

// Four corners meet the floor at once: one more than determine the motion.
TEST(MeetingBodies, ABoxBouncesFlat) {
  Scene scene = empty_scene();
  switch_on(scene, {Effect::kGravity, Effect::kFriction});
  scene.gravity = {0, 0, -10};
  BodySpec floor;
  floor.name = "floor";
  floor.is_static = true;
  floor.colliders.push_back(collider(ShapeKind::kPlane, {1, 1, 0}));
  floor.colliders[0].surface.restitution = 1;
  scene.bodies.push_back(floor);
  BodySpec box = lump("box", {Mat3::Identity(), {0, 0, 0.1 + 0.02}}, 0.1, Vec3::Constant(4e-5));
  box.colliders.push_back(collider(ShapeKind::kBox, {0.06, 0.05, 0.04}));
  box.colliders[0].surface.restitution = 0.8;
  scene.bodies.push_back(box);
  scene.simulation.duration = 0.5;
  Simulation simulation(scene);
  simulation.start();
  double highest = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    const Snapshot& now = simulation.now();
    if (now.time > 0.2) highest = std::max(highest, now.bodies[1].X_WB.p.z());
    EXPECT_LT((now.bodies[1].X_WB.R - Mat3::Identity()).norm(), 1e-6) << now.time;
    EXPECT_LT(now.contact.penetration, 2e-2 * 0.04) << now.time;
  }
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  // of the height that it fell from, e²; the step of the impact is off by g h in speed
  EXPECT_NEAR(highest - 0.02, 0.64 * 0.1, 0.03 * 0.1);
}

// A slide on a spring, pushed against a block: what the spring does not bear the block does.
TEST(MeetingBodies, HeldBodiesMeetWhatStandsStillInStatics) {
  Scene scene = empty_scene();
  scene.simulation.mode = Mode::kStatic;
  scene.bodies.push_back(lump("slide", Pose{}, 0.1, Vec3::Constant(1e-4)));
  scene.bodies[0].name = "robot::slide";
  scene.bodies[0].colliders.push_back(collider(ShapeKind::kBox, {0.04, 0.04, 0.04}));
  JointSpec rail = joint_at(scene, JointKind::kPrismatic, Vec3::Zero(), kWorld, 0, Vec3::UnitX());
  rail.spring_stiffness = 100;
  scene.joints.push_back(rail);
  BodySpec block;
  block.name = "bench::block";
  block.is_static = true;
  block.X_WB.p = {0.06, 0, 0};
  block.colliders.push_back(collider(ShapeKind::kBox, {0.06, 0.1, 0.1}));
  scene.bodies.push_back(block);
  LoadSpec push;
  push.at.body = 0;
  push.force = {5, 0, 0};
  scene.loads.push_back(push);
  Simulation simulation(scene);
  simulation.start();
  while (simulation.status() == RunStatus::kRunning)
    simulation.advance();
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  const Snapshot& now = simulation.now();
  EXPECT_NEAR(now.bodies[0].X_WB.p.x(), 0.01, 1e-6);
  double force = 0;
  for (const LinkContact& at : now.contact.links)
    force += (at.link == 0 ? 1 : -1) * at.force.x();
  EXPECT_NEAR(force, -4, 1e-4);
}

// Boxes that cross edge on edge touch there, and nowhere else.
TEST(MeetingBodies, EdgesHoldEdges) {
  Scene scene = empty_scene();
  switch_on(scene, {Effect::kGravity, Effect::kFriction});
  scene.gravity = {0, 0, -10};
  const double edge = 0.02 * std::sqrt(2.0);
  BodySpec lower;
  lower.name = "lower";
  lower.is_static = true;
  lower.X_WB.R = Eigen::AngleAxisd(0.25 * std::numbers::pi, Vec3::UnitX()).toRotationMatrix();
  lower.colliders.push_back(collider(ShapeKind::kBox, {0.2, 0.04, 0.04}));
  scene.bodies.push_back(lower);
  BodySpec upper = lump("upper", Pose{}, 0.1, {1e-5, 2e-4, 2e-4});
  upper.X_WB.p = {0, 0, 2 * edge + 1e-3};
  upper.X_WB.R = Eigen::AngleAxisd(0.25 * std::numbers::pi, Vec3::UnitY()).toRotationMatrix();
  upper.colliders.push_back(collider(ShapeKind::kBox, {0.04, 0.2, 0.04}));
  scene.bodies.push_back(upper);
  scene.simulation.duration = 0.03;
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  ASSERT_FALSE(end.contact.links.empty());
  for (const LinkContact& at : end.contact.links)
    EXPECT_LT(at.position.head<2>().norm(), 1e-3);
  // edges are round by 1e-3 of the thickness
  EXPECT_NEAR(end.bodies[1].X_WB.p.z(), 2 * edge, 1e-4);
}

}  // namespace
}  // namespace cprsim
