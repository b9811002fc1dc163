// SPDX-License-Identifier: BSD-3-Clause
// Rods in a fluid: drag, current, added mass and buoyancy against closed forms and CVODE, by every
// method.
#include <gtest/gtest.h>

#include "engine/study/modes.h"
#include "tests/support/beam_modes.h"
#include "tests/support/methods.h"
#include "tests/support/reference_arc.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 1e-3, kWater = 1000;
const double kArea = std::numbers::pi * kRadius * kRadius;

/// A steel wire in water: across C_d = 1.2, along C_f = 0.02.
Scene wire_in_water() {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, kRadius));
  DragSpec drag;
  drag.normal = 0.5 * kWater * 1.2 * 2 * kRadius;
  drag.tangential = 0.5 * kWater * 0.02 * 2 * std::numbers::pi * kRadius;
  drag.fluid_density = kWater;
  drag.added_mass = 1;
  scene.rods[0].drag = drag;
  switch_on(scene, {Effect::kDrag});
  return scene;
}

class InAFluid : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, InAFluid, ::testing::ValuesIn(kEveryMethod), test_name);

TEST_P(InAFluid, ACantileverInACurrentAgreesWithCvode) {
  for (bool stretches : {false, true}) {
    Scene scene = wire_in_water();
    if (stretches) switch_on(scene, {Effect::kExtension, Effect::kShear});
    switch_on(scene, {Effect::kGravity});
    scene.gravity = {0, 3, -9};
    scene.wind = {6, 1.5, 3};
    const Equilibrium equilibrium(finely(scene, GetParam()));
    ASSERT_TRUE(equilibrium.report.converged());
    const RodSample rod = equilibrium.rod();
    EXPECT_GT(rod.points.back().position.x(), 0.15);  // far from straight
    const SectionProperties section = section_properties(scene.rods[0]);
    ReferenceRod reference;
    reference.length = kLength;
    reference.C_bt = section.K_bt.cwiseInverse().asDiagonal();
    if (stretches) reference.C_se = section.K_se.cwiseInverse().asDiagonal();
    const Vec3 weight = (section.rhoA - kWater * kArea) * scene.gravity, V = scene.wind;
    const DragSpec drag = *scene.rods[0].drag;
    reference.vary = [=](double, const Mat3& R, ReferenceRod& here) {
      const Vec3 t = R.col(2), V_t = V.dot(t) * t, V_n = V - V_t;
      here.f = weight + drag.normal * V_n.norm() * V_n + drag.tangential * V_t.norm() * V_t;
    };
    ReferenceSection base;
    base.n = rod.points.front().force;
    base.m = rod.points.front().moment;
    const ReferenceSection end = integrate_reference_arc(reference, base, 1, 1e-13);
    const double accuracy = GetParam() == Method::kCollocation ? 1e-8 : 1e-9;
    EXPECT_LT((end.X_WS.p - rod.points.back().position).norm(), accuracy * kLength);
    EXPECT_LT(end.n.norm(), accuracy * base.n.norm());
    EXPECT_LT(end.m.norm(), accuracy * base.m.norm());
  }
}

TEST_P(InAFluid, AWeakCurrentDeflectsLikeAUniformLoad) {
  Scene scene = wire_in_water();
  scene.wind = {0.05, 0, 0};
  const Equilibrium equilibrium(finely(scene, GetParam()));
  ASSERT_TRUE(equilibrium.report.converged());
  const double q = scene.rods[0].drag->normal * 0.05 * 0.05,
               sag = q * std::pow(kLength, 4) / (8 * bending_stiffness(scene.rods[0]));
  EXPECT_NEAR(equilibrium.rod().points.back().position.x(), sag, 1e-5 * sag);
}

