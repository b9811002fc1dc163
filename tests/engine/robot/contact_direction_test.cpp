// SPDX-License-Identifier: BSD-3-Clause
// The derivatives of contact rows and of what contact forces do to a rod, at states where no row
// vanishes (see newton_direction_test.cpp), and their elimination.
#include <gtest/gtest.h>

#include "engine/rod/contact.h"
#include "tests/engine/robot/direction_error.h"
#include "tests/engine/robot/sample_scenes.h"

namespace cprsim {
namespace {

constexpr double kSlopeTolerance = 1e-7;  // that of newton_direction_test

ShapeSpec ball() {
  ShapeSpec shape;
  shape.kind = ShapeKind::kSphere;
  shape.size = {0.3, 0, 0};
  return shape;
}

ShapeSpec egg() {
  ShapeSpec shape;
  shape.kind = ShapeKind::kEllipsoid;
  shape.size = {0.3, 0.2, 0.35};
  return shape;
}

/// Its sides, edges and corners face the rods.
MeshSpec octahedron() {
  MeshSpec mesh;
  for (int i = 0; i < 6; ++i)
    mesh.positions.emplace_back(((i % 2 == 0 ? 0.3 : -0.3) * Vec3::Unit(i / 2)).cast<float>());
  for (unsigned x : {0U, 1U})
    for (unsigned y : {2U, 3U})
      for (unsigned z : {4U, 5U})
        mesh.triangles.push_back((x + y + z) % 2 == 0 ? std::array{x, y, z} : std::array{y, x, z});
  return mesh;
}

RodContact contact_at(std::size_t cell, double xi, Grip grip, Numbers& numbers) {
  RodContact contact;
  contact.surface = 0;
  contact.cell = cell;
  contact.xi = xi;
  contact.grip = grip;
  contact.friction = 0.4;
  contact.kappa = 1.7;
  contact.lever = 0.02 * numbers.vec3();
  contact.axis = numbers.vec3().normalized();
  contact.held = numbers.vec3();
  contact.force = Vec3(3, -2, 1) + numbers.vec3();
  return contact;
}

/// Two contacts at nodes, two in cells, on the rod between two bodies.
void touch(Robot& robot, const std::vector<Surface>& surfaces, Grip grip) {
  Numbers numbers(11);
  for (RobotRod& rod : robot.rods)
    rod.model->touching()->set_surfaces(surfaces, 0.02, grip != Grip::kSmooth);
  robot.rods[1].model->touching()->contacts() = {
      contact_at(1, 0, grip, numbers), contact_at(1, 0.3, grip, numbers),
      contact_at(2, 0.8, grip, numbers), contact_at(4, 0, grip, numbers)};
}

double slope_error(Grip grip, bool dynamic, double h, unsigned seed,
                   const ShapeSpec& shape = ball(), const MeshDistance* mesh = nullptr) {
  const std::vector<Surface> surfaces{{&shape, {Mat3::Identity(), {0.9, 0.7, 1.2}}, mesh}};
  Scene scene = chain_of_rods(EndJoint::kRevolute, EndJoint::kUniversal);
  for (Effect e : {Effect::kGravity, Effect::kExtension, Effect::kRotaryInertia})
    scene.effects.set(e, true);
  Numbers numbers(seed);
  Robot robot = build_robot(scene);
  touch(robot, surfaces, grip);
  Equations equations(robot, 1e-9);
  equations.set_instant(0, true, StageRates{});
  StageRates rates;
  if (dynamic) rates = start_step(robot, equations, SchemeKind::kBackwardEuler, h, numbers);
  equations.set_instant(0, true, rates);
  disturb(robot, equations, numbers, 0.05);
  equations.evaluate();
  equations.set_instant(0, true, rates);  // now that there are states, segments are cut
  disturb(robot, equations, numbers, 0.05);
  return direction_error(equations);
}

TEST(ContactDirection, IsExactForEveryGrip) {
  for (Grip grip : {Grip::kSmooth, Grip::kStick, Grip::kSlip})
    for (unsigned seed = 1; seed <= 3; ++seed) {
      EXPECT_LT(slope_error(grip, false, 0, seed), kSlopeTolerance) << static_cast<int>(grip);
      EXPECT_LT(slope_error(grip, true, 1. / 100, seed), kSlopeTolerance) << static_cast<int>(grip);
    }
}

TEST(ContactDirection, IsExactOnEveryShape) {
  const MeshDistance mesh(octahedron());
  ASSERT_TRUE(mesh.closed());
  ShapeSpec shape;
  shape.kind = ShapeKind::kMesh;
  for (Grip grip : {Grip::kSmooth, Grip::kStick, Grip::kSlip})
    for (unsigned seed = 1; seed <= 3; ++seed)
      for (bool dynamic : {false, true}) {
        EXPECT_LT(slope_error(grip, dynamic, 0.01, seed, egg()), kSlopeTolerance);
        EXPECT_LT(slope_error(grip, dynamic, 0.01, seed, shape, &mesh), kSlopeTolerance);
      }
}

// Contacts and segments' starts recombine the same columns.
TEST(ContactDirection, IsExactAcrossSegments) {
  for (Grip grip : {Grip::kSmooth, Grip::kStick, Grip::kSlip})
    EXPECT_LT(slope_error(grip, true, 1. / 1000, 1), kSlopeTolerance) << static_cast<int>(grip);
}

}  // namespace
}  // namespace cprsim
