// SPDX-License-Identifier: BSD-3-Clause
// A rod on an elastic foundation: closed forms of Hetényi (Beams on Elastic Foundation, 1946) for
// the deflection and the buckling load, a frequency, and energy; by every method.
#include <gtest/gtest.h>

#include "engine/study/modes.h"
#include "engine/study/stability.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 1e-3, kPi = std::numbers::pi;

/// Springs of the stiffness k per length that hold rod 0 in the plane x = 0.
LoadSpec& lay_on_springs(Scene& scene, double k) {
  LoadSpec& load = add_load(scene, 0, Vec3::Zero());
  load.to = 1;
  load.law = 0;
  load.law_values = {k, 0, 0, 0, 1, 0, 0};
  return load;
}

Scene clamped_wire() {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, kRadius));
  return scene;
}

class Foundation : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, Foundation, ::testing::ValuesIn(kEveryMethod), test_name);

// with a^4 = k / 4 EI: w(L) = 2 P a / k (sinh cosh - sin cos) / (cosh² + cos²) of a L
TEST_P(Foundation, HoldsACantilever) {
  Scene scene = clamped_wire();
  const double k = 800, P = 1e-3, a = std::pow(k / (4 * bending_stiffness(scene.rods[0])), 0.25),
               x = a * kLength;
  ASSERT_GT(x, 2);  // the springs, not the clamp
  add_load(scene, 1, {P, 0, 0});
  lay_on_springs(scene, k);
  const Equilibrium bent(finely(scene, GetParam()), 1e-13);
  ASSERT_TRUE(bent.report.converged()) << bent.report.worst_row;
  const double exact = 2 * P * a / k * (std::sinh(x) * std::cosh(x) - std::sin(x) * std::cos(x)) /
                       (std::pow(std::cosh(x), 2) + std::pow(std::cos(x), 2));
  EXPECT_NEAR(bent.rod().points.back().position.x() / exact, 1, 1e-6);
}

// between pins, with m half waves: P = EI (m pi / L)² + k (L / m pi)²; across the springs EI
// (pi/L)²
TEST_P(Foundation, KeepsAColumnFromBuckling) {
  const double EI = bending_stiffness(steel_rod(kLength, kRadius)), q = kPi / kLength,
               k = 2 * EI * std::pow(q, 4), exact = EI * q * q + k / (q * q);
  const auto verdict = [&](double force) {
    Scene scene = column(kLength, kRadius, EndJoint::kRevolute, EndJoint::kRevolute, force);
    for (RodEndSpec* end : {&scene.rods[0].base, &scene.rods[0].tip})
      end->axis = Vec3::UnitY();
    lay_on_springs(scene, k);
    StaticStudy study(finely(scene, GetParam()));
    EXPECT_TRUE(study.solve().converged());
    return judge(study).verdict;
  };
  EXPECT_EQ(verdict((1 - 1e-5) * exact), StabilityVerdict::kStable);
  EXPECT_EQ(verdict((1 + 1e-5) * exact), StabilityVerdict::kUnstable);
}

// a mode of bending towards the springs: omega² = omega_0² + k / rhoA
TEST_P(Foundation, RaisesFrequencies) {
  const SectionProperties section = section_properties(steel_rod(kLength, kRadius));
  const double k = 500;
  const auto modes = [&](double stiffness) {
    Scene scene = clamped_wire();
    if (stiffness > 0) lay_on_springs(scene, stiffness);
    StaticStudy study(finely(scene, GetParam()));
    EXPECT_TRUE(study.solve().converged());
    return natural_modes(study, 2);
  };
  const auto squared = [](const auto& mode) { return std::pow(2 * kPi * mode.frequency(), 2); };
  const auto bare = modes(0), held = modes(k);
  EXPECT_NEAR(squared(held[0]) / squared(bare[0]), 1, 1e-8);  // along the plane
  EXPECT_NEAR(squared(held[1]) / (squared(bare[1]) + k / section.rhoA), 1, 1e-8);
}

// springs that come and go do work; it is what the rod has
TEST_P(Foundation, BalancesEnergyOfAMotion) {
  Scene scene = clamped_wire();
  switch_on(scene, {Effect::kExtension});
  add_load(scene, 1, {2, 1, 0}, Vec3::Zero(), true);
  LoadSpec& springs = lay_on_springs(scene, 300);
  ProfileTerm sine;
  sine.shape = ShapeOfTime::kSine;
  sine.amplitude = 1;
  sine.frequency = 30;
  sine.end = HUGE_VAL;
  springs.has_profile = true;
  springs.profile.terms.push_back(sine);
  scene.simulation.initial_static = true;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.duration = 0.03;
  scene.solver.scheme = SchemeKind::kEsdirk43;
  scene.solver.step = 0.0003;
  Simulation simulation(finely(scene, GetParam()));
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_GT(std::abs(end.energy.work), 0.01 * end.energy.total);
  EXPECT_LT(std::abs(end.energy.balance), 1e-3 * std::abs(end.energy.work));
  std::printf("balance %.2e of %.2e J of work\n", end.energy.balance, end.energy.work);
}

}  // namespace
}  // namespace cprsim
