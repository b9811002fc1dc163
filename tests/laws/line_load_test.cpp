// SPDX-License-Identifier: BSD-3-Clause
// Loads spread along a rod, dead and following, against closed forms, gravity and CVODE, by every
// method.
#include <gtest/gtest.h>

#include "tests/support/methods.h"
#include "tests/support/reference_arc.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 1e-3;

/// Force N/m and torque N from `from` to `to` on a clamped steel wire.
Scene loaded_wire(const Vec3& force, const Vec3& torque, bool follower, double from = 0,
                  double to = 1) {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, kRadius));
  LoadSpec& load = add_load(scene, from, force, torque);
  load.to = to;
  load.follower = follower;
  return scene;
}

class LineLoads : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, LineLoads, ::testing::ValuesIn(kEveryMethod), test_name);

// three loads at once: dead and following, forces and torques, on parts that overlap
TEST_P(LineLoads, AgreeWithCvode) {
  const Vec3 wind(12, 5, -8), pressure(9, 4, 2), twist(0.3, 0.2, -0.25), bend(0.3, 0.8, 0.5);
  for (bool stretches : {false, true}) {
    Scene scene = loaded_wire(wind, bend, false);
    LoadSpec own = scene.loads[0];
    own.follower = true;
    own.force = pressure;
    own.torque = twist;
    own.rod_s = 0.25;
    own.to = 0.75;
    scene.loads.push_back(own);
    if (stretches) switch_on(scene, {Effect::kExtension, Effect::kShear});
    const Equilibrium equilibrium(finely(scene, GetParam()));
    ASSERT_TRUE(equilibrium.report.converged());
    const RodSample rod = equilibrium.rod();
    EXPECT_GT(rod.points.back().position.head<2>().norm(), 0.1);  // far from straight
    const SectionProperties section = section_properties(scene.rods[0]);
    ReferenceSection at;
    at.n = rod.points.front().force;
    at.m = rod.points.front().moment;
    const Vec3 n0 = at.n, m0 = at.m;
    // the reference's steps end where the load jumps
    for (int part = 0; part < 3; ++part) {
      ReferenceRod reference;
      reference.length = kLength * (part == 1 ? 0.5 : 0.25);
      reference.C_bt = section.K_bt.cwiseInverse().asDiagonal();
      if (stretches) reference.C_se = section.K_se.cwiseInverse().asDiagonal();
      reference.vary = [=](double, const Mat3& R, ReferenceRod& here) {
        here.f = wind;
        here.l = bend;
        if (part != 1) return;
        here.f += R * pressure;
        here.l += R * twist;
      };
      at = integrate_reference_arc(reference, at, 1, 1e-13);
    }
    const double accuracy = GetParam() == Method::kCollocation ? 1e-8 : 1e-9;
    EXPECT_LT((at.X_WS.p - rod.points.back().position).norm(), accuracy * kLength);
    EXPECT_LT(at.n.norm(), accuracy * n0.norm());
    EXPECT_LT(at.m.norm(), accuracy * m0.norm());
  }
}

TEST_P(LineLoads, ADeadForceIsAWeight) {
  const SectionProperties section = section_properties(steel_rod(kLength, kRadius));
  const Vec3 gravity(-6, 2, -9);
  const Equilibrium pushed(
      finely(loaded_wire(section.rhoA * gravity, Vec3::Zero(), false), GetParam()));
  Scene heavy;
  heavy.rods.push_back(steel_rod(kLength, kRadius));
  switch_on(heavy, {Effect::kGravity});
  heavy.gravity = gravity;
  const Equilibrium sagged(finely(heavy, GetParam()));
  const RodSample a = pushed.rod(), b = sagged.rod();
  for (std::size_t k = 0; k < a.points.size(); ++k)
    EXPECT_LT((a.points[k].position - b.points[k].position).norm(), 1e-12) << k;
}