TEST_P(InAFluid, ANeutralRodDoesNotSag) {
  Scene scene = wire_in_water();
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {-9.81, 0, 0};
  scene.rods[0].drag->fluid_density = scene.rods[0].material->density;
  const Equilibrium neutral(finely(scene, GetParam()));
  ASSERT_TRUE(neutral.report.converged());
  EXPECT_LT((neutral.rod().points.back().position - Vec3(0, 0, kLength)).norm(), 1e-12);
  // a lighter one floats up as far as a heavier one sinks
  const double sunk = [&] {
    scene.rods[0].drag->fluid_density = 7000;
    return Equilibrium(finely(scene, GetParam())).rod().points.back().position.x();
  }();
  scene.rods[0].drag->fluid_density = 9000;
  const double risen = Equilibrium(finely(scene, GetParam())).rod().points.back().position.x();
  EXPECT_LT(sunk, -5e-4);
  EXPECT_NEAR(risen, -sunk, 1e-9);
}

TEST_P(InAFluid, AFallingRodApproachesItsTerminalVelocity) {
  // (rho A + m_a) v_t = W - c v|v|: v = v_end tanh(W t / ((rho A + m_a) v_end)); along the axis no
  // mass of water follows
  for (bool along : {false, true}) {
    Scene scene = wire_in_water();
    switch_on(scene, {Effect::kGravity});
    scene.gravity = along ? Vec3(0, 0, -9.81) : Vec3(-9.81, 0, 0);
    scene.rods[0].base.joint = EndJoint::kFree;
    if (along) scene.rods[0].drag->tangential = 0.2;
    scene.solver.method = GetParam();
    scene.solver.scheme = SchemeKind::kEsdirk43;
    scene.solver.step = 0.005;
    scene.simulation.mode = Mode::kDynamic;
    scene.simulation.duration = 0.2;
    Simulation simulation(scene);
    const Snapshot end = run_to_end(simulation);
    ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    const DragSpec& drag = *scene.rods[0].drag;
    const double W = (8000 - kWater) * kArea * 9.81, c = along ? drag.tangential : drag.normal,
                 mass = (along ? 8000 : 8000 + kWater) * kArea, v_end = std::sqrt(W / c),
                 v = v_end * std::tanh(W * 0.2 / (mass * v_end));
    const RodPoint& tip = end.rods[0].points.back();
    EXPECT_GT(v, (along ? 0.7 : 0.95) * v_end);
    EXPECT_NEAR(-tip.velocity[along ? 2 : 0], v, 1e-6 * v);
    EXPECT_NEAR(end.rods[0].points.front().velocity[along ? 2 : 0], tip.velocity[along ? 2 : 0],
                1e-9 * v);
    EXPECT_LT(std::abs(end.energy.balance), 1e-5 * end.energy.dissipated);
  }
}

TEST_P(InAFluid, AddedMassLowersTheFrequencies) {
  Scene scene = finely(wire_in_water(), GetParam());
  if (GetParam() == Method::kShooting) scene.solver.points = 16;
  StaticStudy study(scene);
  ASSERT_TRUE(study.solve().converged());
  const double mass = (8000 + kWater) * kArea;
  EXPECT_NEAR(std::sqrt(natural_modes(study, 2)[0].omega_squared) /
                  clamped_free_frequency(1, bending_stiffness(scene.rods[0]), mass, kLength),
              1, 3e-6);
}

/// Let go from a bent shape in a current across the plane of its bending.
Scene released_in_a_current(Method method, double step) {
  Scene scene = wire_in_water();
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {0, 0, -9.81};
  scene.wind = {0, 0.5, 0.2};
  add_load(scene, 1, {-0.3, 0, 0}, Vec3::Zero(), true);
  scene.solver.method = method;
  if (method == Method::kShooting) scene.solver.points = 8;
  if (method == Method::kStrain) scene.solver.order = 10;
  if (method == Method::kCollocation) {
    scene.solver.degree = 8;
    scene.solver.elements = 8;
  }
  scene.solver.scheme = SchemeKind::kGeneralizedAlpha;
  scene.solver.step = step;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.1;
  return scene;
}

