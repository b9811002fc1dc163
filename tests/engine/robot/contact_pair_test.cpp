// SPDX-License-Identifier: BSD-3-Clause
// Contacts of rods with bodies that move and with each other: derivatives, with the other side's
// unknowns, and action and reaction, at states where no row vanishes.
#include "engine/robot/contact_pair.h"

#include <gtest/gtest.h>

#include "tests/engine/robot/direction_error.h"
#include "tests/engine/robot/sample_scenes.h"
#include "tests/support/methods.h"

namespace cprsim {
namespace {

constexpr double kSlopeTolerance = 1e-7;  // that of newton_direction_test

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

RodContact with_body(RodContact contact, int body) {
  contact.role = ContactRole::kShared;
  contact.surface = 1;
  contact.body = body;
  return contact;
}

struct Place {
  int rod = 0, entry = 0;
  std::size_t cell = 0;
  double xi = 0;
};

/// The entry of the rod at `here` that touches the other at `there`, and what it leaves there.
RodContact with_rod(RodContact contact, const Place& there, Numbers& numbers) {
  contact.role = ContactRole::kShared;
  contact.other_rod = there.rod;
  contact.partner = there.entry;
  contact.other_cell = there.cell;
  contact.other_xi = there.xi;
  contact.other_lever = 0.02 * numbers.vec3();
  return contact;
}

RodContact echo_of(const RodContact& contact, const Place& here) {
  RodContact echo;
  echo.role = ContactRole::kEcho;
  echo.cell = contact.other_cell;
  echo.xi = contact.other_xi;
  echo.lever = contact.other_lever;
  echo.force = -contact.force;
  echo.other_rod = here.rod;
  echo.partner = here.entry;
  return echo;
}

enum class Others { kBodies, kRods, kBoth, kItself };

/// Contacts of a rod with itself, at nodes and in cells.
void touch_itself(std::vector<RodContact>& contacts, Grip grip, Numbers& numbers) {
  const auto at = [&](std::size_t cell, double xi) {
    RodContact contact = contact_at(cell, xi, grip, numbers);
    contact.give = xi > 0 ? 0.05 : 0;  // some give
    contact.lag = xi > 0 ? 0.02 : 0;
    return contact;
  };
  contacts = {with_rod(at(0, 0.4), {1, 3, 2, 0.7}, numbers),
              with_rod(at(1, 0), {1, 5, 4, 0.5}, numbers),
              with_rod(at(1, 0.6), {1, 4, 3, 0}, numbers)};
  contacts.push_back(echo_of(contacts[0], {1, 0}));
  contacts.push_back(echo_of(contacts[2], {1, 2}));
  contacts.push_back(echo_of(contacts[1], {1, 1}));
}

/// Contacts of the middle rod with what stands still, with both bodies, and with both other rods,
/// at nodes, in cells, and several in one cell.
void touch(Robot& robot, const std::vector<Surface>& surfaces, Grip grip, Others others) {
  Numbers numbers(11);
  robot.rods_meet = true;
  for (RobotRod& rod : robot.rods)
    rod.model->touching()->set_surfaces(surfaces, 0.02, grip != Grip::kSmooth);
  const auto at = [&](std::size_t cell, double xi) {
    RodContact contact = contact_at(cell, xi, grip, numbers);
    contact.give = xi > 0 ? 0.05 : 0;  // some give
    contact.lag = xi > 0 ? 0.02 : 0;
    return contact;
  };
  std::vector<RodContact>& first = robot.rods[0].model->touching()->contacts();
  std::vector<RodContact>& middle = robot.rods[1].model->touching()->contacts();
  std::vector<RodContact>& last = robot.rods[2].model->touching()->contacts();
  if (others == Others::kItself) {
    touch_itself(middle, grip, numbers);
    return;
  }
  const bool own_forces = robot.rods[1].model->touching()->owns_forces();
  const auto still = [&](RodContact contact) {
    contact.role = own_forces ? ContactRole::kOwn : ContactRole::kShared;
    return contact;
  };
  const bool bodies = others != Others::kRods, rods = others != Others::kBodies;
  const auto meet = [&](const RodContact& contact, int rod, std::vector<RodContact>& other,
                        std::size_t cell, double xi) {
    const auto entry = static_cast<int>(other.size());
    middle.push_back(with_rod(contact, {rod, entry, cell, xi}, numbers));
    other.push_back(echo_of(middle.back(), {1, static_cast<int>(middle.size()) - 1}));
  };
  if (bodies) first.push_back(with_body(at(2, 0), 1));
  if (rods) meet(at(0, 0.4), 0, first, 3, 0.7);
  middle.push_back(still(at(1, 0.3)));
  if (bodies) middle.push_back(with_body(at(1, 0.6), 0));
  if (rods) meet(at(2, 0), 2, last, 1, 0);
  if (bodies) middle.push_back(with_body(at(2, 0.2), 1));
  if (rods) meet(at(3, 0.5), 2, last, 3, 0.1);
  middle.push_back(still(at(4, 0)));
  if (bodies) middle.push_back(with_body(at(4, 0.5), 1));
}

struct Case {
  Grip grip = Grip::kSmooth;
  Others others = Others::kBoth;
  double h = 0;  ///< of the step; 0: statics
  unsigned seed = 1;
  Method method = Method::kShooting;
  bool disks = false;
};

ShapeSpec ball() {
  ShapeSpec shape;
  shape.kind = ShapeKind::kSphere;
  shape.size = {0.3, 0, 0};
  return shape;
}

double slope_error(const Case& c) {
  const ShapeSpec shape = ball();
  const std::vector<Surface> surfaces{{&shape, {Mat3::Identity(), {0.9, 0.7, 1.2}}},
                                      {&shape, Numbers(3).pose(1, 0.4)}};
  Scene scene = chain_of_rods(EndJoint::kRevolute, EndJoint::kUniversal);
  for (Effect e : {Effect::kGravity, Effect::kExtension, Effect::kRotaryInertia})
    scene.effects.set(e, true);
  if (c.method != Method::kShooting) cut_for_contact(scene, c.method);
  if (c.disks) scene.rods[1].disks = {{0.35, 0.2, 0.3}, {0.7, 0.1, 0.2}, {1, 0.1, 0.3}};
  Numbers numbers(c.seed);
  Robot robot = build_robot(scene);
  touch(robot, surfaces, c.grip, c.others);
  Equations equations(robot, 1e-9);
  equations.accept_contacts();
  equations.set_instant(0, true, StageRates{});
  StageRates rates;
  if (c.h > 0) rates = start_step(robot, equations, SchemeKind::kBackwardEuler, c.h, numbers);
  equations.set_instant(0, true, rates);
  disturb(robot, equations, numbers, 0.05);
  equations.evaluate();
  equations.set_instant(0, true, rates);  // now that there are states, segments are cut
  disturb(robot, equations, numbers, 0.05);
  return direction_error(equations);
}

class PairDirection : public testing::TestWithParam<Others> {};

TEST_P(PairDirection, IsExactForEveryGrip) {
  for (Grip grip : {Grip::kSmooth, Grip::kStick, Grip::kSlip})
    for (unsigned seed = 1; seed <= 3; ++seed)
      for (double h : {0.0, 0.01})
        EXPECT_LT(slope_error({grip, GetParam(), h, seed}), kSlopeTolerance)
            << static_cast<int>(grip) << ", step " << h;
}

TEST_P(PairDirection, IsExactByEveryMethod) {
  for (Method method : {Method::kStrain, Method::kCollocation})
    for (Grip grip : {Grip::kSmooth, Grip::kStick, Grip::kSlip})
      for (double h : {0.0, 0.01})
        EXPECT_LT(slope_error({grip, GetParam(), h, 1, method}), kSlopeTolerance)
            << static_cast<int>(method) << ", " << static_cast<int>(grip) << ", step " << h;
}

TEST_P(PairDirection, IsExactWithDisks) {
  for (Method method : kEveryMethod)
    for (Grip grip : {Grip::kSmooth, Grip::kStick, Grip::kSlip})
      for (double h : {0.01, 1e-3})
        EXPECT_LT(slope_error({grip, GetParam(), h, 1, method, true}), kSlopeTolerance)
            << static_cast<int>(method) << ", " << static_cast<int>(grip) << ", step " << h;
}

// Contacts and segments' starts recombine the same columns.
TEST_P(PairDirection, IsExactAcrossSegments) {
  for (Grip grip : {Grip::kSmooth, Grip::kStick, Grip::kSlip})
    EXPECT_LT(slope_error({grip, GetParam(), 1e-3, 1}), kSlopeTolerance) << static_cast<int>(grip);
}

// What rods receive, by their own balance from base to tip, and bodies, is all from what stands
// still: forces, and moments about the origin, at any state.
void expect_action_is_reaction(Others others, Method method) {
  const ShapeSpec shape = ball();
  const std::vector<Surface> surfaces{{&shape, {Mat3::Identity(), {0.9, 0.7, 1.2}}},
                                      {&shape, Numbers(3).pose(1, 0.4)}};
  Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kFixed);
  scene.effects.set(Effect::kGravity, false);
  if (method != Method::kShooting) cut_for_contact(scene, method);
  Robot robot = build_robot(scene);
  touch(robot, surfaces, Grip::kStick, others);
  Equations equations(robot, 1e-9);
  equations.set_instant(0, true, StageRates{});
  Numbers numbers(2);
  disturb(robot, equations, numbers, 0.05);
  equations.evaluate();
  Vec6 sum = Vec6::Zero();
  for (std::size_t b = 0; b < robot.bodies.size(); ++b) {
    Vec6 w = equations.contact_wrench(static_cast<int>(b));
    w.head<3>() += robot.bodies[b].p.cross(w.tail<3>());
    sum += w;
  }
  for (const RobotRod& rod : robot.rods) {
    ASSERT_EQ(rod.model->segments(), 1);
    const Port origin;
    sum += rod.model->wrench_on_base(origin) + rod.model->wrench_on_tip(origin);
    const std::vector<RodContact>& contacts = rod.model->touching()->contacts();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      // between rods the two surfaces' points, apart here, are one once the contact is solved
      if (contacts[i].role == ContactRole::kShared && contacts[i].body >= 0) continue;
      const ContactEnds ends = rod.model->touching()->contact_ends(i);
      const Vec3 y = contact_point(contacts[i].xi, ends.h, ends.node) + contacts[i].lever;
      sum.head<3>() -= y.cross(contacts[i].force);
      const bool still = contacts[i].body < 0 && contacts[i].other_rod < 0;
      if (still) sum.tail<3>() -= contacts[i].force;
    }
  }
  EXPECT_LT(sum.norm(), 1e-12);
}

// Collocation has the balance among its rows, which hold of solutions only.
TEST_P(PairDirection, ActionIsReaction) {
  expect_action_is_reaction(GetParam(), Method::kShooting);
  expect_action_is_reaction(GetParam(), Method::kStrain);
}

INSTANTIATE_TEST_SUITE_P(ContactPair, PairDirection,
                         testing::Values(Others::kBodies, Others::kRods, Others::kBoth,
                                         Others::kItself));

}  // namespace
}  // namespace cprsim
