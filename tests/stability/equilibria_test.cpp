// SPDX-License-Identifier: BSD-3-Clause
// Equilibria that are hard to find or easy to get wrong: extreme slenderness, turns beyond pi,
// buckling, frames far away, stiffnesses far apart.
#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "engine/solve/newton.h"
#include "engine/study/stability.h"
#include "tests/stability/measure.h"
#include "tests/support/column_and_frame.h"
#include "tests/support/elastica.h"

namespace cprsim {
namespace {

constexpr double kPi = std::numbers::pi, kLength = 0.4;

Scene cantilever(double length, double radius, int cells) {
  Scene scene;
  scene.rods.push_back(steel_rod(length, radius));
  scene.solver.points = cells;
  return scene;
}

// N4: the elastica at P L² / EI = 5, whatever the slenderness; shear and stretch then add what
// Timoshenko says, of the order of (r / L)².
TEST(Slenderness, DoesNotMatter) {
  const Elastica exact = solve_elastica(5);
  double worst = 0, worst_extensible = 0;
  for (const double slenderness : {10., 1e2, 1e3, 1e4, 1e5}) {
    for (const bool extensible : {false, true}) {
      Scene scene = cantilever(kLength, kLength / slenderness, 20);
      if (extensible) switch_on(scene, {Effect::kShear, Effect::kExtension});
      add_load(scene, 1, {5 * bending_stiffness(scene.rods[0]) / (kLength * kLength), 0, 0});
      const Equilibrium equilibrium(scene);
      ASSERT_TRUE(equilibrium.report.converged()) << slenderness << " " << extensible;
      const Vec3 tip = equilibrium.rod().points.back().position / kLength;
      const double error = std::hypot(tip.x() - exact.x, tip.z() - exact.z);
      const double locking = error * slenderness * slenderness;
      if (!extensible) worst = std::max(worst, error);
      if (extensible && slenderness < 1e4) worst_extensible = std::max(worst_extensible, locking);
      if (extensible && slenderness >= 1e4) worst = std::max(worst, error);
    }
  }
  measure("tip error / L", worst, 1e-7);
  // 5 (E/4) (1/G + 1/E) at most, with E = 2.5 G
  measure("(tip error / L) (L / r)^2 with shear and stretch", worst_extensible, 5 * 3.5 / 4);
}

TEST(Slenderness, OfAHundredThousandStandsStillAndFalls) {
  Scene scene = cantilever(10, 1e-4, 40);
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {0, 0, 9.81};  // it hangs
  add_load(scene, 1, {1e-4, 0, 0}, Vec3::Zero(), true);
  scene.solver.step = 1e-2;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.2;
  Simulation simulation(by_method(scene));
  const Snapshot end = run_to_end(simulation);
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  measure("steps retried", static_cast<double>(simulation.statistics().retried), 0);
  measure("energy balance / energy",
          std::abs(end.energy.balance) / (end.energy.kinetic + end.energy.elastic), 1e-2);
}

// N14: five full circles under an end moment.
TEST(Turns, FiveCirclesAreACircle) {
  Scene scene = cantilever(kLength, 1e-3, 200);
  add_load(scene, 1, Vec3::Zero(), {0, 10 * kPi * bending_stiffness(scene.rods[0]) / kLength, 0});
  const Equilibrium equilibrium(scene);
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  const double r = kLength / (10 * kPi);
  double worst = 0;
  for (const RodPoint& point : equilibrium.rod().points) {
    const double phi = 10 * kPi * point.s;
    const Vec3 circle(r * (1 - std::cos(phi)), 0, r * std::sin(phi));
    worst = std::max(worst, (point.position - circle).norm() / kLength);
  }
  measure("shape error / L", worst, 1e-8);
}

// N14: a rod under tension, one end turned by ten turns. The torque is GJ angle / L; nothing
// happens at pi or 2 pi.
TEST(Turns, TenTwistsPassPiWithoutASpike) {
  Scene scene = column(kLength, 1e-3, EndJoint::kFixed, EndJoint::kFixed, -5e4);
  const RodSpec& rod = scene.rods[0];
  const double GJ = rod.material->shear_modulus * kPi / 2 * std::pow(rod.section.size.x(), 4);
  ProfileTerm ramp;
  ramp.shape = ShapeOfTime::kRamp;
  ramp.to = 20 * kPi;
  ramp.end = 1;
  turn_base(scene).profile.terms.push_back(ramp);
  scene.solver.points = 40;
  scene.solver.step = 0.01;
  scene.simulation.mode = Mode::kQuasistatic;
  scene.simulation.duration = 1;
  Simulation simulation(by_method(scene));
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  const double torque = std::abs(end.rods[0].points[7].moment.z());
  measure("torque error", std::abs(torque * kLength / (GJ * 20 * kPi) - 1), 1e-9);
  measure("most iterations in a step", static_cast<double>(simulation.statistics().max_iterations),
          4);
}

// N15: everything turned and carried away: the energy is a scalar.
TEST(Objectivity, EnergyDoesNotSeeWhereTheRobotStands) {
  const auto energy = [](const Vec3& turn, const Vec3& shift) {
    Scene scene = cantilever(kLength, 1e-3, 12);
    switch_on(scene, {Effect::kGravity, Effect::kShear, Effect::kExtension});
    const Mat3 R = exp_so3(turn);
    scene.rods[0].base.at.X_BF = {R, shift};
    scene.gravity = R * Vec3(3, -4, -9);
    add_load(scene, 1, R * Vec3(0.4, 0.3, -0.2), R * Vec3(0.02, -0.03, 0.01));
    const Equilibrium equilibrium(scene, 1e-10);
    EXPECT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
    return equilibrium.robot.rods[0].model->energy().elastic;
  };
  const double home = energy(Vec3::Zero(), Vec3::Zero());
  double turned = 0, far = 0;
  for (const Vec3& turn : {Vec3(0.1, 0, 0), Vec3(1, -2, 0.5), Vec3(0, 0, kPi), Vec3(3, 2, 1)}) {
    turned = std::max(turned, std::abs(energy(turn, Vec3::Zero()) / home - 1));
    far = std::max(far, std::abs(energy(turn, {1e4, -1e4, 1e4}) / home - 1));
  }
  measure("energy change when turned", turned, 1e-11);
  measure("energy change 17 km away", far, 1e-8);
}

Scene euler_column(double times_critical, double sideways) {
  Scene scene = cantilever(kLength, 1e-3, 16);
  const double P = kPi * kPi / 4 * bending_stiffness(scene.rods[0]) / (kLength * kLength);
  add_load(scene, 1, {sideways * P, 0, -times_critical * P});
  return scene;
}

// N10: just below and just above Euler's load. The perfect column stands straight on both sides,
// and is said to be unstable above.
TEST(EulerColumn, IsJudgedAThousandthBelowAndAbove) {
  for (const double load : {0.999, 1.001}) {
    StaticStudy study(by_method(euler_column(load, 0)));
    ASSERT_TRUE(study.solve().converged());
    const Stability judged = judge(study);
    EXPECT_EQ(judged.verdict, load < 1 ? StabilityVerdict::kStable : StabilityVerdict::kUnstable);
    EXPECT_EQ(judged.unstable, load < 1 ? 0 : 2);  // either way sideways
  }
}

// N10: a sideways millionth of the load. Below, the column's linear answer, grown by nearly
// 1 / (1 - P / P_E). Above, the buckled column's tip leans by theta = sqrt(8 (P / P_E - 1)) to
// lowest order, and deflects by 2 theta / pi of the length.
TEST(EulerColumn, ImperfectByAMillionthLeansOrBuckles) {
  const Equilibrium below(euler_column(0.999, 1e-6));
  ASSERT_TRUE(below.report.converged()) << below.report.worst_row;
  const auto tip = [](const Equilibrium& e) {
    return std::abs(e.rod().points.back().position.x()) / kLength;
  };
  const double x = kPi / 2 * std::sqrt(0.999);
  measure("tip error at 0.999 P_E",
          std::abs(tip(below) / (1e-6 / 0.999 * (std::tan(x) / x - 1)) - 1), 1e-3);

  // from a sideways hundredth down to a millionth
  StaticStudy above(by_method(euler_column(1.001, 1e-2)));
  ASSERT_TRUE(above.solve().converged());
  const double P = -above.scene().loads[0].force.z() / 1.001;
  above.set({Parameter::Kind::kForce, 0, 0, "", ""}, 1e-6 * P);
  ASSERT_TRUE(above.follow().converged());
  EXPECT_EQ(judge(above).verdict, StabilityVerdict::kStable);
  const double lean = std::abs(above.snapshot().rods[0].points.back().position.x()) / kLength;
  measure("tip error at 1.001 P_E", std::abs(lean / (2 / kPi * std::sqrt(0.008)) - 1), 2e-2);
}

// N12: a start on an unstable equilibrium is found, and flagged with its number of directions down.
TEST(UnstableStart, IsFlagged) {
  for (const double load : {2., 10., 30.}) {
    StaticStudy study(by_method(euler_column(load, 0)));
    ASSERT_TRUE(study.solve().converged());
    // buckling loads are (1, 9, 25) P_E, each sideways both ways
    EXPECT_EQ(judge(study).unstable, load < 9 ? 2 : load < 25 ? 4 : 6) << load;
  }
}

// N20: two rods side by side, one a billion times as stiff, hold a plate; a gel of 1 Pa.
TEST(Stiffness, MayDifferByABillion) {
  Scene scene = column(kLength, 1e-3, EndJoint::kFixed, EndJoint::kFixed, 1);
  scene.rods.push_back(scene.rods[0]);
  scene.rods[1].name = "soft";
  scene.rods[1].material->youngs_modulus *= 1e-9;
  scene.rods[1].material->shear_modulus *= 1e-9;
  switch_on(scene, {Effect::kExtension});
  const Equilibrium equilibrium(scene);
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  const double stiff = equilibrium.rod(0).points[1].force.z(),
               soft = equilibrium.rod(1).points[1].force.z();
  measure("share of the soft rod", std::abs(soft / stiff / 1e-9 - 1), 1e-5);
}

TEST(Stiffness, OfAGelIsEnough) {
  Scene scene = cantilever(0.05, 5e-3, 12);
  scene.rods[0].material = {1000, 1, 1. / 3, {}};
  add_load(scene, 1, {2 * bending_stiffness(scene.rods[0]) / (0.05 * 0.05), 0, 0});
  const Equilibrium equilibrium(scene);
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  const Elastica exact = solve_elastica(2);
  measure("tip error / L", std::abs(equilibrium.rod().points.back().position.x() / 0.05 - exact.x),
          1e-8);
}

// N20: metres or millimetres, newtons or kilonewtons: the same numbers in other units.
TEST(Units, DoNotMatter) {
  const auto tip = [](double metre, double newton) {
    Scene scene = cantilever(kLength * metre, 1e-3 * metre, 12);
    const double pascal = newton / (metre * metre), second = 1;
    scene.rods[0].material = {
        8000 * newton * second * second / std::pow(metre, 4), 200e9 * pascal, 80e9 * pascal, {}};
    switch_on(scene, {Effect::kGravity, Effect::kShear, Effect::kExtension});
    scene.gravity = Vec3(3, -4, -9) * metre;
    add_load(scene, 1, Vec3(0.4, 0.3, -0.2) * newton, Vec3(0.02, -0.03, 0.01) * newton * metre);
    const Equilibrium equilibrium(scene);
    EXPECT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
    return Vec3(equilibrium.rod().points.back().position / metre);
  };
  const Vec3 si = tip(1, 1);
  double worst = 0;
  for (const double metre : {1e3, 1e-3})
    for (const double newton : {1.0, 1e-3, 1e6})
      worst = std::max(worst, (tip(metre, newton) - si).norm() / kLength);
  measure("tip difference / L", worst, 1e-9);
}

// N16: both ends at one place. The rod is a loop, which closes; it can turn about its clamp's
// tangent without effort, and no energy falls in any direction.
TEST(CoincidentEnds, GiveALoop) {
  for (const int cells : {12, 20, 30, 40}) {
    Scene scene = cantilever(kLength, 1e-3, cells);
    scene.rods[0].tip.joint = EndJoint::kBall;
    StaticStudy study(by_method(scene));
    ASSERT_TRUE(study.solve().converged()) << cells;
    const RodSample rod = study.snapshot().rods[0];
    EXPECT_EQ(count_unstable(study.robot()).unstable, 0) << cells;
    measure("gap / L, " + std::to_string(cells) + " cells",
            (rod.points.back().position - rod.points.front().position).norm() / kLength, 1e-9);
  }
}

}  // namespace
}  // namespace cprsim
