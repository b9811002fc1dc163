// SPDX-License-Identifier: BSD-3-Clause
// Rods that are heated, by every method: elongation, forces between clamps, buckling, bending by a
// gradient, motion and energy, against closed forms.
#include <gtest/gtest.h>

#include "engine/study/stability.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 1e-3, kAlpha = 1.2e-5;
constexpr double kPi = std::numbers::pi;

/// A clamped steel wire, warmer by `rise` and along its section by `gradient`.
Scene warm_wire(double rise, const Vec2& gradient = Vec2::Zero()) {
  Scene scene;
  RodSpec rod = steel_rod(kLength, kRadius);
  rod.material->thermal_expansion = kAlpha;
  rod.temperature.emplace();
  rod.temperature->rise = rise;
  rod.temperature->gradient = gradient;
  scene.rods.push_back(rod);
  switch_on(scene, {Effect::kThermal, Effect::kExtension});
  return scene;
}

/// Its tip clamped, too.
Scene between_clamps(Scene scene) {
  scene.rods[0].tip.joint = EndJoint::kFixed;
  scene.rods[0].tip.at.X_BF.p = {0, 0, kLength};
  return scene;
}

double axial_stiffness() {
  return steel_rod(kLength, kRadius).material->youngs_modulus * kPi * kRadius * kRadius;
}

void warm_up(Scene& scene, double duration) {
  ProfileTerm term;
  term.shape = ShapeOfTime::kSmoothstep;
  term.to = 1;
  term.end = duration;
  scene.rods[0].temperature->has_profile = true;
  scene.rods[0].temperature->profile.terms.push_back(term);
}

Scene in_motion(Scene scene, double step, double duration) {
  scene.solver.scheme = SchemeKind::kEsdirk43;
  scene.solver.step = step;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = duration;
  return scene;
}

class Heat : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, Heat, ::testing::ValuesIn(kEveryMethod), test_name);

TEST_P(Heat, MakesAFreeBarLonger) {
  const Equilibrium warm(finely(warm_wire(80), GetParam()));
  ASSERT_TRUE(warm.report.converged());
  const RodPoint tip = warm.rod().points.back();
  EXPECT_NEAR(tip.position.z(), kLength * (1 + 80 * kAlpha), 1e-14);
  EXPECT_LT(warm.rod().points.front().force.norm(), 1e-9);
  EXPECT_NEAR(warm.robot.rods[0].model->energy().elastic, 0, 1e-18);
}

TEST_P(Heat, PressesABarBetweenClamps) {
  const Equilibrium warm(finely(between_clamps(warm_wire(-80)), GetParam()));
  ASSERT_TRUE(warm.report.converged());
  const double force = 80 * kAlpha * axial_stiffness();
  EXPECT_NEAR(warm.rod().points.front().force.z() / force, 1, 1e-9);
  EXPECT_NEAR(warm.robot.rods[0].model->energy().elastic / (0.5 * force * 80 * kAlpha * kLength), 1,
              1e-9);
}

// E A alpha dT = 4 pi² E I / L²
TEST_P(Heat, BucklesABarBetweenClamps) {
  const double exact = 4 * kPi * kPi * bending_stiffness(steel_rod(kLength, kRadius)) /
                       (kLength * kLength * kAlpha * axial_stiffness());
  const auto verdict = [&](double rise) {
    StaticStudy study(finely(between_clamps(warm_wire(rise)), GetParam()));
    EXPECT_TRUE(study.solve().converged());
    return judge(study).verdict;
  };
  EXPECT_EQ(verdict((1 - 1e-4) * exact), StabilityVerdict::kStable);
  EXPECT_EQ(verdict((1 + 1e-4) * exact), StabilityVerdict::kUnstable);
}

