// SPDX-License-Identifier: BSD-3-Clause
// Motions that are hard to integrate: tiny and huge steps, jumps, light and heavy bodies, waves,
// flutter.
#include <gtest/gtest.h>

#include "tests/stability/measure.h"
#include "tests/support/beam_modes.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4;

Scene moving_rod(double radius, int cells, double step, double duration) {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, radius));
  scene.solver.points = cells;
  scene.solver.step = step;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = duration;
  return scene;
}

Scene free_rod(double radius, int cells, double step, double duration) {
  Scene scene = moving_rod(radius, cells, step, duration);
  scene.rods[0].base.joint = EndJoint::kFree;
  scene.simulation.initial_static = false;
  return scene;
}

double tip_distance(const Snapshot& a, const Snapshot& b) {
  return (a.rods[0].points.back().position - b.rods[0].points.back().position).norm();
}

// N1: solutions along the rod grow by exp(138) at this step; a bent rod at rest stays at rest.
TEST(TinyStep, KeepsRestAtRest) {
  Scene scene = moving_rod(0.25e-3, 24, 1e-5, 1e-5);
  const double EI = bending_stiffness(scene.rods[0]);
  add_load(scene, 1, {-0.9 * EI / (kLength * kLength), 0, 0});
  Simulation simulation(by_method(scene));
  EXPECT_NEAR(simulation.facts().rods[0].growth_exponent, 138, 2);
  if (simulation.facts().rods[0].method == Method::kShooting) {
    EXPECT_GE(simulation.facts().rods[0].segments, 23);
  }
  simulation.start();
  const Snapshot rest = simulation.now();
  simulation.advance();
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  measure("tip displacement / L", tip_distance(simulation.now(), rest) / kLength, 1e-9);
}

// N5: a rod that nothing holds falls like a stone, from the first step on.
TEST(FreeFall, OfAFreeRodIsExact) {
  Scene scene = free_rod(1e-3, 4, 1e-3, 1);
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {0, 0, -9.81};
  for (const SchemeKind scheme :
       {SchemeKind::kEsdirk32, SchemeKind::kGeneralizedAlpha, SchemeKind::kBdfAlpha}) {
    scene.solver.scheme = scheme;
    Simulation simulation(by_method(scene));
    const Snapshot end = run_to_end(simulation);
    ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    measure(std::string("position error, m, ") + to_string(scheme),
            std::abs(end.rods[0].points.front().position.z() + 9.81 / 2), 1e-9);
  }
}

// N6: 4 N for 2 ms on a free rod give it 8 mN s, whatever it does meanwhile.
TEST(Impulse, GivesItsMomentum) {
  Scene scene = free_rod(1e-3, 12, 5e-4, 0.02);
  let_go(add_load(scene, 0.5, {4, 0, 0}), 2e-3);
  Simulation simulation(by_method(scene));
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  // internal forces vanish at free ends, so the whole rod's momentum is the mean velocity, here by
  // Boole's rule
  constexpr double kBoole[] = {14, 32, 12, 32};
  constexpr int kPieces = 12;
  double mean = 0;
  for (int i = 0; i <= kPieces; ++i)
    mean += (i == 0 || i == kPieces ? 7 : kBoole[i % 4]) *
            point_at(end.rods[0], static_cast<double>(i) / kPieces).velocity.x();
  mean *= 2. / 45 / kPieces;
  const double mass = section_properties(scene.rods[0]).rhoA * kLength;
  measure("momentum error", std::abs(mass * mean / 8e-3 - 1), 5e-4);
}

// N8: released from 38 degrees without damping at 11 steps a period: energy only falls.
TEST(LongSwing, LosesEnergyAndNeverGainsAny) {
  const RodSpec rod = steel_rod(kLength, 1e-3);
  const double rhoA = section_properties(rod).rhoA, EI = bending_stiffness(rod);
  const double step = 2 * std::numbers::pi / clamped_free_frequency(1, EI, rhoA, kLength) / 11;
  Scene scene = moving_rod(1e-3, 4, step, 5000 * step);
  scene.planar_normal = Vec3::UnitY();
  add_load(scene, 1, {-1.4 * EI / (kLength * kLength), 0, 0}, Vec3::Zero(), true);
  Simulation simulation(by_method(scene));
  simulation.start();
  const double start = simulation.now().energy.elastic;
  double last = start, gained = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    gained = std::max(gained, simulation.now().energy.total - last);
    last = simulation.now().energy.total;
  }
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_EQ(simulation.statistics().retried, 0);
  measure("largest gain in a step / energy", gained / start, 1e-2);
  measure("energy after 5,000 steps / energy", last / start, 1);
}

// N9: steps of half a second, four periods of the first mode: the rod comes to rest where it hangs.
TEST(HugeStep, GoesToTheEquilibrium) {
  Scene scene = moving_rod(1e-3, 8, 0.5, 40);
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {-9.81, 0, 0};
  Simulation still(by_method(scene));
  still.start();
  add_load(scene, 1, {0.05, 0, 0}, Vec3::Zero(), true);
  Simulation simulation(by_method(scene));
  simulation.start();
  const double from = tip_distance(simulation.now(), still.now());
  EXPECT_GT(from, 0.005);
  while (simulation.status() == RunStatus::kRunning)
    simulation.advance();
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  measure("distance left / first distance", tip_distance(simulation.now(), still.now()) / from,
          1e-3);
}

