// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <stdexcept>

#include "collision/bullet_world.h"
#include "engine/math/so3.h"
#include "engine/robot/robot.h"
#include "tests/engine/robot/sample_scenes.h"

namespace cprsim {
namespace {

constexpr double kRoundOff = 1e-15;

void weld(Scene& scene, int parent, int child) {
  JointSpec joint;
  joint.kind = JointKind::kFixed;
  joint.parent = parent;
  joint.child = child;
  scene.joints.push_back(joint);
}

/// Bodies 0 and 1 welded, a rod from the ground to body 1.
Scene welded_pair() {
  Scene scene;
  scene.bodies.push_back(sample_body("a", {exp_so3({0.2, 0.1, -0.3}), {0.1, 0.0, 0.8}}, 0.2));
  scene.bodies.push_back(sample_body("b", {exp_so3({-0.6, 0.3, 0.2}), {0.3, 0.1, 0.9}}, 0.3));
  weld(scene, 0, 1);
  scene.rods.push_back(sample_rod("rod"));
  scene.rods[0].base = rod_end(EndJoint::kFixed, kWorld, Pose{});
  scene.rods[0].tip = rod_end(EndJoint::kFixed, 1, {exp_so3({0.1, 0.2, 0}), {0, 0, -0.1}});
  return scene;
}

/// Momentum of inertia about the world's origin, from the links one by one.
Mat3 inertia_about_origin(const Mat3& R, const Mat3& inertia, double mass, const Vec3& com) {
  return R * inertia * R.transpose() - mass * hat(com) * hat(com);
}

TEST(Robot, WeldedLinksAreOneBodyWithTheirMassAndInertia) {
  const Scene scene = welded_pair();
  const Robot robot = build_robot(scene);
  ASSERT_EQ(robot.bodies.size(), 1u);
  const RigidBody& body = robot.bodies[0];
  EXPECT_EQ(body.links, (std::vector<int>{0, 1}));
  EXPECT_NEAR(body.mass, 0.5, kRoundOff);
  Vec3 moment = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  for (const BodySpec& link : scene.bodies) {
    const Vec3 com = link.X_WB * link.com;
    moment += link.mass * com;
    inertia += inertia_about_origin(link.X_WB.R, link.inertia, link.mass, com);
  }
  EXPECT_LT((body.p - moment / 0.5).norm(), kRoundOff);
  EXPECT_LT((inertia_about_origin(body.R, body.inertia, body.mass, body.p) - inertia).norm(),
            kRoundOff);
  EXPECT_LT(body.gravity_arm.norm(), kRoundOff);
  EXPECT_EQ(robot.joint_of_spec, std::vector<int>{-1});
}

TEST(Robot, OnlyLinksThatFeelGravityWeigh) {
  Scene scene = welded_pair();
  scene.bodies[0].gravity = false;
  const Robot robot = build_robot(scene);
  const RigidBody& body = robot.bodies[0];
  EXPECT_EQ(body.gravity_mass, 0.3);
  EXPECT_LT(
      (body.p + body.R * body.gravity_arm - scene.bodies[1].X_WB * scene.bodies[1].com).norm(),
      kRoundOff);
}

TEST(Robot, LinksStayWhereTheSceneHasThem) {
  const Scene scene = welded_pair();
  const Robot robot = build_robot(scene);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT((robot.link_pose(i).p - scene.bodies[i].X_WB.p).norm(), kRoundOff);
    EXPECT_LT((robot.link_pose(i).R - scene.bodies[i].X_WB.R).norm(), 2 * kRoundOff);
  }
  const Pose tip = scene.bodies[1].X_WB * scene.rods[0].tip.at.X_BF;
  EXPECT_LT((robot.port(robot.rods[0].tip).p - tip.p).norm(), kRoundOff);
  EXPECT_LT((robot.port(robot.rods[0].tip).arm - (tip.p - robot.bodies[0].p)).norm(), kRoundOff);
  EXPECT_TRUE(robot.port(robot.rods[0].tip).moves);
  EXPECT_FALSE(robot.port(robot.rods[0].base).moves);
}

TEST(Robot, WhatIsWeldedToTheGroundIsGround) {
  for (bool by_static : {false, true}) {
    Scene scene = welded_pair();
    if (by_static)
      scene.bodies[0].is_static = true;
    else
      weld(scene, kWorld, 0);
    const Robot robot = build_robot(scene);
    EXPECT_TRUE(robot.bodies.empty());
    EXPECT_EQ(robot.links[0].body, LinkPlace::kGround);
    EXPECT_EQ(robot.links[1].body, LinkPlace::kGround);
    const Pose tip = scene.bodies[1].X_WB * scene.rods[0].tip.at.X_BF;
    EXPECT_EQ(robot.port(robot.rods[0].tip).p, tip.p);
    EXPECT_FALSE(robot.port(robot.rods[0].tip).moves);
    EXPECT_TRUE(find_free_bodies(scene).empty());
  }
}

// Two rules that must agree: what the Newton system leaves out is what Bullet takes.
TEST(Robot, LeavesTheLinksFreeThatBulletIntegrates) {
  Scene scene = welded_pair();
  for (const char* name : {"c", "d", "e", "f", "g"})
    scene.bodies.push_back(sample_body(name, Pose{}, 0.1));
  weld(scene, 2, 3);  // two links welded to each other only are one body
  JointSpec hinge;
  hinge.kind = JointKind::kRevolute;
  hinge.parent = 4;
  hinge.child = kWorld;
  scene.joints.push_back(hinge);
  scene.bodies[5].is_static = true;
  const Robot robot = build_robot(scene);
  EXPECT_EQ(robot.bodies.size(), 3u);
  EXPECT_GE(robot.links[2].body, 0);
  EXPECT_EQ(robot.links[2].body, robot.links[3].body);
  EXPECT_GE(robot.links[4].body, 0);
  EXPECT_EQ(robot.links[5].body, LinkPlace::kGround);
  EXPECT_EQ(robot.links[6].body, LinkPlace::kFree);
  std::vector<int> free;
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    if (robot.links[i].body == LinkPlace::kFree) free.push_back(static_cast<int>(i));
  EXPECT_EQ(free, find_free_bodies(scene));
}

TEST(Robot, RefusesToDriveAnAxisThatAJointHasNot) {
  for (JointKind kind : {JointKind::kBall, JointKind::kUniversal, JointKind::kScrew}) {
    Scene scene = welded_pair();
    scene.joints[0].kind = kind;
    EXPECT_NO_THROW(build_robot(scene));
    DriveSpec drive;
    drive.joint = 0;
    drive.freedom = freedom_count(kind);
    scene.drives.push_back(drive);
    EXPECT_THROW(build_robot(scene), std::invalid_argument);
  }
}

TEST(Robot, GravityActsOnlyWhereTheEffectIsOn) {
  Scene scene = welded_pair();
  EXPECT_EQ(build_robot(scene).gravity, Vec3(0, 0, 0));
  scene.effects.set(Effect::kGravity, true);
  EXPECT_EQ(build_robot(scene).gravity, scene.gravity);
  EXPECT_TRUE(build_robot(scene).rods[0].gravity);
  scene.rods[0].without = {"gravity"};
  EXPECT_FALSE(build_robot(scene).rods[0].gravity);
}

}  // namespace
}  // namespace cprsim
