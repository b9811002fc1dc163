// SPDX-License-Identifier: BSD-3-Clause
// Rods that carry disks, against point loads, bodies that are welded to rods, frequency equations,
// a pendulum, and method against method; with tendons in a fluid, too.
#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "engine/study/modes.h"
#include "tests/support/methods.h"
#include "tests/support/tendons.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 1e-3;

Scene wire() {
  Scene scene;
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {2, -1, -9};
  scene.rods.push_back(steel_rod(kLength, kRadius));
  return scene;
}

Scene moving(Scene scene, double duration, double step) {
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = duration;
  scene.solver.scheme = SchemeKind::kEsdirk43;
  scene.solver.step = step;
  return scene;
}

BodySpec body_like(const DiskSpec& disk, double height) {
  BodySpec body;
  body.name = "body";
  body.mass = disk.mass;
  body.inertia = (disk.mass * disk.radius * disk.radius * Vec3(0.25, 0.25, 0.5)).asDiagonal();
  body.X_WB.p = {0, 0, height};
  return body;
}

/// As a body that the rod's tip is clamped to.
Scene as_body(Scene scene) {
  const DiskSpec disk = scene.rods[0].disks.back();
  scene.rods[0].disks.pop_back();
  scene.bodies.push_back(body_like(disk, kLength));
  scene.rods[0].tip.joint = EndJoint::kFixed;
  scene.rods[0].tip.at.body = 0;
  return scene;
}

RodSample end_of(const Scene& scene, std::size_t rod = 0) {
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  return end.rods.at(rod);
}

class Disks : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, Disks, ::testing::ValuesIn(kEveryMethod), test_name);

TEST_P(Disks, WeighLikePointLoads) {
  Scene carrying = finely(wire(), GetParam()), loaded = carrying;
  for (const double s : {0.25, 0.6, 1.}) {
    carrying.rods[0].disks.push_back({s, 0.1 * s, 0.02});
    add_load(loaded, s, 0.1 * s * loaded.gravity);
  }
  const Equilibrium a(carrying, 1e-13), b(loaded, 1e-13);
  ASSERT_TRUE(a.report.converged()) << a.report.worst_row;
  const RodSample one = a.rod(), two = b.rod();
  ASSERT_EQ(one.points.size(), two.points.size());
  EXPECT_GT(one.points.back().position.head<2>().norm(), 0.05);
  for (std::size_t k = 0; k < one.points.size(); ++k) {
    EXPECT_LT((one.points[k].position - two.points[k].position).norm(), 1e-12) << k;
    EXPECT_LT((one.points[k].force - two.points[k].force).norm(), 1e-11) << k;
  }
  carrying.rods[0].gravity = loaded.rods[0].gravity = false;
  EXPECT_LT((Equilibrium(carrying).rod().points.back().position - Vec3(0, 0, kLength)).norm(),
            1e-12);
}

// The same system, put together by other means: the body's equations are those of the robot.
TEST_P(Disks, AtTheTipAreABodyThere) {
  Scene scene = moving(finely(wire(), GetParam()), 0.04, 1e-3);
  switch_on(scene, {Effect::kRotaryInertia, Effect::kDamping, Effect::kExtension, Effect::kShear});
  damp(scene.rods[0], 1e-3);
  scene.rods[0].disks = {{1, 0.02, 0.05}};
  add_load(scene, 0.7, {0.4, 0.3, 0}, {0.02, -0.03, 0.05}, true);
  const RodPoint disk = end_of(scene).points.back(), body = end_of(as_body(scene)).points.back();
  EXPECT_GT(disk.velocity.norm(), 0.1);
  EXPECT_LT((disk.position - body.position).norm(), 1e-8 * kLength);
  EXPECT_LT((disk.rotation - body.rotation).norm(), 1e-7);
  EXPECT_LT((disk.velocity - body.velocity).norm(), 1e-6 * body.velocity.norm());
}

// Two rods that are welded to a body between them.
TEST_P(Disks, AlongARodAreABodyBetweenTwo) {
  Scene one = moving(finely(wire(), GetParam()), 0.03, 1e-3);
  switch_on(one, {Effect::kRotaryInertia});
  one.rods[0].disks = {{0.5, 0.02, 0.04}};
  Scene two = one;
  two.bodies.push_back(body_like(two.rods[0].disks[0], kLength / 2));
  RodSpec lower = two.rods[0];
  lower.disks.clear();
  lower.length = kLength / 2;
  RodSpec upper = lower;
  upper.name = "upper";
  lower.tip.joint = EndJoint::kFixed;
  lower.tip.at.body = upper.base.at.body = 0;
  two.rods = {lower, upper};
  add_load(one, 1, {0.2, 0.1, 0}, Vec3::Zero(), true);
  add_load(two, 1, {0.2, 0.1, 0}, Vec3::Zero(), true).rod = 1;
  const RodPoint a = end_of(one).points.back(), b = end_of(two, 1).points.back();
  EXPECT_GT(a.velocity.norm(), 0.1);
  EXPECT_LT((a.position - b.position).norm(), 1e-6 * kLength);
  EXPECT_LT((a.rotation - b.rotation).norm(), 1e-5);
}

