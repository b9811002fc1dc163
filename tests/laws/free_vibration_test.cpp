// SPDX-License-Identifier: BSD-3-Clause
// Natural frequencies of a clamped rod from small free vibrations, mode by mode.
#include <gtest/gtest.h>

#include "tests/support/beam_modes.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

// Shape of mode k at s, up to a factor.
double mode_shape(int k, double s) {
  const double b = clamped_free_root(k),
               sigma = (std::cosh(b) + std::cos(b)) / (std::sinh(b) + std::sin(b));
  return std::cosh(b * s) - std::cos(b * s) - sigma * (std::sinh(b * s) - std::sin(b * s));
}

// Forces in proportion to a mode's shape deflect the rod into that mode: inertia and elastic forces
// share the shape.
Scene deflected_into_mode(int k, double period, int forces = 24) {
  Scene scene;
  scene.rods.push_back(steel_rod(0.4, 1e-3));
  scene.solver.points = 24;
  scene.solver.scheme = SchemeKind::kEsdirk43;
  scene.solver.step = period / 40;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 10.5 * period;
  for (int i = 1; i <= forces; ++i) {
    const double s = static_cast<double>(i) / forces, weight = i == forces ? 0.5 : 1;
    add_load(scene, s, {1e-4 * weight * mode_shape(k, s), 0, 0}, Vec3::Zero(), true);
  }
  return scene;
}

// The mode's share in a deflection, by Simpson's rule over the nodes: other modes are orthogonal to
// it.
double modal_coordinate(const RodSample& rod, int k) {
  double sum = 0;
  for (std::size_t i = 0; i < rod.points.size(); ++i) {
    const double weight = i == 0 || i + 1 == rod.points.size() ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * rod.points[i].position.x() * mode_shape(k, rod.points[i].s);
  }
  return sum;
}

// Mean period between upward zero crossings of the mode.
double measured_period(const Scene& scene, int k) {
  Simulation simulation(scene);
  simulation.start();
  std::vector<double> crossings;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    const double a = modal_coordinate(simulation.before().rods[0], k);
    const double b = modal_coordinate(simulation.now().rods[0], k);
    if (a < 0 && b >= 0)
      crossings.push_back(simulation.before().time -
                          a / (b - a) * (simulation.now().time - simulation.before().time));
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  if (crossings.size() < 2) return 0;
  return (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
}

class FreeVibration : public ::testing::TestWithParam<int> {};

TEST_P(FreeVibration, HasTheFrequencyOfTheBeam) {
  RodSpec rod = steel_rod(0.4, 1e-3);
  const double rhoA = section_properties(rod).rhoA;
  const double omega = clamped_free_frequency(GetParam(), bending_stiffness(rod), rhoA, 0.4);
  const double period = 2 * std::numbers::pi / omega;
  const double measured = measured_period(deflected_into_mode(GetParam(), period), GetParam());
  ASSERT_GT(measured, 0);
  EXPECT_NEAR(measured / period, 1, 1e-3);  // interpolated crossings: a few 1e-5
}

class DampedVibration : public ::testing::TestWithParam<Method> {};

// Kelvin-Voigt damping of the time constant tau takes zeta = omega tau / 2 of a mode: from one
// upper turning point to the next its logarithm falls by 2 pi zeta / sqrt(1 - zeta^2).
TEST_P(DampedVibration, HasTheLogarithmicDecrementOfTheBeam) {
  const RodSpec rod = steel_rod(0.4, 1e-3);
  const double omega = clamped_free_frequency(1, bending_stiffness(rod),
                                              section_properties(rod).rhoA, 0.4),
               period = 2 * std::numbers::pi / omega, zeta = 0.03;
  Scene scene = deflected_into_mode(1, period, 8);
  scene.solver.method = GetParam();
  scene.solver.points = 8;
  scene.solver.elements = 8;
  scene.solver.order = 3;
  scene.solver.degree = 5;
  switch_on(scene, {Effect::kDamping});
  damp(scene.rods[0], 2 * zeta / omega);
  scene.solver.step = period / 80;
  scene.simulation.duration = 5.5 * period;
  Simulation simulation(scene);
  simulation.start();
  std::vector<double> peaks, last;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    last.push_back(simulation.now().rods[0].points.back().position.x());
    if (last.size() < 3) continue;
    if (last.size() > 3) last.erase(last.begin());
    // of the parabola through three
    if (last[1] > last[0] && last[1] >= last[2])
      peaks.push_back(last[1] -
                      std::pow(last[2] - last[0], 2) / (8 * (last[2] - 2 * last[1] + last[0])));
  }
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  ASSERT_GE(peaks.size(), 5U);
  // the first swing still has a little of higher modes
  const double decrement =
      std::log(peaks[1] / peaks.back()) / static_cast<double>(peaks.size() - 2);
  EXPECT_NEAR(decrement / (2 * std::numbers::pi * zeta / std::sqrt(1 - zeta * zeta)), 1, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Every, DampedVibration, ::testing::ValuesIn(kEveryMethod), test_name);

INSTANTIATE_TEST_SUITE_P(FirstThreeModes, FreeVibration, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace cprsim
