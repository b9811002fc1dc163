// SPDX-License-Identifier: BSD-3-Clause
// The published Stewart-Gough robot standing still: found from straight legs, and followed as
// actuators move; and the two sweeps of a rod that all solves are made of.
#include <benchmark/benchmark.h>

#include "tests/bench/reference_kernel.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kResidual = 1e-8;
const std::vector<double> kLegs{0.3973263874, 0.3973263874, 0.3997201023,
                                0.4216240113, 0.4216240113, 0.3997201023};

Scene robot_scene(int cells, bool extensible = true, bool weight = true) {
  Scene scene = stewart_gough(kLegs, false);
  scene.effects.set(Effect::kExtension, extensible);
  scene.effects.set(Effect::kShear, extensible);
  scene.effects.set(Effect::kGravity, weight);
  scene.solver.points = cells;
  scene.solver.integrator = ArcIntegrator::kGauss6;
  return scene;
}

SolveOptions options() {
  SolveOptions o;
  o.tolerance = kResidual;
  o.max_iterations = 40;
  return o;
}

/// Distance of the plate from where 32 cells put it, m.
double plate_error(const Robot& robot) {
  static const Vec3 fine = Equilibrium(robot_scene(32)).robot.bodies[0].p;
  return (robot.bodies[0].p - fine).norm();
}

// Functions of their own, so that a profiler can count what is in them and nothing else.
[[gnu::noinline]] SolveReport find_from_straight_legs(Equations& equations) {
  equations.restart();
  return solve_statics(equations, options());
}

/// All six actuators step by `relative` of their length, neighbours in opposite directions.
[[gnu::noinline]] SolveReport follow_actuators(Equilibrium& equilibrium, double relative) {
  for (std::size_t i = 0; i < kLegs.size(); ++i)
    equilibrium.robot.rods[i].length = kLegs[i] * (1 + (i % 2 ? -relative : relative));
  equilibrium.equations.set_instant(0, true, StageRates{});
  return newton(equilibrium.equations, options());
}

void static_solve_cold(benchmark::State& state) {
  const Scene scene = robot_scene(static_cast<int>(state.range(0)));
  Equilibrium equilibrium(scene, kResidual);
  SolveReport report;
  for (auto _ : state)
    report = find_from_straight_legs(equilibrium.equations);
  if (!report.converged()) state.SkipWithError("no equilibrium found");
  state.counters["error_m"] = plate_error(equilibrium.robot);
  state.counters["iterations_of_newton"] = report.iterations;
  count_in_rk4_steps(state);
}

BENCHMARK(static_solve_cold)
    ->ArgName("cells")
    ->Arg(3)
    ->Arg(4)
    ->Arg(6)
    ->Unit(benchmark::kMicrosecond);

// Without weight nothing acts along the legs: engine/rod/unloaded_kernel.cpp.
void unloaded_solve_cold(benchmark::State& state) {
  const Scene scene = robot_scene(static_cast<int>(state.range(0)), state.range(1) != 0, false);
  Equilibrium equilibrium(scene, kResidual);
  SolveReport report;
  for (auto _ : state)
    report = find_from_straight_legs(equilibrium.equations);
  if (!report.converged()) state.SkipWithError("no equilibrium found");
  state.counters["iterations_of_newton"] = report.iterations;
  count_in_rk4_steps(state);
}

BENCHMARK(unloaded_solve_cold)
    ->ArgNames({"cells", "extensible"})
    ->ArgsProduct({{3, 4, 6}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

// To and fro by a thousandth of the length; the last solve ends where the error is known.
void static_solve_warm(benchmark::State& state) {
  const Scene scene = robot_scene(static_cast<int>(state.range(0)));
  Equilibrium equilibrium(scene, kResidual);
  bool away = false, converged = true;
  long iterations = 0;
  for (auto _ : state) {
    away = !away;
    const SolveReport report = follow_actuators(equilibrium, away ? 1e-3 : 0);
    converged = converged && report.converged();
    iterations += report.iterations;
  }
  if (away) converged = follow_actuators(equilibrium, 0).converged() && converged;
  if (!converged) state.SkipWithError("a step did not converge");
  state.counters["error_m"] = plate_error(equilibrium.robot);
  state.counters["iterations_of_newton"] =
      benchmark::Counter(static_cast<double>(iterations), benchmark::Counter::kAvgIterations);
  count_in_rk4_steps(state);
}

BENCHMARK(static_solve_warm)
    ->ArgName("cells")
    ->Arg(3)
    ->Arg(4)
    ->Arg(6)
    ->Unit(benchmark::kMicrosecond);

/// A leg of the robot in equilibrium; in motion it is at the first stage of a step of 1/120 s.
struct Leg {
  Scene scene;
  Equilibrium equilibrium;
  Stepper stepper{{SchemeKind::kEsdirk32}};

  Leg(int cells, bool extensible, bool moving)
      : scene(robot_scene(cells, extensible)), equilibrium(scene, kResidual) {
    if (!moving) return;
    Robot& robot = equilibrium.robot;
    for (RigidBody& body : robot.bodies)
      body.start_tracks(Vec3::Zero(), Vec3::Zero());
    for (RobotRod& rod : robot.rods)
      rod.model->start_tracks();
    const std::vector<Track*> tracks = robot.tracks();
    stepper.begin_step(1.0 / 120, tracks);
    equilibrium.equations.set_instant(stepper.stage_time(0) / 120, true,
                                      stepper.begin_stage(0, tracks));
  }

  const RobotRod& rod() const { return equilibrium.robot.rods[0]; }

  Port base() const { return equilibrium.robot.port(rod().base); }

  Port tip() const { return equilibrium.robot.port(rod().tip); }
};

void residual_sweep(benchmark::State& state) {
  Leg leg(static_cast<int>(state.range(0)), state.range(1) != 0, state.range(2) != 0);
  const Port base = leg.base(), tip = leg.tip();
  for (auto _ : state)
    benchmark::DoNotOptimize(leg.rod().model->evaluate(base, tip));
  count_in_rk4_steps(state);
}

void variational_sweep(benchmark::State& state) {
  Leg leg(static_cast<int>(state.range(0)), state.range(1) != 0, state.range(2) != 0);
  const Port base = leg.base(), tip = leg.tip();
  leg.rod().model->evaluate(base, tip);
  CondensedRod condensed;
  for (auto _ : state)
    benchmark::DoNotOptimize(leg.rod().model->linearize(base, tip, condensed));
  count_in_rk4_steps(state);
}

void kinds_of_sweep(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"cells", "extensible", "moving"})->ArgsProduct({{3, 6}, {0, 1}, {0, 1}});
  bench->Unit(benchmark::kMicrosecond);
}

BENCHMARK(residual_sweep)->Apply(kinds_of_sweep);
BENCHMARK(variational_sweep)->Apply(kinds_of_sweep);

}  // namespace
}  // namespace cprsim
