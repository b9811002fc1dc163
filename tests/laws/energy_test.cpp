// SPDX-License-Identifier: BSD-3-Clause
// Energy: the balance closes with the order of the scheme, an undamped swing loses what the scheme
// takes and no more.
#include <gtest/gtest.h>

#include "tests/support/beam_modes.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

Scene swinging_rod(SchemeKind scheme, double step, double duration) {
  Scene scene;
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {0, 0, -9.81};
  scene.rods.push_back(steel_rod(0.4, 1e-3));
  add_load(scene, 1, {-0.05, 0, 0}, Vec3::Zero(), true);
  scene.solver.points = 6;
  scene.solver.scheme = scheme;
  scene.solver.step = step;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = duration;
  return scene;
}

TEST(EnergyBalance, ClosesWithTheOrderOfTheSchemeWhenEverythingActs) {
  auto balance = [](double step) {
    Scene scene = swinging_rod(SchemeKind::kGeneralizedAlpha, step, 0.2);
    switch_on(scene,
              {Effect::kDamping, Effect::kExtension, Effect::kShear, Effect::kRotaryInertia});
    damp(scene.rods[0], 1e-3);
    LoadSpec& push = add_load(scene, 0.5, {0.3, 0.2, 0});
    push.has_profile = true;
    ProfileTerm sine;
    sine.shape = ShapeOfTime::kSine;
    sine.amplitude = 1;
    sine.frequency = 5;
    sine.end = 10;
    push.profile.terms.push_back(sine);
    Simulation simulation(scene);
    const Snapshot end = run_to_end(simulation);
    EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    EXPECT_GT(end.energy.work, 0);
    EXPECT_GT(end.energy.dissipated, 0);
    return std::abs(end.energy.balance) / (end.energy.work + end.energy.dissipated);
  };
  const double coarse = balance(1e-3), fine = balance(5e-4);
  EXPECT_LT(fine, 1e-3);
  EXPECT_GT(std::log2(coarse / fine), 1.7);
}

// What the scheme takes from a linear oscillator of frequency omega in `steps` steps, as the
// logarithm of the energy.
double predicted_decay(SchemeKind scheme, double omega, double h, long steps) {
  Stepper stepper({scheme, -0.4, 0.8});
  Track track;
  track.resize(1);
  track.set_start(VecX::Constant(1, 1), VecX::Zero(1));
  const std::vector<Track*> tracks{&track};
  stepper.reset();
  double first = 0;
  auto energy = [&] {
    return 0.5 * (track.v[0] * track.v[0] + omega * omega * track.x[0] * track.x[0]);
  };
  for (long k = 0; k < steps; ++k) {
    const int stages = stepper.begin_step(h, tracks);
    for (int i = 0; i < stages; ++i) {
      const StageRates rates = stepper.begin_stage(i, tracks);
      // c_w (c_v x + x_h) + v_h + omega² x = 0
      track.x[0] =
          -(rates.c_w * track.x_h[0] + track.v_h[0]) / (rates.c_w * rates.c_v + omega * omega);
      stepper.finish_stage(i, tracks);
    }
    stepper.accept(tracks);
    if (k == 0) first = energy();
  }
  return std::log(first / energy());
}

// Half an hour of undamped swinging in the first mode, 15,700 periods of 20 steps: what is left of
// the energy is what the scheme leaves of a linear oscillator's, so nothing else gains or loses
// any.
TEST(UndampedSwing, LosesInHalfAnHourWhatTheSchemeTakesAndNoMore) {
  constexpr double kDuration = 1800;
  RodSpec rod = steel_rod(0.4, 1e-3);
  const double omega =
      clamped_free_frequency(1, bending_stiffness(rod), section_properties(rod).rhoA, 0.4);
  const double h = 2 * std::numbers::pi / omega / 20;
  Scene scene = swinging_rod(SchemeKind::kGeneralizedAlpha, h, kDuration);
  scene.effects.set(Effect::kGravity, false);
  scene.solver.points = 3;
  scene.solver.residual_tolerance = 1e-10;
  scene.loads.clear();
  // forces in the shape of the first mode, weighted so that they do no work on the others
  for (int i = 1; i <= 6; ++i) {
    const double s = i / 6.0, weight = i == 6 ? 0.5 : 1;
    add_load(scene, s, {-2e-3 * weight * (s * s * (6 - 4 * s + s * s)) / 3, 0, 0}, Vec3::Zero(),
             true);
  }
  Simulation simulation(scene);
  simulation.start();
  simulation.advance();
  const double first = simulation.now().energy.total;
  while (simulation.status() == RunStatus::kRunning)
    simulation.advance();
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  const double decay = std::log(first / simulation.now().energy.total);
  const double predicted =
      predicted_decay(SchemeKind::kGeneralizedAlpha, omega, h, simulation.statistics().steps);
  // the decay goes with (omega h)³, and the load's share of higher modes, 1e-3 of the energy, dies
  // at once
  EXPECT_NEAR(decay, predicted, 0.02 * predicted);
}

}  // namespace
}  // namespace cprsim
