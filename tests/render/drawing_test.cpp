// SPDX-License-Identifier: BSD-3-Clause
#include "render/drawing.h"

#include <gtest/gtest.h>

#include "render/scenery.h"
#include "tests/support/six_rods.h"

namespace cprsim {
namespace {

Drawing drawing_of(const Scene& scene, const Snapshot& now, const FrameDecor& decor = {}) {
  return make_drawing(scene, make_parts(scene), now, decor, Vec2(0, 0.5));
}

TEST(Drawing, WhatIsFixedToTheWorldIsStill) {
  Scene scene = six_rods_scene();
  EXPECT_EQ(still_bodies(scene), (std::vector<bool>{true, false}));
  JointSpec weld;
  weld.parent = 1;
  weld.child = 0;
  scene.joints.push_back(weld);
  EXPECT_EQ(still_bodies(scene), (std::vector<bool>{true, true}))
      << "through a chain of fixed joints";
  scene.joints.back().kind = JointKind::kRevolute;
  EXPECT_EQ(still_bodies(scene), (std::vector<bool>{true, false}));
}

TEST(Drawing, PartsFollowTheirBodies) {
  const Scene scene = six_rods_scene();
  const Snapshot now = six_rods_at(0.7);
  const Drawing drawing = drawing_of(scene, now);
  ASSERT_EQ(drawing.part_poses.size(), 2U);
  EXPECT_EQ(drawing.part_poses[1].p, now.bodies[1].X_WB.p);
  EXPECT_EQ(drawing.tubes.size(), 6U);
}

TEST(Drawing, RodsAreSmoothHoweverCoarseTheirPoints) {
  const Scene scene = six_rods_scene();
  Snapshot now;
  now.bodies.resize(2);
  RodSample arc;
  arc.radius = 0.001;
  // three points of a quarter circle
  for (double a : {0.0, 0.7853981633974483, 1.5707963267948966}) {
    RodPoint point;
    point.s = a / 1.5707963267948966;
    point.position = {1 - std::cos(a), 0, std::sin(a)};
    point.rotation = Eigen::AngleAxisd(a, Vec3::UnitY()).matrix();
    arc.points.push_back(point);
  }
  now.rods.push_back(arc);
  const Drawing drawing = drawing_of(scene, now);
  const auto& rings = drawing.tubes.at(0).rings;
  EXPECT_GT(rings.size(), 15U);
  for (const Tube::Ring& ring : rings) {
    // the cubic with chords as end directions leaves the circle by 0.3 % of its radius at 45°
    EXPECT_NEAR((ring.position - Vec3(1, 0, 0)).norm(), 1, 0.01);
  }
}

TEST(Drawing, BendingMomentIsThatAboutTheSectionsAxes) {
  RodPoint point;
  point.rotation = Eigen::AngleAxisd(0.9, Vec3(1, 2, 3).normalized()).matrix();
  point.moment = point.rotation * Vec3(3, 4, 12);
  EXPECT_NEAR(colored_value(ColorBy::kBendingMoment, point), 5, 1e-12)
      << "without the torsion of 12";
  point.force = point.rotation * Vec3(1, 1, -7);
  EXPECT_NEAR(colored_value(ColorBy::kTension, point), -7, 1e-12);
}

TEST(Drawing, ColoursFollowTheRange) {
  const Scene scene = six_rods_scene();
  Snapshot now = six_rods_at(0);
  for (RodPoint& point : now.rods[0].points)
    point.moment = {0.5, 0, 0};
  FrameDecor decor;
  decor.color_by = ColorBy::kBendingMoment;
  for (RodPoint& point : now.rods[0].points)
    point.rotation.setIdentity();
  EXPECT_EQ(drawing_of(scene, now, decor).tubes[0].rings[0].color, viridis(1));
}

TEST(Drawing, NumbersThatAreNoneAreLeftOut) {
  const Scene scene = six_rods_scene();
  Snapshot now = six_rods_at(0);
  now.rods[0].points[10].position.x() = std::nan("");
  now.rods[1].points[3].moment.x() = std::nan("");
  const std::vector<Part> parts = make_parts(scene);
  const Drawing drawing = drawing_of(scene, now);
  EXPECT_TRUE(std::isfinite(bounds_of(parts, drawing).radius));
  EXPECT_TRUE(std::isfinite(largest_value(ColorBy::kBendingMoment, now)));
}

TEST(Drawing, ForcesOfContactsAreArrowsIfAskedFor) {
  const Scene scene = six_rods_scene();
  Snapshot now = six_rods_at(0.7);
  ContactPoint rod;
  rod.position = {0.1, 0.2, 0.3};
  rod.force = {0, 3, 4};
  LinkContact link;
  link.force = {2, 0, 0};
  now.contact.points = {rod, ContactPoint{}};  // the second carries nothing
  now.contact.links = {link};
  EXPECT_EQ(drawing_of(scene, now).tubes.size(), 6U);
  FrameDecor decor;
  decor.contact_forces = 0.1;
  const Drawing drawing = drawing_of(scene, now, decor);
  ASSERT_EQ(drawing.tubes.size(), 10U) << "a shaft and a head each";
  const Tube &shaft = drawing.tubes[6], &head = drawing.tubes[7];
  EXPECT_LT((shaft.rings.front().position - rod.position).norm(), 1e-15);
  EXPECT_LT((head.rings.back().position - rod.position - 0.1 * rod.force).norm(), 1e-15);
  EXPECT_LT((head.rings.back().rotation.col(2) - Vec3(0, 0.6, 0.8)).norm(), 1e-12);
  EXPECT_GT(head.radius, shaft.radius);
  EXPECT_LT(head.rings.back().width, 0.1);
}

TEST(Drawing, GroundLiesUnderTheFrameAndUnderWhatMayHangDown) {
  Scene scene = six_rods_scene();
  const Snapshot now = six_rods_at(0);
  const std::vector<Part> parts = make_parts(scene);
  EXPECT_NEAR(ground_height(scene, parts, drawing_of(scene, now)), -0.003, 1e-6)
      << "half the base plate";
  scene.rods[0].tip.joint = EndJoint::kFree;
  EXPECT_NEAR(ground_height(scene, parts, drawing_of(scene, now)), -1.02 * 0.4, 1e-6);
  VisualSpec floor;
  floor.shape.kind = ShapeKind::kPlane;
  floor.shape.size = {50, 50, 0};
  floor.X_BV.p.z() = -0.2;
  scene.bodies[0].visuals.push_back(floor);
  const std::vector<Part> with_floor = make_parts(scene);
  EXPECT_EQ(ground_height(scene, with_floor, make_drawing(scene, with_floor, now, {}, Vec2(0, 1))),
            -0.2);
  EXPECT_TRUE(with_floor[1].is_ground);
}

TEST(Drawing, TracesFadeWithAge) {
  const Scene scene = six_rods_scene();
  Snapshot now = six_rods_at(2);
  FrameDecor decor;
  decor.traces.push_back({{{Vec3(0, 0, 0), 0.2}, {Vec3(1, 0, 0), 1.5}, {Vec3(2, 0, 0), 2}}, 1});
  const Drawing drawing = drawing_of(scene, now, decor);
  ASSERT_EQ(drawing.ribbons.size(), 1U);
  ASSERT_EQ(drawing.ribbons[0].points.size(), 2U) << "the oldest is gone";
  EXPECT_LT(drawing.ribbons[0].points[0].opacity, drawing.ribbons[0].points[1].opacity);
}

TEST(Lighting, AnySceneHasALightAndNoneIsTooBright) {
  Scene scene;
  for (int lights : {0, 1, 5}) {
    scene.lights.assign(static_cast<std::size_t>(lights), LightSpec{});
    const Lighting light = make_lighting(scene, {}, {Vec3::Zero(), 1});
    Vec3 sum = light.ambient_up + light.key_color;
    for (const Lighting::Other& other : light.others)
      sum += other.color;
    EXPECT_GT(sum.minCoeff(), 0.8) << lights;
    EXPECT_LT(sum.maxCoeff(), 1.2) << lights;
    EXPECT_GT(light.to_key.z(), 0);
  }
}

}  // namespace
}  // namespace cprsim