// In the shape of its first mode a rod swings at that mode's frequency: inertia as time steps see
// it.
TEST_P(InAFluid, AddedMassSlowsASmallSwing) {
  Scene scene = released_in_a_current(GetParam(), 0);
  scene.effects.set(Effect::kGravity, false);
  scene.wind.setZero();
  scene.rods[0].drag->normal = scene.rods[0].drag->tangential = 0;
  const double omega = clamped_free_frequency(1, bending_stiffness(scene.rods[0]),
                                              (8000 + kWater) * kArea, kLength),
               period = 2 * std::numbers::pi / omega;
  scene.loads.clear();
  for (int i = 1; i <= 8; ++i) {
    const double s = i / 8.0;
    add_load(scene, s, {1e-4 * (i == 8 ? 0.5 : 1) * (s * s * (6 - 4 * s + s * s)) / 3, 0, 0},
             Vec3::Zero(), true);
  }
  scene.solver.scheme = SchemeKind::kEsdirk43;
  scene.solver.step = period / 40;
  scene.simulation.duration = 5 * period;
  Simulation simulation(scene);
  simulation.start();
  const double start = simulation.now().rods[0].points.back().position.x();
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  // near a peak a deflection tells little of the phase, a velocity much: v = -omega x_0 sin(phase)
  const double phase = -end.rods[0].points.back().velocity.x() / (omega * start);
  EXPECT_NEAR(phase / (10 * std::numbers::pi), 0, 2e-3);
  EXPECT_NEAR(end.rods[0].points.back().position.x(), start, 0.01 * start);
}

TEST(Fluid, MethodsAgreeOnARodReleasedInACurrent) {
  std::vector<Vec3> tips;
  for (Method method : kEveryMethod) {
    Simulation simulation(released_in_a_current(method, 2e-3));
    tips.push_back(run_to_end(simulation).rods[0].points.back().position);
    ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  }
  EXPECT_LT((tips[1] - tips[0]).norm(), 1e-6 * kLength);
  EXPECT_LT((tips[2] - tips[0]).norm(), 1e-6 * kLength);
}

TEST_P(InAFluid, EnergyBalanceClosesWithTheOrderOfTheScheme) {
  auto balance = [](double step) {
    Simulation simulation(released_in_a_current(GetParam(), step));
    const Snapshot end = run_to_end(simulation);
    EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    EXPECT_GT(end.energy.dissipated, 0);
    return std::abs(end.energy.balance) / end.energy.dissipated;
  };
  const double coarse = balance(1e-3), fine = balance(5e-4);
  EXPECT_LT(fine, 5e-3);
  EXPECT_GT(std::log2(coarse / fine), 1.5);
}

TEST(Fluid, LeavesSchemesTheirOrder) {
  const auto tip = [](SchemeKind scheme, double step) {
    Scene scene = released_in_a_current(Method::kShooting, step);
    // a smooth start, and damping enough for higher modes to be resolved
    switch_on(scene, {Effect::kDamping});
    damp(scene.rods[0], 2e-3);
    scene.loads.clear();
    scene.simulation.initial_static = false;
    scene.solver.scheme = scheme;
    Simulation simulation(scene);
    const Snapshot end = run_to_end(simulation);
    EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    return end.rods[0].points.back().position;
  };
  const Vec3 reference = tip(SchemeKind::kEsdirk43, 2.5e-4);
  for (SchemeKind scheme :
       {SchemeKind::kBdf2, SchemeKind::kGeneralizedAlpha, SchemeKind::kEsdirk32}) {
    const double coarse = (tip(scheme, 2e-3) - reference).norm(),
                 fine = (tip(scheme, 1e-3) - reference).norm();
    EXPECT_GT(std::log2(coarse / fine), 1.8) << to_string(scheme) << " " << coarse << " " << fine;
  }
}

// without <drag> or with the effect off nothing of it is there
TEST(Fluid, CountsOnlyIfListed) {
  Scene scene = wire_in_water();
  scene.wind = {1, 0, 0};
  scene.effects.set(Effect::kDrag, false);
  EXPECT_EQ(Equilibrium(scene).rod().points.back().position.x(), 0);
  switch_on(scene, {Effect::kDrag});
  scene.rods[0].without = {"drag"};
  EXPECT_EQ(Equilibrium(scene).rod().points.back().position.x(), 0);
}

}  // namespace
}  // namespace cprsim
