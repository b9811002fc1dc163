// SPDX-License-Identifier: BSD-3-Clause
// A clamped rod that slides without friction over cylinders, an ellipsoid and the ridges of a mesh,
// against the plane elastica of tests/laws/plane_elastica.h.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "engine/run/simulation.h"
#include "scenes/loader/load.h"
#include "tests/laws/plane_elastica.h"
#include "tests/support/box_mesh.h"
#include "tests/support/end_of.h"

namespace cprsim {
namespace {

constexpr double kPi = 3.14159265358979323846;

LoadResult contact_scene(const std::string& name) {
  return load_scene(std::string(CPRSIM_SOURCE_DIR) + "/scenes/contact/" + name + ".xml");
}

double total_force(const HeldState& u) {
  double sum = 0;
  for (Eigen::Index i = 1; i < u.size(); i += 3)
    sum += u[i];
  return sum;
}

/// From a small deflection on, in steps of 1 mm.
void raise_base(HeldRod& rod, HeldState& u, double from, double to) {
  const int steps = static_cast<int>(std::lround(std::abs(to - from) / 1e-3));
  for (int i = 0; i <= steps; ++i) {
    rod.z = from + (to - from) * i / steps;
    ASSERT_LT(solve_held(rod, u), 1e-12);
  }
}

struct Expected {
  double force = 0, moment = 0, x = 0, z = 0;
};

Expected expected_of(const HeldRod& rod, const HeldState& u) {
  const Eigen::Vector4d tip = tip_of(rod, u);
  return {total_force(u), -u[0], tip[0], tip[1]};
}

void compare(const Snapshot& found, const Expected& expected, double tolerance) {
  EXPECT_NEAR(found.contact.force / expected.force, 1, tolerance);
  double along = 0;
  for (const ContactPoint& point : found.contact.points) {
    along += point.force.dot(point.normal);
    EXPECT_NEAR(point.gap, 0, 1e-8);
  }
  EXPECT_NEAR(along, found.contact.force, 1e-12 * found.contact.force);
  EXPECT_NEAR(found.rods[0].points.front().moment.y() / expected.moment, 1, tolerance);
  const Vec3& tip = found.rods[0].points.back().position;
  EXPECT_NEAR(tip.x(), expected.x, tolerance);
  EXPECT_NEAR(tip.y(), 0, 1e-8);
  EXPECT_NEAR(tip.z(), expected.z, tolerance);
}

/// A rod pressed under a round thing whose lowest point is 5 mm above the level rod's surface.
Expected under(const Peg& peg) {
  HeldRod rod;
  rod.radius = 0.005;
  rod.pegs = {peg};
  HeldState u(4);
  const double first = 3 * 0.001 / std::pow(peg.x, 3);
  u << -first * peg.x, first, -kPi / 2, peg.x;
  raise_base(rod, u, 0.006, 0.255);
  return expected_of(rod, u);
}

TEST(ElasticaOnPegs, UnderACylinder) {
  const LoadResult loaded = contact_scene("over_a_cylinder");
  ASSERT_TRUE(loaded.scene);
  compare(end_of(*loaded.scene), under({0.6, 0.06, 0.05, 0.05}), 3e-5);
}

TEST(ElasticaOnPegs, UnderAnEllipsoid) {
  const LoadResult loaded = contact_scene("over_an_ellipsoid");
  ASSERT_TRUE(loaded.scene);
  compare(end_of(*loaded.scene), under({0.6, 0.05, 0.12, 0.04}), 3e-5);
}

TEST(ElasticaOnPegs, OverOneAndUnderTheNext) {
  HeldRod rod;
  rod.radius = 0.005;
  rod.pegs = {{0.35, -0.026, 0.02, 0.02}, {0.7, 0.026, 0.02, 0.02}};
  HeldState u(7);
  u << 0.3, 3, kPi / 2, 0.35, 1, -kPi / 2, 0.7;
  raise_base(rod, u, -0.01, -0.15);
  const LoadResult loaded = contact_scene("over_two_pegs");
  ASSERT_TRUE(loaded.scene);
  compare(end_of(*loaded.scene), expected_of(rod, u), 5e-5);
}

// The lowest capsule of the ring.
TEST(ElasticaOnPegs, ThroughARing) {
  HeldRod rod;
  rod.radius = 0.005;
  rod.pegs = {{0.6, -0.01, 0.004, 0.004}};
  HeldState u(4);
  const double first = 3 * 0.0005 / std::pow(0.6, 3);
  u << -first * 0.6, first, kPi / 2, 0.6;
  raise_base(rod, u, -0.0015, -0.25);
  Expected expected = expected_of(rod, u);
  expected.z += 0.25;  // the ring rises instead
  const LoadResult loaded = contact_scene("through_a_ring");
  ASSERT_TRUE(loaded.scene);
  compare(end_of(*loaded.scene), expected, 3e-5);
}

// Ridges are points; the weight grows from where both carry.
TEST(ElasticaOnPegs, OnARock) {
  const double weight = 10000 * kPi * 25e-6 * 9.81;
  HeldRod rod;
  rod.radius = 0.005;
  rod.pegs = {{0.30, -0.02, 0, 0}, {0.46, -0.055, 0, 0}};
  HeldState u(7);
  u << -0.1, 5, 1.44, 0.3013, 0.5, 1.1, 0.463;
  for (int i = 0; i <= 20; ++i) {
    rod.w = 5 + (weight - 5) * i / 20;
    ASSERT_LT(solve_held(rod, u), 1e-12);
  }
  const LoadResult loaded = contact_scene("cantilever_on_rock");
  ASSERT_TRUE(loaded.scene);
  compare(end_of(*loaded.scene), expected_of(rod, u), 6e-5);
}

// To the solver's tolerance: a heavy rod on a table, across the diagonals of its top, or on its
// edge.
TEST(ElasticaOnPegs, ABoxIsABoxToo) {
  const LoadResult loaded = contact_scene("touchdown");
  ASSERT_TRUE(loaded.scene);
  for (const double length : {8.0, 4.0}) {
    Scene box = *loaded.scene;
    ColliderSpec& top = box.bodies[0].colliders[0];
    top.shape.kind = ShapeKind::kBox;
    top.shape.size = {length, 2, 0.25};
    top.X_BC.p = {0, 0, -0.125};
    Scene mesh = box;
    mesh.meshes.push_back(box_mesh(top.shape.size));
    mesh.bodies[0].colliders[0].shape.kind = ShapeKind::kMesh;
    mesh.bodies[0].colliders[0].shape.mesh = static_cast<int>(mesh.meshes.size()) - 1;
    const Snapshot a = end_of(box), b = end_of(mesh);
    EXPECT_GT(a.contact.count, length > 6 ? 20 : 0);
    EXPECT_EQ(a.rods[0].points.back().position.z() < -0.1, length < 6);
    EXPECT_EQ(a.contact.count, b.contact.count);
    EXPECT_NEAR(a.contact.force, b.contact.force, 1e-8);
    for (std::size_t i = 0; i < a.rods[0].points.size(); ++i)
      EXPECT_LT((a.rods[0].points[i].position - b.rods[0].points[i].position).norm(), 1e-9);
  }
}

ColliderSpec& collider_of(Scene& scene, ShapeKind kind) {
  for (BodySpec& body : scene.bodies)
    for (ColliderSpec& collider : body.colliders)
      if (collider.shape.kind == kind) return collider;
  throw std::invalid_argument("no such collider");
}

// The edge of a box that is driven down on a rod.
TEST(ElasticaOnPegs, ADrivenBoxIsABoxToo) {
  const LoadResult loaded = contact_scene("driven_cylinder");
  ASSERT_TRUE(loaded.scene);
  Scene box = *loaded.scene;
  ColliderSpec& tool = collider_of(box, ShapeKind::kCylinder);
  tool.shape.kind = ShapeKind::kBox;
  tool.shape.size = {0.0625, 0.0625, 0.25};
  tool.X_BC.R = tool.X_BC.R * Eigen::AngleAxisd(kPi / 4, Vec3::UnitZ()).toRotationMatrix();
  Scene mesh = box;
  ShapeSpec& shape = collider_of(mesh, ShapeKind::kBox).shape;
  mesh.meshes.push_back(box_mesh(shape.size));
  shape.kind = ShapeKind::kMesh;
  shape.mesh = static_cast<int>(mesh.meshes.size()) - 1;
  const Snapshot a = end_of(box), b = end_of(mesh);
  EXPECT_GT(a.contact.force, 1);
  EXPECT_NEAR(a.contact.force, b.contact.force, 1e-6 * a.contact.force);
  const Vec3 &tip_a = a.rods[0].points.back().position, &tip_b = b.rods[0].points.back().position;
  EXPECT_LT((tip_a - tip_b).norm(), 1e-7);
}

// A ball in flight that falls on rods, as an ellipsoid.
TEST(ElasticaOnPegs, ARoundEllipsoidIsABall) {
  const LoadResult loaded = contact_scene("ball_on_rods");
  ASSERT_TRUE(loaded.scene);
  Scene ball = *loaded.scene;
  ball.simulation.duration = 0.2;
  Scene egg = ball;
  ShapeSpec& shape = collider_of(egg, ShapeKind::kSphere).shape;
  shape.kind = ShapeKind::kEllipsoid;
  shape.size = Vec3::Constant(shape.size.x());
  const Snapshot a = end_of(ball), b = end_of(egg);
  EXPECT_GT(a.contact.count, 0);
  EXPECT_EQ(a.contact.count, b.contact.count);
  EXPECT_NEAR(a.contact.force, b.contact.force, 1e-6 * a.contact.force);
}

}  // namespace
}  // namespace cprsim
