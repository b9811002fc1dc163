// SPDX-License-Identifier: BSD-3-Clause
// One time step of 1/120 s of the Stewart-Gough robot while a leg's length follows a sine, with
// everything a run does in a step but writing files.
#include <benchmark/benchmark.h>

#include "tests/bench/reference_kernel.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kStep = 1.0 / 120, kForever = 1e7;

Profile slow_sine(double length) {
  Profile profile;
  ProfileTerm mean, sine;
  mean.value = length + 0.01;
  sine.shape = ShapeOfTime::kSine;
  sine.amplitude = 0.01;
  sine.frequency = 1;
  // from rest at t = 0 and running before it: a length that jumped would be an impact
  sine.phase = -std::numbers::pi / 2;
  sine.start = -10;
  sine.end = kForever;
  profile.terms = {mean, sine};
  return profile;
}

Scene moving_robot(SchemeKind scheme, bool extensible, int cells) {
  Scene scene = stewart_gough(std::vector<double>(6, 0.4), false);
  scene.effects.set(Effect::kExtension, extensible);
  scene.effects.set(Effect::kShear, extensible);
  switch_on(scene, {Effect::kDamping});
  for (RodSpec& leg : scene.rods)
    damp(leg, 3e-3);
  DriveSpec drive;
  drive.rod = 0;
  drive.quantity = DriveQuantity::kLength;
  drive.profile = slow_sine(0.4);
  scene.drives.push_back(drive);
  scene.solver.scheme = scheme;
  scene.solver.step = kStep;
  scene.solver.points = cells;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = kForever;
  return scene;
}

void dynamic_step(benchmark::State& state, SchemeKind scheme) {
  Simulation simulation(
      moving_robot(scheme, state.range(1) != 0, static_cast<int>(state.range(0))));
  simulation.start();
  for (int k = 0; k < 10; ++k)
    simulation.advance();
  const RunStatistics before = simulation.statistics();
  for (auto _ : state)
    simulation.advance();
  if (simulation.status() != RunStatus::kRunning) state.SkipWithError(simulation.failure().c_str());
  using benchmark::Counter;
  const RunStatistics& after = simulation.statistics();
  state.counters["iterations_of_newton"] =
      Counter(static_cast<double>(after.iterations - before.iterations), Counter::kAvgIterations);
  state.counters["retried"] = static_cast<double>(after.retried - before.retried);
  state.counters["real_time_factor"] = Counter(kStep, Counter::kIsIterationInvariantRate);
  count_in_rk4_steps(state);
}

void kinds_of_robot(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"cells", "extensible"})->ArgsProduct({{3, 6}, {0, 1}});
  bench->Unit(benchmark::kMicrosecond);
}

BENCHMARK_CAPTURE(dynamic_step, esdirk32, SchemeKind::kEsdirk32)->Apply(kinds_of_robot);
BENCHMARK_CAPTURE(dynamic_step, generalized_alpha, SchemeKind::kGeneralizedAlpha)
    ->Apply(kinds_of_robot);
BENCHMARK_CAPTURE(dynamic_step, bdf_alpha, SchemeKind::kBdfAlpha)->Apply(kinds_of_robot);

}  // namespace
}  // namespace cprsim
