// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/channel.h"

#include <gtest/gtest.h>

#include "engine/model/scene.h"

namespace cprsim {
namespace {

Scene robot() {
  Scene scene;
  scene.bodies.resize(2);
  scene.bodies[0].name = "robot::base";
  scene.bodies[1].name = "robot::platform";
  scene.rods.resize(2);
  scene.rods[0].name = "robot::leg_1";
  scene.rods[1].name = "robot::leg_2";
  scene.joints.resize(2);
  scene.joints[0].name = "robot::slide";
  scene.joints[0].kind = JointKind::kPrismatic;
  scene.joints[1].name = "robot::weld";
  scene.frames.push_back({"robot::tool", {}});
  return scene;
}

std::vector<std::string> names(const std::string& pattern) {
  std::vector<std::string> all;
  for (const Channel& channel : find_channels(robot(), pattern))
    all.push_back(channel.name);
  return all;
}

TEST(Channels, ExpandAPoseToPositionAndQuaternion) {
  const std::vector<std::string> expected{
      "robot::platform.position.x",    "robot::platform.position.y",
      "robot::platform.position.z",    "robot::platform.orientation.x",
      "robot::platform.orientation.y", "robot::platform.orientation.z",
      "robot::platform.orientation.w"};
  EXPECT_EQ(names("robot::platform.pose"), expected);
}

TEST(Channels, SelectComponentsAndGlobs) {
  EXPECT_EQ(names("robot::leg_*.length"),
            (std::vector<std::string>{"robot::leg_1.length", "robot::leg_2.length"}));
  EXPECT_EQ(names("robot::leg_1.base.wrench.force.x"),
            std::vector<std::string>{"robot::leg_1.base.wrench.force.x"});
  EXPECT_EQ(names("robot::leg_1.base.wrench").size(), 6u);
  EXPECT_EQ(names("energy.*").size(), 7u);
  EXPECT_EQ(names("robot::slide.*").size(), 3u);
  EXPECT_EQ(names("robot::*.position.x").size(),
            3u);  // bodies and frames; a joint's position has no components
}

/// The platform may be touched, both legs too.
Scene touching_robot() {
  Scene scene = robot();
  scene.effects.set(Effect::kContact, true);
  scene.bodies[1].is_static = true;
  scene.bodies[1].colliders.resize(1);
  scene.bodies[1].colliders[0].shape.kind = ShapeKind::kSphere;
  return scene;
}

TEST(Channels, OfAPairOfThingsThatTouch) {
  const Scene scene = touching_robot();
  const auto force = find_channels(scene, "contact(robot::leg_1, robot::platform).force");
  ASSERT_EQ(force.size(), 3u);
  EXPECT_EQ(force[0].name, "contact(robot::leg_1,robot::platform).force.x");
  EXPECT_EQ(force[2].component, 2);
  EXPECT_TRUE(force[0].pair[0] == (ContactParty{true, 0}));
  EXPECT_TRUE(force[0].pair[1] == (ContactParty{false, 1}));
  const auto all = find_channels(scene, "contact(robot::leg_1,robot::platform).*");
  EXPECT_EQ(all.size(), 12u);
  EXPECT_EQ(find_channels(scene, "contact(robot::platform,robot::leg_1).force.*").size(), 5u);
  EXPECT_EQ(find_channels(scene, "contact(robot::leg_1,robot::leg_2).gap")[0].unit, "m");
  // distances of links from each other are not known
  EXPECT_TRUE(find_channels(scene, "contact(robot::base,robot::platform).gap").empty());
}

TEST(Channels, GlobsOfPairsAreThoseThatMayTouchEachOnce) {
  std::vector<std::string> found;
  for (const Channel& channel : find_channels(touching_robot(), "contact(robot::*,*).count"))
    found.push_back(channel.name);
  EXPECT_EQ(found, (std::vector<std::string>{"contact(robot::platform,robot::leg_1).count",
                                             "contact(robot::platform,robot::leg_2).count",
                                             "contact(robot::leg_1,robot::leg_2).count"}));
}

TEST(Channels, OfAPairNearestToATypingError) {
  const Scene scene = touching_robot();
  EXPECT_EQ(nearest_channels(scene, "contact(robot::lag_1,robot::platform).force.normal", 1)[0],
            "contact(robot::leg_1,robot::platform).force.normal");
  EXPECT_EQ(nearest_channels(scene, "contact(robot::leg_1,robot::leg_2).force.nrmal", 1)[0],
            "contact(robot::leg_1,robot::leg_2).force.normal");
  EXPECT_TRUE(find_channels(scene, "contact(robot::leg_1).count").empty());
  EXPECT_EQ(nearest_channels(scene, "contact(robot::leg_1).count").size(), 3u);
}

TEST(Pairs, SayWhyTheyNeverTouch) {
  Scene scene = touching_robot();
  const ContactPair legs{ContactParty{true, 0}, ContactParty{true, 1}},
      itself{ContactParty{true, 0}, ContactParty{true, 0}},
      platform{ContactParty{true, 0}, ContactParty{false, 1}},
      base{ContactParty{false, 0}, ContactParty{true, 0}};
  EXPECT_EQ(why_never_touching(scene, legs), "");
  EXPECT_EQ(why_never_touching(scene, platform), "");
  EXPECT_EQ(why_never_touching(scene, base), "'robot::base' has no <collision>");
  EXPECT_EQ(why_never_touching(scene, itself), "self_contact is not among the effects");
  scene.rods[1].surface.category_bitmask = scene.rods[1].surface.collide_bitmask = 2;
  scene.rods[0].surface.category_bitmask = scene.rods[0].surface.collide_bitmask = 4;
  EXPECT_EQ(why_never_touching(scene, legs), "their bitmasks keep them apart");
  scene.rods[0].without.emplace_back("contact");
  EXPECT_EQ(why_never_touching(scene, platform), "'robot::leg_1' is <without>contact</without>");
}

TEST(Channels, NumberTheAxesOfAJoint) {
  Scene scene;
  scene.joints.resize(2);
  scene.joints[0].name = "sleeve";
  scene.joints[0].kind = JointKind::kCylindrical;
  scene.joints[0].second.upper = 1;
  scene.joints[1].name = "ball";
  scene.joints[1].kind = JointKind::kBall;
  const auto sleeve = find_channels(scene, "sleeve.*");
  ASSERT_EQ(sleeve.size(), 8u);  // limits are there to be reported
  EXPECT_EQ(sleeve[0].name + " " + sleeve[0].unit, "sleeve.position.1 m");
  EXPECT_EQ(sleeve[1].name + " " + sleeve[1].unit, "sleeve.position.2 rad");
  EXPECT_EQ(sleeve[7].name + " " + sleeve[7].unit, "sleeve.limit.2 N m");
  EXPECT_EQ(sleeve[7].component, 1);
  const auto ball = find_channels(scene, "ball.velocity");
  ASSERT_EQ(ball.size(), 3u);
  EXPECT_EQ(ball[2].name + " " + ball[2].unit, "ball.velocity.z rad/s");
}

TEST(Channels, NamePointsOfARod) {
  const auto at = find_channels(robot(), "robot::leg_2(s=0.25).position");
  ASSERT_EQ(at.size(), 3u);
  EXPECT_EQ(at[1].name, "robot::leg_2(s=0.25).position.y");
  EXPECT_EQ(at[1].entity, ChannelEntity::kRodPoint);
  EXPECT_EQ(at[1].index, 1);
  EXPECT_EQ(at[1].s, 0.25);
  EXPECT_EQ(at[1].component, 1);
  const auto tip = find_channels(robot(), "robot::leg_1.tip.position");
  ASSERT_EQ(tip.size(), 3u);
  EXPECT_EQ(tip[0].s, 1);
  EXPECT_EQ(names("robot::leg_1.shape").size(), 33u);
  EXPECT_EQ(find_channels(robot(), "robot::leg_1.shape")[3].s, 0.1);
}

TEST(Channels, HaveUnits) {
  EXPECT_EQ(find_channels(robot(), "robot::slide.position")[0].unit, "m");
  EXPECT_EQ(find_channels(robot(), "robot::slide.effort")[0].unit, "N");
  EXPECT_EQ(find_channels(robot(), "robot::leg_1.tip.wrench.moment.y")[0].unit, "N m");
  EXPECT_EQ(find_channels(robot(), "solver.wall_time")[0].unit, "s");
}

TEST(Channels, ThatDoNotExistAreNotFound) {
  for (const char* pattern :
       {"", ".", "robot::platform", "robot::platform.", "robot::platform.mass",
        "robot::weld.position", "robot::leg_1(s=2).position", "robot::leg_1(s=x).position",
        "robot::leg_1(s=0.5)", "robot::platform(s=0.5).position", "energy.heat"})
    EXPECT_TRUE(names(pattern).empty()) << pattern;
}

TEST(Channels, MisspeltAreAnsweredWithTheNearest) {
  EXPECT_EQ(nearest_channels(robot(), "robot::platfrom.position", 1)[0],
            "robot::platform.position");
  EXPECT_EQ(nearest_channels(robot(), "robot::leg_1.lenght", 1)[0], "robot::leg_1.length");
  EXPECT_EQ(nearest_channels(robot(), "energy.totl", 1)[0], "energy.total");
  EXPECT_EQ(nearest_channels(robot(), "x", 3).size(), 3u);
}

}  // namespace
}  // namespace cprsim