// Across a rod, f e_x following: N' - kappa Q = 0, Q' + kappa N = f, M' = Q. A circle of any
// curvature kappa is in equilibrium with Q = 0, N = f / kappa, M = E I kappa at its tip.
TEST_P(LineLoads, PressureHoldsACircle) {
  constexpr double kPressure = 5;
  const double kappa = 1.5 * std::numbers::pi / kLength;  // three quarters of a turn
  Scene scene = loaded_wire({kPressure, 0, 0}, Vec3::Zero(), true);
  LoadSpec tip = scene.loads[0];
  tip.to.reset();
  tip.rod_s = 1;
  // the rod bends towards +x about +y: the load points to the centre, so that the tip is pressed
  tip.force = {0, 0, -kPressure / kappa};
  tip.torque = {0, bending_stiffness(scene.rods[0]) * kappa, 0};
  scene.loads.push_back(tip);
  const Equilibrium equilibrium(finely(scene, GetParam()));
  ASSERT_TRUE(equilibrium.report.converged());
  for (const RodPoint& point : equilibrium.rod().points) {
    const double turned = kappa * kLength * point.s;
    const Vec3 exact(0 + (1 - std::cos(turned)) / kappa, 0, std::sin(turned) / kappa);
    EXPECT_LT((point.position - exact).norm(), 1e-8 * kLength) << point.s;
    EXPECT_NEAR(point.curvature.y(), kappa, 1e-6 * kappa) << point.s;
  }
}

// m' = -l: with nothing else kappa = l (L - s) / E I, a clothoid; twist likewise
TEST_P(LineLoads, ATorqueMakesAClothoid) {
  Scene scene = loaded_wire(Vec3::Zero(), {0, 1.2, 0}, true);
  const double EI = bending_stiffness(scene.rods[0]);
  const Equilibrium bent(finely(scene, GetParam()));
  ASSERT_TRUE(bent.report.converged());
  for (const RodPoint& point : bent.rod().points) {
    const double s = point.s * kLength, turned = 1.2 * (kLength * s - s * s / 2) / EI;
    EXPECT_NEAR(point.curvature.y(), 1.2 * (kLength - s) / EI, 1e-7) << point.s;
    EXPECT_LT((point.rotation.col(2) - Vec3(std::sin(turned), 0, std::cos(turned))).norm(), 1e-8);
  }
  const Equilibrium twisted(
      finely(loaded_wire(Vec3::Zero(), {0, 0, 0.5}, false, 0, 0.5), GetParam()));
  const double GJ = section_properties(scene.rods[0]).K_bt.z(),
               turned = 0.5 * std::pow(0.5 * kLength, 2) / (2 * GJ);
  const RodSample rod = twisted.rod();
  EXPECT_LT(
      (rod.points.back().rotation.col(0) - Vec3(std::cos(turned), std::sin(turned), 0)).norm(),
      1e-9);
}

// in free flight: rho A p_tt = f
TEST_P(LineLoads, PushAFreeRod) {
  const SectionProperties section = section_properties(steel_rod(kLength, kRadius));
  Scene scene = loaded_wire({0.3, 0, 0.2}, Vec3::Zero(), false);
  scene.rods[0].base.joint = EndJoint::kFree;
  scene.solver.method = GetParam();
  scene.solver.scheme = SchemeKind::kEsdirk43;
  scene.solver.step = 0.01;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.duration = 0.2;
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  const Vec3 moved = 0.5 * 0.2 * 0.2 / section.rhoA * Vec3(0.3, 0, 0.2);
  EXPECT_LT((end.rods[0].points.front().position - moved).norm(), 1e-9);
  EXPECT_LT((end.rods[0].points.back().position - moved - Vec3(0, 0, kLength)).norm(), 1e-9);
  EXPECT_LT(std::abs(end.energy.balance), 1e-6 * end.energy.kinetic);
}

// A cantilever that a pressure which follows swings up: its motion is that of the other methods,
// and what the pressure does is what the rod has.
TEST_P(LineLoads, BalanceTheEnergyOfASwing) {
  Scene scene = loaded_wire({0.8, 0, 0}, {0, 0.02, 0}, true);
  switch_on(scene, {Effect::kGravity, Effect::kRotaryInertia});
  scene.gravity = {0, 0, -9.81};
  scene.solver.method = GetParam();
  scene.solver.points = 30;
  scene.solver.elements = GetParam() == Method::kCollocation ? 24 : 2;
  scene.solver.order = 8;
  scene.solver.scheme = SchemeKind::kEsdirk43;
  scene.solver.step = 0.0005;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.duration = 0.05;
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  const Vec3 tip = end.rods[0].points.back().position;
  EXPECT_GT(tip.x(), 0.02);
  Scene other = scene;
  other.solver.method = GetParam() == Method::kStrain ? Method::kShooting : Method::kStrain;
  other.solver.elements = 2;
  Simulation twin(other);
  EXPECT_LT((run_to_end(twin).rods[0].points.back().position - tip).norm(), 1e-6 * kLength);
  // trapezoids over the steps, and over the nodes for the torque
  EXPECT_LT(std::abs(end.energy.balance), 2e-3 * end.energy.work);
}

}  // namespace
}  // namespace cprsim