// a section at T(x, y) = g·(x, y) has the curvature alpha (g_y, -g_x); the warm side is outside
TEST_P(Heat, OnOneSideBendsACircle) {
  const Vec2 gradient(2e5, 1e5);
  const Equilibrium warm(finely(warm_wire(50, gradient), GetParam()));
  ASSERT_TRUE(warm.report.converged());
  const double kappa = kAlpha * gradient.norm(), stretch = 1 + 50 * kAlpha;
  const Vec2 towards = -gradient.normalized();
  for (const RodPoint& point : warm.rod().points) {
    const double s = point.s * kLength, aside = stretch * (1 - std::cos(kappa * s)) / kappa;
    const Vec3 exact(aside * towards.x(), aside * towards.y(),
                     stretch * std::sin(kappa * s) / kappa);
    EXPECT_LT((point.position - exact).norm(), 1e-10) << point.s;
    EXPECT_LT((point.curvature - kAlpha * Vec3(gradient.y(), -gradient.x(), 0)).norm(), 1e-8);
    EXPECT_LT((point.curvature - point.rest_curvature).norm(), 1e-8);
    EXPECT_LT(point.moment.norm(), 1e-8);
  }
}

// to the rest shape that a rod has it adds another
TEST_P(Heat, AddsToARestShape) {
  Scene warm = warm_wire(0, {3e5, -1e5}), bent = warm_wire(0);
  warm.rods[0].rest_curvature = {1, 2, 4};
  bent.rods[0].rest_curvature = Vec3(1, 2, 4) + kAlpha * Vec3(-1e5, -3e5, 0);
  for (Scene* scene : {&warm, &bent}) {
    switch_on(*scene, {Effect::kGravity});
    scene->gravity = {3, 4, -5};
  }
  const Equilibrium a(finely(warm, GetParam())), b(finely(bent, GetParam()));
  ASSERT_TRUE(a.report.converged() && b.report.converged());
  const RodSample one = a.rod(), other = b.rod();
  for (std::size_t k = 0; k < one.points.size(); ++k)
    EXPECT_LT((one.points[k].position - other.points[k].position).norm(), 1e-12) << k;
  // likewise where sections vary
  for (Scene* scene : {&warm, &bent}) {
    SectionSpec tip = scene->rods[0].section;
    tip.s = 1;
    tip.size *= 0.6;
    scene->rods[0].sections = {scene->rods[0].section, tip};
  }
  const Equilibrium c(finely(warm, GetParam())), d(finely(bent, GetParam()));
  ASSERT_TRUE(c.report.converged() && d.report.converged());
  EXPECT_LT((c.rod().points.back().position - d.rod().points.back().position).norm(), 1e-12);
}

// Slowly heated a rod goes through equilibria; what heat does, the rod holds and damping takes.
TEST_P(Heat, MovesARodSlowly) {
  Scene scene = finely(warm_wire(60, {2e5, 0}), GetParam());
  if (GetParam() == Method::kShooting) scene.solver.points = 10;
  if (GetParam() == Method::kCollocation) scene.solver.elements = 8;
  damp(scene.rods[0], 1e-2);
  switch_on(scene, {Effect::kDamping, Effect::kGravity});
  scene.gravity = {-9.81, 0, 0};
  const Vec3 still = Equilibrium(scene).rod().points.back().position;
  warm_up(scene, 1);
  Simulation simulation(in_motion(scene, 5e-3, 2));
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_GT(std::abs(still.x()), 0.02);
  EXPECT_LT((end.rods[0].points.back().position - still).norm(), 2e-6 * kLength);
  EXPECT_GT(std::abs(end.energy.work), 1e-4);
  EXPECT_LT(std::abs(end.energy.balance), 2e-3 * std::abs(end.energy.work));
}