// Clamped, with mu times its own mass at the tip:
//   1 + cos b cosh b + mu b (cos b sinh b - sin b cosh b) = 0
double tip_mass_root(double mu, double from, double to) {
  const auto f = [mu](double b) {
    return 1 + std::cos(b) * std::cosh(b) +
           mu * b * (std::cos(b) * std::sinh(b) - std::sin(b) * std::cosh(b));
  };
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (from + to);
    (f(from) * f(middle) <= 0 ? to : from) = middle;
  }
  return from;
}

double frequency_of(double root) {
  const RodSpec rod = steel_rod(kLength, kRadius);
  return root * root / (kLength * kLength) *
         std::sqrt(bending_stiffness(rod) / section_properties(rod).rhoA);
}

TEST_P(Disks, AtTheTipLowerTheFrequencies) {
  const double own = section_properties(steel_rod(kLength, kRadius)).rhoA * kLength;
  for (const double mu : {0.5, 5.}) {
    Scene scene = finely(wire(), GetParam());
    scene.gravity.setZero();
    scene.rods[0].disks = {{1, mu * own, 0.03}};
    StaticStudy study(scene);
    ASSERT_TRUE(study.solve().converged());
    const std::vector<VibrationMode> modes = natural_modes(study, 4);
    const double first = frequency_of(tip_mass_root(mu, 0.5, 1.9)),
                 second = frequency_of(tip_mass_root(mu, 3, 4.7));
    EXPECT_NEAR(std::sqrt(modes[0].omega_squared) / first, 1, 1e-6);
    EXPECT_NEAR(std::sqrt(modes[2].omega_squared) / second, 1, 1e-5);
  }
}

// rotary inertia in the modes, and the stiffness that weight has: as of the body
TEST_P(Disks, HaveTheModesOfABodyThere) {
  Scene scene = finely(wire(), GetParam());
  switch_on(scene, {Effect::kRotaryInertia});
  scene.rods[0].disks = {{0.5, 0.01, 0}, {1, 0.02, 0.08}};
  const auto lowest = [](const Scene& of) {
    StaticStudy study(of);
    EXPECT_TRUE(study.solve().converged());
    return natural_modes(study, 6);
  };
  const std::vector<VibrationMode> disks = lowest(scene), body = lowest(as_body(scene));
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(disks[i].omega_squared / body[i].omega_squared, 1, 1e-7) << i;
}

TEST_P(Disks, SwingAsTheFrequencyEquationSays) {
  const double mu = 5, own = section_properties(steel_rod(kLength, kRadius)).rhoA * kLength;
  const double period = 2 * std::numbers::pi / frequency_of(tip_mass_root(mu, 0.5, 1.9));
  Scene scene = moving(wire(), 2.2 * period, period / 100);
  scene.solver.method = GetParam();
  scene.gravity.setZero();
  scene.rods[0].disks = {{1, mu * own, 0}};
  add_load(scene, 1, {1e-3, 0, 0}, Vec3::Zero(), true);
  Simulation simulation(scene);
  simulation.start();
  std::vector<double> crossings;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    const double a = simulation.before().rods[0].points.back().position.x(),
                 b = simulation.now().rods[0].points.back().position.x();
    if (a < 0 && b >= 0)
      crossings.push_back(simulation.before().time -
                          a / (b - a) * (simulation.now().time - simulation.before().time));
  }
  ASSERT_GE(crossings.size(), 2U);
  EXPECT_NEAR((crossings[1] - crossings[0]) / period, 1, 2e-3);  // the second mode's share
}

// A stiff wire of next to no mass on a hinge, let go level: 4 K(sin 45°) sqrt(l / g).
TEST_P(Disks, OnALightRodAreAPendulum) {
  Scene scene;
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {0, 0, -9.81};
  scene.rods.push_back(steel_rod(kLength, 4e-3));
  RodSpec& rod = scene.rods[0];
  rod.material->density = 1e-3;
  rod.base.joint = EndJoint::kRevolute;
  rod.base.axis = Vec3::UnitY();
  rod.base.at.X_BF.R = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()).toRotationMatrix();
  rod.disks = {{1, 0.1, 0}};
  const double quarter = std::comp_ellint_1(std::sqrt(0.5)) * std::sqrt(kLength / 9.81);
  scene = moving(scene, quarter, 1e-3);
  scene.simulation.initial_static = false;
  scene.solver.method = GetParam();
  const RodPoint tip = end_of(scene).points.back();
  EXPECT_NEAR(tip.position.x(), 0, 1e-3 * kLength);
  EXPECT_NEAR(tip.velocity.norm() / std::sqrt(2 * 9.81 * kLength), 1, 1e-3);
}

