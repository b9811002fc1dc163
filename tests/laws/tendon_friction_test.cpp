// SPDX-License-Identifier: BSD-3-Clause
// Tendons that rub along their channels: against the law of belts, against a rod whose equations
// are integrated by a program of its own, pulled in, held and let go.
#include <gtest/gtest.h>

#include "tests/support/end_of.h"
#include "tests/support/methods.h"
#include "tests/support/tendon_reference.h"
#include "tests/support/tendons.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.5, kRadius = 1e-3, kOffset = 0.01506, kMu = 0.3;

Scene rubbing_rod() {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, kRadius));
  scene.gravity.setZero();
  switch_on(scene, {Effect::kTendonFriction});
  return scene;
}

TendonSpec& add_rubbing(Scene& scene, double radius, double angle, double tension,
                        double turns = 0) {
  TendonSpec& tendon = add_tendon(scene, radius, angle, tension, turns);
  tendon.friction = kMu;
  return tendon;
}

Vec3 tip_of(const Snapshot& now) {
  return now.rods[0].points.back().position;
}

Vec3 tip_of(const Equilibrium& equilibrium) {
  return equilibrium.rod().points.back().position;
}

TendonSample tendon_of(const Equilibrium& equilibrium, std::size_t k = 0) {
  return equilibrium.robot.rods[0].model->tendons()[k];
}

class TendonFrictionLaw : public ::testing::TestWithParam<Method> {};

// Around an arc that is there without it a tendon loses what a belt loses around a pulley.
TEST_P(TendonFrictionLaw, IsThatOfABeltAroundAnArc) {
  Scene scene = finely(rubbing_rod(), GetParam());
  const double turn = 2, T = 1e-6;
  scene.rods[0].rest_curvature = {0, turn / kLength, 0};
  add_rubbing(scene, kOffset, 0, T);
  add_rubbing(scene, kOffset, std::numbers::pi / 2, T).termination = 0.4;
  const Equilibrium equilibrium(scene, 1e-12);
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  EXPECT_NEAR(tendon_of(equilibrium).end_tension / T, std::exp(-kMu * turn), 1e-6);
  EXPECT_NEAR(tendon_of(equilibrium, 1).end_tension / T, std::exp(-kMu * 0.4 * turn), 1e-6);
  EXPECT_EQ(tendon_of(equilibrium).tension, T);
}

// A parallel tendon bends a straight rod by tau r / EI and loses mu tau theta_s: with a = mu T r /
// EI the angle is log(1 + a s) / mu and the rod a logarithmic spiral.
TEST_P(TendonFrictionLaw, BendsARodIntoALogarithmicSpiral) {
  Scene scene = finely(rubbing_rod(), GetParam());
  const double EI = bending_stiffness(scene.rods[0]), T = 25, a = kMu * T * kOffset / EI;
  add_rubbing(scene, kOffset, 0, T);
  const Equilibrium equilibrium(scene, 1e-13);
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  EXPECT_LE(equilibrium.report.iterations, 12);
  for (const RodPoint& point : equilibrium.rod().points) {
    const double w = 1 + a * point.s * kLength, angle = std::log(w) / kMu,
                 unit = a * (1 + 1 / (kMu * kMu));
    const Vec3 expected((w * (std::sin(angle) - std::cos(angle) / kMu) + 1 / kMu) / unit, 0,
                        (w * (std::cos(angle) + std::sin(angle) / kMu) - 1) / unit);
    EXPECT_LT((point.position - expected).norm(), 1e-7 * kLength) << "at s = " << point.s;
  }
  const double end = std::log(1 + a * kLength) / kMu;
  ASSERT_GT(end, 1);
  EXPECT_NEAR(tendon_of(equilibrium).end_tension, T * std::exp(-kMu * end), 1e-6 * T);
  EXPECT_NEAR(tendon_of(equilibrium).displacement, end * kOffset, 1e-7 * kLength);
}

Vec3 bent_tip(Method method, int fineness, double force) {
  Scene scene = rubbing_rod();
  scene.solver.method = method;
  scene.solver.points = 3 * fineness;
  scene.solver.elements = fineness;
  scene.solver.order = 4;
  scene.solver.degree = 4;
  switch_on(scene, {Effect::kExtension, Effect::kShear});
  add_load(scene, 1, {-force, 0, 0});
  add_rubbing(scene, kOffset, 0, 25);
  const Equilibrium equilibrium(scene, 1e-12);
  EXPECT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  return tip_of(equilibrium);
}

// What a coarse rod errs by falls with the second power of its pieces or faster where the turning
// is smooth, with the first where it passes through zero, as the second force makes it.
TEST_P(TendonFrictionLaw, ConvergesAsRodsAreCutMoreFinely) {
  for (const double force : {0.5, 1.2}) {
    const Vec3 exact = bent_tip(GetParam(), 40, force);
    const double coarse = (bent_tip(GetParam(), 2, force) - exact).norm(),
                 fine = (bent_tip(GetParam(), 12, force) - exact).norm();
    std::printf("force %g N: %.1e, %.1e m\n", force, coarse, fine);
    EXPECT_LT(fine, 2e-4 * kLength) << force;
    EXPECT_GT(std::log(coarse / fine) / std::log(6), force < 1 ? 1.8 : 0.9) << force;
  }
}

