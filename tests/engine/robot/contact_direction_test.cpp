// SPDX-License-Identifier: BSD-3-Clause
// The derivatives of contact rows and of what contact forces do to a rod, at states where no row
// vanishes (see newton_direction_test.cpp), and their elimination.
#include <gtest/gtest.h>

#include <functional>

#include "engine/robot/ties.h"
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
  // two of them give
  for (std::size_t i : {1U, 3U}) {
    robot.rods[1].model->touching()->contacts()[i].give = 0.05;
    robot.rods[1].model->touching()->contacts()[i].lag = 0.02;
  }
  TouchingRod& side = *robot.rods[1].model->touching();
  if (side.owns_forces()) return;
  robot.rods_meet = true;
  for (RodContact& contact : side.contacts())
    contact.role = ContactRole::kShared;
}

double slope_error(Grip grip, bool dynamic, double h, unsigned seed,
                   const ShapeSpec& shape = ball(), const MeshDistance* mesh = nullptr,
                   Method method = Method::kShooting,
                   const std::function<void(Scene&, Robot*)>& change = {}) {
  const std::vector<Surface> surfaces{{&shape, {Mat3::Identity(), {0.9, 0.7, 1.2}}, mesh}};
  Scene scene = chain_of_rods(EndJoint::kRevolute, EndJoint::kUniversal);
  if (change) change(scene, nullptr);
  for (Effect e : {Effect::kGravity, Effect::kExtension, Effect::kRotaryInertia})
    scene.effects.set(e, true);
  if (method != Method::kShooting) cut_for_contact(scene, method);
  Numbers numbers(seed);
  Robot robot = build_robot(scene);
  touch(robot, surfaces, grip);
  if (change) change(scene, &robot);
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

TEST(ContactDirection, IsExactByEveryMethod) {
  for (Method method : {Method::kStrain, Method::kCollocation})
    for (Grip grip : {Grip::kSmooth, Grip::kStick, Grip::kSlip})
      for (bool dynamic : {false, true})
        for (unsigned seed = 1; seed <= 2; ++seed)
          EXPECT_LT(slope_error(grip, dynamic, 0.01, seed, ball(), nullptr, method),
                    kSlopeTolerance)
              << static_cast<int>(method) << ", " << static_cast<int>(grip);
}

/// A tendon that rubs and one whose tension is found on the rod that touches.
void pull(Scene& scene, bool displaced) {
  scene.effects.set(Effect::kTendonFriction, true);
  for (const bool given : {true, false}) {
    TendonSpec tendon;
    tendon.name = given ? "given" : "found";
    tendon.rod = 1;
    tendon.route = TendonRoute::kHelical;
    tendon.radius = 0.03;
    tendon.angle = given ? 0.4 : 2;
    tendon.turns = 0.3;
    tendon.friction = given ? 0.4 : 0;
    DriveSpec drive;
    drive.tendon = static_cast<int>(scene.tendons.size());
    drive.quantity = given || !displaced ? DriveQuantity::kTension : DriveQuantity::kDisplacement;
    ProfileTerm value;
    value.value = given ? 0.7 : 0.01;
    drive.profile.terms.push_back(value);
    scene.drives.push_back(drive);
    scene.tendons.push_back(tendon);
  }
}

// The unknowns of tendons and of contacts stand in the same equations, whoever holds the forces.
TEST(ContactDirection, IsExactWhereTendonsAskForTensions) {
  for (Method method : {Method::kShooting, Method::kStrain, Method::kCollocation})
    for (const bool displaced : {false, true})
      for (const bool shared : {false, true}) {
        if (method != Method::kShooting && !shared) continue;
        const auto change = [&](Scene& scene, Robot* robot) {
          if (!robot) {
            pull(scene, displaced);
            return;
          }
          robot->rods_meet = shared;
          for (RodContact& contact : robot->rods[1].model->touching()->contacts())
            contact.role = shared ? ContactRole::kShared : ContactRole::kOwn;
        };
        for (Grip grip : {Grip::kSmooth, Grip::kSlip})
          for (bool dynamic : {false, true})
            EXPECT_LT(slope_error(grip, dynamic, 0.01, 1, ball(), nullptr, method, change),
                      kSlopeTolerance)
                << static_cast<int>(method) << displaced << shared << dynamic;
      }
}

/// Ties along the rod that touches and at its tip, where it touches, too.
void tie_up(Scene& scene, Robot* robot, int points) {
  if (!robot) {
    tie_chain(scene);
    TieSpec last;
    last.rod = 1;
    last.other = 0;
    last.s = {1};
    last.other_s = {0.8};
    scene.ties.push_back(last);
    if (points > 0) scene.solver.points = points;
    return;
  }
  TouchingRod& side = *robot->rods[1].model->touching();
  RodContact last = side.contacts().back();
  last.cell = side.contact_grid().size() - 1;
  last.xi = 0;
  side.contacts().push_back(last);
  tie_rods(*robot);
}

TEST(ContactDirection, IsExactWhereRodsAreTied) {
  for (Method method : {Method::kShooting, Method::kStrain, Method::kCollocation})
    for (const bool free : {false, true})
      for (const int points : {0, 30})
        for (Grip grip : {Grip::kSmooth, Grip::kStick, Grip::kSlip})
          for (bool dynamic : {false, true}) {
            const auto change = [&](Scene& scene, Robot* robot) {
              tie_up(scene, robot, points);
              if (free) scene.rods[1].tip.joint = EndJoint::kFree;
            };
            // in short steps rods of shooting are cut into segments
            for (const double h : {0.01, 1. / 4000})
              EXPECT_LT(slope_error(grip, dynamic, h, 1, ball(), nullptr, method, change),
                        kSlopeTolerance)
                  << static_cast<int>(method) << ", " << points << ", " << static_cast<int>(grip)
                  << free << dynamic;
          }
}

// Contacts and segments' starts recombine the same columns.
TEST(ContactDirection, IsExactAcrossSegments) {
  for (Grip grip : {Grip::kSmooth, Grip::kStick, Grip::kSlip})
    EXPECT_LT(slope_error(grip, true, 1. / 1000, 1), kSlopeTolerance) << static_cast<int>(grip);
}

/// Largest error of the derivatives of grip_rows() by gap, n, u and f, over the largest of them.
double rows_error(const RodContact& contact, const Vec3& u) {
  const ContactScale scale{0.4, 2.0, 3.0, 1e-3};
  const double gap = -2e-3;
  const Vec3 n = Vec3(0.3, -0.2, 0.9).normalized();
  const GripRows rows = grip_rows(contact, gap, n, u, scale);
  const auto at = [&](double by_gap, const Vec3& by_n, const Vec3& by_u, const Vec3& by_force) {
    RodContact moved = contact;
    moved.force += by_force;
    return grip_rows(moved, gap + by_gap, n + by_n, u + by_u, scale).value;
  };
  constexpr double kStep = 1e-6;
  double error = 0, largest = 0;
  const auto compare = [&](const Vec3& found, const Vec3& plus, const Vec3& minus) {
    error = std::max(error, (found - (plus - minus) / (2 * kStep)).norm());
    largest = std::max(largest, found.norm());
  };
  const Vec3 none = Vec3::Zero();
  compare(rows.by_gap, at(kStep, none, none, none), at(-kStep, none, none, none));
  for (int i = 0; i < 3; ++i) {
    const Vec3 e = kStep * Vec3::Unit(i);
    compare(rows.by_n.col(i), at(0, e, none, none), at(0, -e, none, none));
    compare(rows.by_u.col(i), at(0, none, e, none), at(0, none, -e, none));
    compare(rows.by_force.col(i), at(0, none, none, e), at(0, none, none, -e));
  }
  return error / largest;
}

// Slipping, at rest within the cone, pulling, and with friction bounded beforehand.
TEST(ContactDirection, IsExactOnEveryBranchOfFriction) {
  Numbers numbers(5);
  RodContact contact = contact_at(1, 0, Grip::kSlip, numbers);
  contact.axis = Vec3(0.8, 0.6, 0);
  const Vec3 slow(0.02, -0.01, 0.03), fast(2, -1, 0.5);

  struct Case {
    Vec3 force;
    double friction, bound;
    Vec3 slip;
  };

  for (const Case& c : {Case{{1, 0.5, 2}, 0.4, -1, fast}, Case{{0.1, 0.2, 3}, 0.9, -1, slow},
                        Case{{0.3, 0.5, -2}, 0.4, -1, fast}, Case{{1, 0.5, 2}, 0.4, 0.3, fast},
                        Case{{0.2, 0.1, 2}, 0.4, 5, slow}, Case{{0.3, 0.5, -2}, 0.4, 0.3, fast}}) {
    contact.force = c.force;
    contact.friction = c.friction;
    contact.bound = c.bound;
    contact.may_rest = true;
    contact.held = 0.9 * c.force;
    EXPECT_LT(rows_error(contact, c.slip), 1e-8) << c.force.transpose() << ", " << c.bound;
    RodContact soft = contact;
    soft.give = 0.03;
    soft.lag = 0.01;
    EXPECT_LT(rows_error(soft, c.slip), 1e-8) << c.force.transpose() << ", " << c.bound;
  }
}

// Where its rows hold, the force is that of the spring and the damper.
TEST(ContactDirection, OfWhatGivesIsASpringAndADamper) {
  const ContactScale scale{0.4, 2.0, 3.0, 0};
  const double kp = 250, kd = 4, gap = -3e-3;
  const Vec3 n = Vec3(0.3, -0.2, 0.9).normalized(), u = -0.05 * n + Vec3(0.02, 0.03, 0);
  RodContact contact;
  contact.give = 1 / kp;
  contact.lag = kd / kp;
  contact.force = (-kp * gap - kd * n.dot(u)) * n;
  EXPECT_LT(grip_rows(contact, gap, n, u, scale).value.norm(), 1e-15);
  contact.force *= 1.01;
  EXPECT_GT(grip_rows(contact, gap, n, u, scale).value.norm(), 1e-6);
}

// Neither between slip and rest nor where pressure ends do the rows jump.
TEST(ContactDirection, IsOfRowsWithoutJumps) {
  Numbers numbers(5);
  RodContact contact = contact_at(1, 0, Grip::kSlip, numbers);
  contact.held.setZero();
  contact.may_rest = true;
  const ContactScale scale{0.4, 2.0, 3.0, 0};
  const Vec3 n = Vec3::UnitZ();
  Vec3 before = Vec3::Zero();
  for (int i = 0; i <= 4000; ++i) {
    // from a pull to a pressure under which it rests
    contact.force = Vec3(0.5, 0, -1 + i * 1e-3);
    if (contact.force.z() <= 0) contact.force.x() = 0;
    const Vec3 value = grip_rows(contact, 0, n, Vec3(-0.3, 0, 0), scale).value;
    if (i > 0 && i != 1001) {
      EXPECT_LT((value - before).norm(), 1e-3) << contact.force.transpose();
    }
    before = value;
  }
}

}  // namespace
}  // namespace cprsim