// Heated at once, a bar that is held by its base alone shakes; every method says how, and for how
// much energy.
TEST_P(Heat, AtOnceShakesABar) {
  Scene scene = finely(warm_wire(100, {1e5, 0}), GetParam());
  if (GetParam() == Method::kShooting) scene.solver.points = 10;
  damp(scene.rods[0], 1e-4);
  switch_on(scene, {Effect::kDamping});
  ProfileTerm step;
  step.shape = ShapeOfTime::kStep;
  step.to = 1;
  step.start = 1e-3;
  scene.rods[0].temperature->has_profile = true;
  scene.rods[0].temperature->profile.terms.push_back(step);
  scene = in_motion(scene, 1e-5, 3e-3);
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  const double stretch = 100 * kAlpha, bend = kAlpha * 1e5,
               given = 0.5 * kLength *
                       (axial_stiffness() * stretch * stretch +
                        bending_stiffness(scene.rods[0]) * bend * bend);
  EXPECT_NEAR(end.energy.work / given, 1, 1e-9);
  EXPECT_GT(end.energy.dissipated, 0.05 * given);
  EXPECT_LT(std::abs(end.energy.balance), 1e-3 * given);
  Scene twin = scene;
  twin = finely(twin, GetParam() == Method::kStrain ? Method::kShooting : Method::kStrain);
  if (GetParam() == Method::kStrain) twin.solver.points = 10;
  Simulation other(twin);
  EXPECT_LT((run_to_end(other).rods[0].points.back().position - end.rods[0].points.back().position)
                .norm(),
            1e-6 * kLength);
}

TEST_P(Heat, IsWorkWhereNothingMoves) {
  Scene scene = between_clamps(finely(warm_wire(20), GetParam()));
  warm_up(scene, 1);
  scene.simulation.mode = Mode::kQuasistatic;
  scene.simulation.duration = 1;
  scene.solver.step = 0.1;
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  const double strain = 20 * kAlpha, exact = 0.5 * axial_stiffness() * strain * strain * kLength;
  EXPECT_NEAR(end.energy.elastic / exact, 1, 1e-9);
  EXPECT_NEAR(end.energy.work / exact, 1, 1e-9);
}

TEST_P(Heat, InAPlaneIsTheSame) {
  Scene scene = finely(warm_wire(90), GetParam());
  damp(scene.rods[0], 1e-3);
  switch_on(scene, {Effect::kDamping, Effect::kGravity, Effect::kShear});
  scene.gravity = {9.81, 0, -3};
  warm_up(scene, 0.02);
  scene = in_motion(scene, 1e-3, 0.03);
  Simulation space(scene);
  scene.planar_normal = Vec3(0, 1, 0);
  Simulation plane(scene);
  const Snapshot a = run_to_end(space), b = run_to_end(plane);
  ASSERT_EQ(plane.status(), RunStatus::kDone) << plane.failure();
  EXPECT_LT((a.rods[0].points.back().position - b.rods[0].points.back().position).norm(),
            1e-9 * kLength);
  EXPECT_NEAR(a.energy.work, b.energy.work, 1e-6 * std::abs(a.energy.work));
}

// Fed through the base, a warm rod brings its stretch along.
TEST_P(Heat, IsFedWithTheRod) {
  Scene scene = finely(warm_wire(100), GetParam());
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {2, 0, -1};
  DriveSpec drive;
  drive.quantity = DriveQuantity::kLength;
  drive.rod = 0;
  ProfileTerm term;
  term.shape = ShapeOfTime::kSmoothstep;
  term.from = 0.3;
  term.to = 0.4;
  term.end = 1;
  drive.profile.terms.push_back(term);
  scene.drives.push_back(drive);
  scene.simulation.mode = Mode::kQuasistatic;
  scene.simulation.duration = 1;
  scene.solver.step = 0.01;
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  Scene still = scene;
  still.drives.clear();
  EXPECT_LT(
      (end.rods[0].points.back().position - Equilibrium(still).rod().points.back().position).norm(),
      1e-9 * kLength);
  EXPECT_LT(std::abs(end.energy.balance), 1e-3 * std::abs(end.energy.work));
}

TEST(Heating, IsAskedFor) {
  Scene scene = warm_wire(100);
  scene.rods[0].without = {"thermal"};
  EXPECT_NEAR(Equilibrium(scene).rod().points.back().position.z(), kLength, 1e-15);
  scene.rods[0].without.clear();
  EXPECT_GT(Equilibrium(scene).rod().points.back().position.z(), kLength * 1.001);
  scene.effects.set(Effect::kThermal, false);
  EXPECT_NEAR(Equilibrium(scene).rod().points.back().position.z(), kLength, 1e-15);
}

}  // namespace
}  // namespace cprsim