// The rod of tendon_test, with friction. The reference begins at the tip with what is left of the
// tensions; those at the base are what its motors pull with.
TEST_P(TendonFrictionLaw, AgreesWithTheEquationsOfRuckerAndWebster) {
  Scene scene = finely(rubbing_rod(), GetParam());
  if (GetParam() == Method::kStrain) scene.solver.order = 12;
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear});
  const SectionProperties section = section_properties(scene.rods[0]);
  PulledReferenceRod reference{kLength, section.K_bt, section.K_se, {}, {}, {}};
  reference.tendons = {
      {kOffset, 0.3, 0, 12, kMu}, {kOffset, 1.7, 1.2, 10, kMu}, {0.01, -2, -0.7, 25, 0}};
  const Vec3 gravity(4, -6, -7);
  reference.load = section.rhoA * gravity;
  reference.force = {0.3, 0.5, -0.4};
  const ReferenceBase base = solve_tendon_rod(reference, 4000);
  ASSERT_LT((solve_tendon_rod(reference, 2000).X_TB.p - base.X_TB.p).norm(), 2e-10);
  ASSERT_GT(base.tensions[0] / reference.tendons[0].tension, 1.2);

  const Mat3 R_BT = base.X_TB.R.transpose();
  scene.gravity = R_BT * gravity;
  for (std::size_t k = 0; k < 3; ++k) {
    const ReferenceTendon& tendon = reference.tendons[k];
    add_tendon(scene, tendon.radius, tendon.angle, base.tensions[static_cast<Eigen::Index>(k)],
               tendon.turns)
        .friction = tendon.mu;
  }
  add_load(scene, 1, R_BT * reference.force);
  const Equilibrium equilibrium(scene, 1e-12);
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  EXPECT_LT((tip_of(equilibrium) + R_BT * base.X_TB.p).norm(), 1e-5 * kLength);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(tendon_of(equilibrium, k).end_tension / reference.tendons[k].tension, 1, 2e-4);
}

// A bend of its way turns a tendon at once.
TEST_P(TendonFrictionLaw, TakesItsShareAtBends) {
  Scene scene = finely(rubbing_rod(), GetParam());
  TendonSpec& tendon = add_rubbing(scene, 0, 0, 1e-6);
  tendon.route = TendonRoute::kPoints;
  tendon.points = {{0, 0.02, 0}, {0.3, 0.02, 0.1}, {1, 0.02, 0.1}};
  const Equilibrium equilibrium(scene, 1e-12);
  ASSERT_TRUE(equilibrium.report.converged());
  const double bend = std::atan(0.1 / (0.3 * kLength));
  EXPECT_NEAR(tendon_of(equilibrium).end_tension / 1e-6, std::exp(-kMu * bend), 1e-6);
}

// As without friction: what a tension displaces, that displacement needs.
TEST_P(TendonFrictionLaw, HoldsWhereTheTensionIsFound) {
  for (const bool planar : {false, true}) {
    Scene given = finely(rubbing_rod(), GetParam());
    switch_on(given, {Effect::kGravity, Effect::kExtension});
    given.gravity = {3, 0, -9};
    if (planar) given.planar_normal = Vec3::UnitY();
    add_rubbing(given, kOffset, 0, 18);
    Scene asked = given;
    const Equilibrium equilibrium(given, 1e-13);
    displace(asked, tendon_of(equilibrium).displacement);
    const Equilibrium again(asked, 1e-13);
    ASSERT_TRUE(again.report.converged()) << again.report.worst_row;
    EXPECT_LT((tip_of(again) - tip_of(equilibrium)).norm(), 1e-9 * kLength);
    EXPECT_NEAR(tendon_of(again).tension, 18, 1e-7);
    EXPECT_NEAR(tendon_of(again).end_tension, tendon_of(equilibrium).end_tension, 1e-7);
    EXPECT_LT(tendon_of(again).end_tension, 15);
  }
}

/// From one tension to the next, in even steps of quasi-statics.
Scene pulled(Method method, const std::vector<double>& tensions, int steps) {
  Scene scene = finely(rubbing_rod(), method);
  add_rubbing(scene, kOffset, 0, 0);
  ProfileTerm& pull = scene.drives[0].profile.terms[0];
  pull.shape = ShapeOfTime::kKeyframes;
  for (std::size_t k = 0; k < tensions.size(); ++k) {
    pull.times.push_back(double(k));
    pull.values.push_back(tensions[k]);
  }
  finish_keyframes(pull);
  scene.simulation.mode = Mode::kQuasistatic;
  scene.simulation.duration = double(tensions.size()) - 1;
  scene.solver.step = 1. / steps;
  scene.solver.tolerance = 1e-11;
  return scene;
}