// N17: plates of a gram, a kilogram and a ton hang on six rods and are let go from a push.
TEST(HangingPlate, IsStableFromAGramToATon) {
  for (const double mass : {1e-3, 1., 1e3}) {
    Scene scene = stewart_gough({0.4, 0.4, 0.41, 0.42, 0.41, 0.4}, true, mass);
    scene.gravity = {0, 0, 9.81};
    LoadSpec push;
    push.at.body = 0;
    push.force = {mass, 0, 0};
    let_go(push);
    scene.loads.push_back(push);
    scene.solver.points = 8;
    scene.solver.step = 1e-3;
    scene.simulation.mode = Mode::kDynamic;
    scene.simulation.initial_static = true;
    scene.simulation.duration = 0.02;
    Simulation simulation(by_method(scene));
    simulation.start();
    const double start = simulation.now().energy.total;
    double gained = 0;
    while (simulation.status() == RunStatus::kRunning) {
      simulation.advance();
      gained = std::max(gained, (simulation.now().energy.total - start) / std::abs(start));
    }
    ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure() << " " << mass;
    EXPECT_EQ(simulation.statistics().retried, 0) << mass;
    measure("energy gained with " + std::to_string(mass) + " kg", gained, 1e-6);
  }
}

// N26: pushed at one end, an elastic rod moves at the other when sound has come through, after
// L / c.
TEST(Impact, ArrivesWithTheSpeedOfSound) {
  const double c = std::sqrt(200e9 / 8000), transit = kLength / c;
  Scene scene = free_rod(1e-3, 60, transit / 100, 1.5 * transit);
  switch_on(scene, {Effect::kExtension});
  add_load(scene, 0, {0, 0, 10});
  Simulation simulation(by_method(scene));
  simulation.start();
  // a step of force sends a front of velocity F / (A rho c); it doubles at the free end
  const double front = 10 / (section_properties(scene.rods[0]).rhoA * c);
  double arrival = 0;
  double lowest = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    lowest = std::min(lowest, simulation.now().energy.total);
    const double tip = simulation.now().rods[0].points.back().velocity.z();
    if (arrival == 0 && tip > front) arrival = simulation.time();
  }
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  measure("arrival error", std::abs(arrival / transit - 1), 0.05);
  EXPECT_GE(lowest, 0);
}

// N27: without damping, and with a time constant of a thousand seconds: the rod then is dough.
TEST(Damping, MayBeNoneOrEnormous) {
  const auto moved = [](double tau) {
    Scene scene = moving_rod(1e-3, 8, 1e-2, 0.5);
    switch_on(scene, {Effect::kDamping});
    damp(scene.rods[0], tau);
    add_load(scene, 1, {-0.05, 0, 0}, Vec3::Zero(), true);
    Simulation simulation(by_method(scene));
    simulation.start();
    const Snapshot start = simulation.now();
    while (simulation.status() == RunStatus::kRunning)
      simulation.advance();
    EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure() << " " << tau;
    EXPECT_LE(simulation.now().energy.total, start.energy.total * (1 + 1e-6)) << tau;
    return tip_distance(simulation.now(), start) /
           std::abs(start.rods[0].points.back().position.x());
  };
  EXPECT_GT(moved(0), 0.1);
  // creeps back by exp(-t / tau)
  measure("creep in 0.5 s against 0.5 s / tau", std::abs(moved(1e3) / 5e-4 - 1), 1e-2);
}

// N28: a follower force at the tip makes the cantilever flutter from 20.05 EI / L² on (Beck 1952).
// Growth over ten periods, from a disturbance of a millionth of the length.
TEST(BecksColumn, FluttersAboveItsLoadAndNotBelow) {
  const auto growth = [](double times_critical) {
    const RodSpec rod = steel_rod(kLength, 1e-3);
    const double EI = bending_stiffness(rod),
                 unit = kLength * kLength * std::sqrt(section_properties(rod).rhoA / EI);
    const double period = 2 * std::numbers::pi / 11.02 * unit;
    Scene scene = moving_rod(1e-3, 10, period / 30, 12 * period);
    scene.planar_normal = Vec3::UnitY();
    scene.solver.scheme = SchemeKind::kEsdirk43;
    add_load(scene, 1, {0, 0, -20.0509 * times_critical * EI / (kLength * kLength)}).follower =
        true;
    add_load(scene, 1, {1e-6 * EI / (kLength * kLength), 0, 0}, Vec3::Zero(), true);
    Simulation simulation(by_method(scene));
    simulation.start();
    double early = 0, late = 0;
    while (simulation.status() == RunStatus::kRunning) {
      simulation.advance();
      const double x = std::abs(simulation.now().rods[0].points.back().position.x());
      if (simulation.time() < 2 * period) early = std::max(early, x);
      if (simulation.time() > 10 * period) late = std::max(late, x);
    }
    EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    return late / early;
  };
  EXPECT_GT(growth(1.01), 5);
  measure("late / early amplitude at 0.99 of the load", growth(0.99), 1.5);
}

}  // namespace
}  // namespace cprsim