Scene pulled_in_a_fluid(Method method, double step) {
  Scene scene = moving(finely(wire(), method), 0.06, step);
  switch_on(scene, {Effect::kRotaryInertia, Effect::kDamping, Effect::kDrag});
  damp(scene.rods[0], 1e-3);
  scene.rods[0].drag = DragSpec{0.6, 0.05, 900, 1, {}};
  scene.wind = {0.3, -0.8, 0.2};
  for (const double s : {0.25, 0.5, 0.75, 1.})
    scene.rods[0].disks.push_back({s, 0.004, 0.02});
  add_tendon(scene, 0.015, 0.4, 6);
  add_tendon(scene, 0.015, 2.4, 3, 0.5).termination = 0.75;
  add_load(scene, 0.5, {0, 0.3, 0}).to = 1;
  add_load(scene, 1, {0.5, 0, 0}, Vec3::Zero(), true);
  return scene;
}

TEST_P(Disks, WithTendonsInAFluidMoveAlikeByEveryMethod) {
  static const RodPoint reference =
      end_of(pulled_in_a_fluid(Method::kShooting, 2e-3)).points.back();
  const RodPoint tip = end_of(pulled_in_a_fluid(GetParam(), 2e-3)).points.back();
  EXPECT_GT(tip.velocity.norm(), 0.05);
  EXPECT_LT((tip.position - reference.position).norm(), 1e-6 * kLength);
  EXPECT_LT((tip.velocity - reference.velocity).norm(), 1e-4);
}

TEST_P(Disks, WithTendonsInAFluidKeepTheEnergyBalance) {
  const auto balance = [](double step) {
    Scene scene = pulled_in_a_fluid(GetParam(), step);
    scene.solver.scheme = SchemeKind::kGeneralizedAlpha;
    Simulation simulation(scene);
    const Snapshot end = run_to_end(simulation);
    EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    EXPECT_GT(end.energy.dissipated, 0);
    return std::abs(end.energy.balance) / (std::abs(end.energy.work) + end.energy.dissipated);
  };
  const double coarse = balance(1e-3), fine = balance(5e-4);
  EXPECT_LT(fine, 2e-3);
  EXPECT_GT(std::log2(coarse / fine), 1.5) << coarse << " " << fine;
}

TEST_P(Disks, LeaveTheOrderOfTheSchemeAsItIs) {
  const auto tip_after = [](double step) {
    Scene scene = moving(wire(), 0.032, step);
    switch_on(scene, {Effect::kRotaryInertia, Effect::kDamping});
    damp(scene.rods[0], 5e-3);
    scene.solver.method = GetParam();
    scene.solver.scheme = SchemeKind::kEsdirk32;
    scene.rods[0].disks = {{0.5, 0.01, 0.05}, {1, 0.02, 0.05}};
    LoadSpec& push = add_load(scene, 1, {1, 0.5, 0}, {0, 0, 0.02});
    push.has_profile = true;
    ProfileTerm sine;
    sine.shape = ShapeOfTime::kSine;
    sine.amplitude = 1;
    sine.frequency = 10;
    sine.end = 10;
    push.profile.terms.push_back(sine);
    return end_of(scene).points.back().position;
  };
  const Vec3 reference = tip_after(2.5e-4);
  const double coarse = (tip_after(4e-3) - reference).norm(),
               fine = (tip_after(2e-3) - reference).norm();
  EXPECT_GT(std::log2(coarse / fine), 1.8) << coarse << " " << fine;
}

// what `cprsim info` judges rotary inertia by: a uniform rod's I / (A L²), and disks of the rod's
// mass and of a radius R: (r² + R²) / 8 L²
TEST(DisksOfARod, CountInItsRotaryInertia) {
  Scene scene = wire();
  const double L2 = kLength * kLength, r = kRadius, R = 0.03;
  EXPECT_NEAR(Simulation(scene).facts().rods[0].rotary_number, r * r / (4 * L2), 1e-12);
  const double mass = section_properties(scene.rods[0]).rhoA * kLength;
  scene.rods[0].disks = {{0.5, mass / 2, R}, {1, mass / 2, R}};
  EXPECT_NEAR(Simulation(scene).facts().rods[0].rotary_number, (r * r + R * R) / (8 * L2), 1e-12);
}

}  // namespace
}  // namespace cprsim