// From T_0 to T_1 < T_0 it slips back as far as s_1 = (T_0 - T_1) / 2 a T_1, a = mu T_0 r / EI:
// from the motor on the tension rises as T_1 / (1 - a T_1 / T_0 s). Beyond it sticks, and stays
// bent.
TEST_P(TendonFrictionLaw, SticksBeyondWhereATendonSlipsBack) {
  const double EI = bending_stiffness(rubbing_rod().rods[0]), T0 = 25, T1 = 20,
               a = kMu * T0 * kOffset / EI, s1 = (T0 - T1) / (2 * a * T1), b = a * T1 / T0;
  ASSERT_LT(s1, 0.8 * kLength);
  ASSERT_GT(s1, 0.2 * kLength);
  const Snapshot held = end_of(pulled(GetParam(), {0, T0}, 10)),
                 back = end_of(pulled(GetParam(), {0, T0, T1}, 20));
  const double stuck = T0 / (1 + a * kLength);
  EXPECT_NEAR(held.tendons[0].end_tension, stuck, 1e-4 * T0);
  EXPECT_NEAR(back.tendons[0].end_tension, stuck, 0.02 * T0);
  const double turned =
      -std::log(1 - b * s1) / kMu + (std::log(1 + a * kLength) - std::log(1 + a * s1)) / kMu;
  EXPECT_NEAR(back.tendons[0].displacement / (turned * kOffset), 1, 5e-3);
  // without friction much more of it would have come back
  EXPECT_GT(back.tendons[0].displacement / held.tendons[0].displacement, 0.9);
}

// Pulled in and out again and again: what the motors have put in more than the rod gives back is
// what friction has taken. It gives nothing but the little that a tendon holds while it sticks.
TEST_P(TendonFrictionLaw, TakesEnergyWhicheverWayATendonSlips) {
  Scene scene = pulled(GetParam(), {0, 25, 10, 25, 5}, 40);
  Simulation simulation(scene);
  simulation.start();
  double last = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    const EnergySample& energy = simulation.now().energy;
    EXPECT_GT(energy.dissipated, last - 5e-4 * energy.work);
    last = std::max(last, energy.dissipated);
  }
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  const EnergySample energy = simulation.now().energy;
  EXPECT_GT(energy.dissipated, 0.2 * energy.work);
  EXPECT_LT(std::abs(energy.balance), 2e-3 * energy.work);
}

// In motion: pulled in by a smooth step and left alone, a damped rod comes to rest where statics
// puts it, but for what it has swung beyond it and sticks there.
TEST_P(TendonFrictionLaw, ComesToRestInMotion) {
  Scene still = rubbing_rod();
  still.solver.method = GetParam();
  switch_on(still, {Effect::kExtension, Effect::kShear, Effect::kDamping});
  damp(still.rods[0], 5e-3);
  add_rubbing(still, kOffset, 0.4, 15, 0.3);
  const Equilibrium equilibrium(still, 1e-11);
  Scene moving = still;
  ProfileTerm& pull = moving.drives[0].profile.terms[0];
  pull.shape = ShapeOfTime::kSmoothstep;
  pull.to = 15;
  pull.end = 0.6;
  moving.simulation.mode = Mode::kDynamic;
  moving.simulation.duration = 1;
  moving.solver.scheme = SchemeKind::kGeneralizedAlpha;
  moving.solver.step = 5e-3;
  const Snapshot end = end_of(moving);
  EXPECT_LT((tip_of(end) - tip_of(equilibrium)).norm(), 2e-3 * kLength);
  EXPECT_NEAR(end.tendons[0].end_tension, tendon_of(equilibrium).end_tension, 0.03 * 15);
  EXPECT_GT(end.energy.dissipated, 0);
  EXPECT_LT(std::abs(end.energy.balance), 1e-3 * end.energy.work);
}

// A coefficient is nothing without the effect, and the effect nothing without a coefficient.
TEST_P(TendonFrictionLaw, IsAbsentUnlessListed) {
  Scene scene = finely(rubbing_rod(), GetParam());
  add_tendon(scene, kOffset, 0.3, 15, 0.4);
  const Equilibrium without(scene, 1e-12);
  scene.tendons[0].friction = kMu;
  scene.effects.set(Effect::kTendonFriction, false);
  const Equilibrium unlisted(scene, 1e-12);
  EXPECT_EQ(tip_of(without), tip_of(unlisted));
  EXPECT_EQ(without.robot.rods[0].model->unknown_count(),
            unlisted.robot.rods[0].model->unknown_count());
}

INSTANTIATE_TEST_SUITE_P(Every, TendonFrictionLaw, ::testing::ValuesIn(kEveryMethod), test_name);

}  // namespace
}  // namespace cprsim
