// SPDX-License-Identifier: BSD-3-Clause
// The planar kernel beside the spatial one: the two-rod robot of tests/support/planar_robots.h, its
// sweeps, its equilibrium, and its time steps while both cranks swing.
#include <benchmark/benchmark.h>

#include "tests/bench/reference_kernel.h"
#include "tests/support/planar_robots.h"

namespace cprsim {
namespace {

constexpr double kStep = 1.0 / 120, kForever = 1e7, kResidual = 1e-8;

Scene two_rods(bool planar, bool extensible) {
  const Plane plane = coordinate_plane();
  Scene scene = rfrfr(plane);
  switch_on(scene, {Effect::kGravity});
  scene.effects.set(Effect::kExtension, extensible);
  scene.effects.set(Effect::kShear, extensible);
  scene.solver.points = 6;
  return planar ? in_plane(scene, plane) : scene;
}

/// The left rod in equilibrium; in motion it is at the first stage of a step.
struct LeftRod {
  Scene scene;
  Equilibrium equilibrium;
  Stepper stepper{{SchemeKind::kEsdirk32}};

  LeftRod(bool planar, bool extensible, bool moving)
      : scene(two_rods(planar, extensible)), equilibrium(scene, kResidual) {
    if (!moving) return;
    Robot& robot = equilibrium.robot;
    for (RigidBody& body : robot.bodies)
      body.start_tracks(Vec3::Zero(), Vec3::Zero());
    for (RobotRod& rod : robot.rods)
      rod.model->start_tracks();
    const std::vector<Track*> tracks = robot.tracks();
    stepper.begin_step(kStep, tracks);
    equilibrium.equations.set_instant(0, true, stepper.begin_stage(0, tracks));
  }

  RodModel& model() { return *equilibrium.robot.rods[0].model; }

  Port base() const { return equilibrium.robot.port(equilibrium.robot.rods[0].base); }

  Port tip() const { return equilibrium.robot.port(equilibrium.robot.rods[0].tip); }
};

void two_rods_residual(benchmark::State& state) {
  LeftRod rod(state.range(0) != 0, state.range(1) != 0, state.range(2) != 0);
  const Port base = rod.base(), tip = rod.tip();
  for (auto _ : state)
    benchmark::DoNotOptimize(rod.model().evaluate(base, tip));
  count_in_rk4_steps(state);
}

void two_rods_variational(benchmark::State& state) {
  LeftRod rod(state.range(0) != 0, state.range(1) != 0, state.range(2) != 0);
  const Port base = rod.base(), tip = rod.tip();
  rod.model().evaluate(base, tip);
  CondensedRod condensed;
  for (auto _ : state)
    benchmark::DoNotOptimize(rod.model().linearize(base, tip, condensed));
  count_in_rk4_steps(state);
}

void two_rods_static(benchmark::State& state) {
  const Scene scene = two_rods(state.range(0) != 0, state.range(1) != 0);
  Equilibrium equilibrium(scene, kResidual);
  SolveOptions options;
  options.tolerance = kResidual;
  options.max_iterations = 40;
  SolveReport report;
  for (auto _ : state) {
    equilibrium.equations.restart();
    report = solve_statics(equilibrium.equations, options);
  }
  if (!report.converged()) state.SkipWithError("no equilibrium found");
  state.counters["iterations_of_newton"] = report.iterations;
  count_in_rk4_steps(state);
}

void two_rods_step(benchmark::State& state) {
  Scene scene = two_rods(state.range(0) != 0, state.range(1) != 0);
  set_dynamic(scene, kForever, kStep, SchemeKind::kEsdirk32);
  scene.solver.residual_tolerance.reset();
  for (std::size_t i = 0; i < 2; ++i) {
    ProfileTerm sine;
    sine.shape = ShapeOfTime::kSine;
    sine.amplitude = i == 0 ? 0.2 : -0.15;
    sine.frequency = 0.5;
    // from rest at t = 0 and running before it
    sine.phase = -std::numbers::pi / 2;
    sine.start = -10;
    sine.end = kForever;
    scene.drives[i].profile = {};
    scene.drives[i].profile.terms = {sine};
  }
  Simulation simulation(scene);
  simulation.start();
  for (int k = 0; k < 10; ++k)
    simulation.advance();
  const long before = simulation.statistics().iterations;
  for (auto _ : state)
    simulation.advance();
  if (simulation.status() != RunStatus::kRunning) state.SkipWithError(simulation.failure().c_str());
  using benchmark::Counter;
  state.counters["iterations_of_newton"] = Counter(
      static_cast<double>(simulation.statistics().iterations - before), Counter::kAvgIterations);
  count_in_rk4_steps(state);
}

void kinds_of_sweep(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"planar", "extensible", "moving"})->ArgsProduct({{0, 1}, {0, 1}, {0, 1}});
  bench->Unit(benchmark::kMicrosecond);
}

void kinds_of_solve(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"planar", "extensible"})->ArgsProduct({{0, 1}, {0, 1}});
  bench->Unit(benchmark::kMicrosecond);
}

BENCHMARK(two_rods_residual)->Apply(kinds_of_sweep);
BENCHMARK(two_rods_variational)->Apply(kinds_of_sweep);
BENCHMARK(two_rods_static)->Apply(kinds_of_solve);
BENCHMARK(two_rods_step)->Apply(kinds_of_solve);

}  // namespace
}  // namespace cprsim
