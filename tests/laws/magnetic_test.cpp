// SPDX-License-Identifier: BSD-3-Clause
// Magnetised rods in a field: against closed forms, CVODE, and a law that needs none of the code:
// in a uniform field B a rod with the moment M per length along its tangent has the torque p_s × M
// B per length, so that it moves exactly as one whose tip a dead force M B pulls.
#include <gtest/gtest.h>

#include "engine/study/modes.h"
#include "engine/study/stability.h"
#include "tests/support/methods.h"
#include "tests/support/reference_arc.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 1e-3;
constexpr double kMoment = 0.3;  // A m

MagneticFieldSpec uniform(const Vec3& B) {
  MagneticFieldSpec field;
  field.uniform = B;
  return field;
}

MagneticFieldSpec dipole(const Vec3& position, const Vec3& moment) {
  MagneticFieldSpec field;
  field.dipole = true;
  field.position = position;
  field.moment = moment;
  return field;
}

/// A clamped steel wire, magnetised.
Scene magnetic_wire(const Vec3& moment, const MagneticFieldSpec& field) {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, kRadius));
  scene.rods[0].magnets.push_back({0, 1, moment});
  scene.magnetic_fields.push_back(field);
  switch_on(scene, {Effect::kMagnetic});
  return scene;
}

/// The same wire pulled at its tip instead.
Scene pulled_wire(const Vec3& force) {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, kRadius));
  add_load(scene, 1, force);
  return scene;
}

Scene in_motion(Scene scene, Method method, double duration) {
  scene = finely(scene, method);
  scene.solver.scheme = SchemeKind::kEsdirk43;
  scene.solver.step = 0.0005;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.duration = duration;
  return scene;
}

class Magnetic : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, Magnetic, ::testing::ValuesIn(kEveryMethod), test_name);

// EI theta'' = -M B, theta(0) = theta'(L) = 0
TEST_P(Magnetic, BendsALittle) {
  const double B = 1e-4, EI = bending_stiffness(steel_rod(kLength, kRadius));
  const Equilibrium bent(finely(magnetic_wire({0, 0, kMoment}, uniform({B, 0, 0})), GetParam()));
  ASSERT_TRUE(bent.report.converged());
  const double exact = kMoment * B * std::pow(kLength, 3) / (3 * EI);
  EXPECT_NEAR(bent.rod().points.back().position.x() / exact, 1, 1e-6);
}

TEST_P(Magnetic, BendsAsUnderAForceAtItsTip) {
  const Vec3 B(12, 7, -3);
  const Equilibrium in_field(finely(magnetic_wire({0, 0, kMoment}, uniform(B)), GetParam())),
      pulled(finely(pulled_wire(kMoment * B), GetParam()));
  ASSERT_TRUE(in_field.report.converged() && pulled.report.converged());
  const RodSample a = in_field.rod(), b = pulled.rod();
  EXPECT_GT(a.points.back().position.head<2>().norm(), 0.2);
  for (std::size_t k = 0; k < a.points.size(); ++k) {
    EXPECT_LT((a.points[k].position - b.points[k].position).norm(), 1e-10) << k;
    EXPECT_LT(a.points[k].force.norm(), 1e-9) << k;  // a uniform field pulls nothing
    EXPECT_LT((a.points[k].moment - b.points[k].moment).norm(), 1e-8) << k;
  }
}

// moment in any direction, on a part of the rod, next to a dipole that pulls
TEST_P(Magnetic, AgreesWithCvode) {
  const Vec3 moment(0.1, -0.15, 0.3), B(15, 6, -4), at(0.25, 0.1, 0.35), a(4e3, -2e3, 8e3);
  for (bool stretches : {false, true}) {
    Scene scene = magnetic_wire(moment, uniform(B));
    scene.magnetic_fields.push_back(dipole(at, a));
    scene.rods[0].magnets[0].from = 0.5;
    if (stretches) switch_on(scene, {Effect::kExtension, Effect::kShear});
    const Equilibrium equilibrium(finely(scene, GetParam()));
    ASSERT_TRUE(equilibrium.report.converged());
    const RodSample rod = equilibrium.rod();
    const SectionProperties section = section_properties(scene.rods[0]);
    ReferenceSection reached;
    reached.n = rod.points.front().force;
    reached.m = rod.points.front().moment;
    const Vec3 n0 = reached.n, m0 = reached.m;
    EXPECT_GT(n0.norm(), 0.1);
    for (bool magnetised : {false, true}) {
      ReferenceRod reference;
      reference.length = 0.5 * kLength;
      reference.C_bt = section.K_bt.cwiseInverse().asDiagonal();
      if (stretches) reference.C_se = section.K_se.cwiseInverse().asDiagonal();
      reference.vary_at = [=](const Pose& X, ReferenceRod& here) {
        if (!magnetised) return;
        // Yung, Landecker, Villani, Magn. Electr. Separation 9 (1998): dipole on dipole
        const Vec3 r = X.p - at, x = r.normalized(), m = X.R * moment;
        const double d = r.norm(), ax = a.dot(x), mx = m.dot(x);
        here.l = m.cross(B + 1e-7 * (3 * ax * x - a) / (d * d * d));
        here.f = 3e-7 / std::pow(d, 4) * (ax * m + mx * a + m.dot(a) * x - 5 * ax * mx * x);
      };
      reached = integrate_reference_arc(reference, reached, 1, 1e-13);
    }
    const double accuracy = GetParam() == Method::kCollocation ? 1e-7 : 1e-8;
    EXPECT_GT(reached.X_WS.p.head<2>().norm(), 0.1);
    EXPECT_LT((reached.X_WS.p - rod.points.back().position).norm(), accuracy * kLength);
    // next to a dipole the force changes by more than itself over a cell
    EXPECT_LT(reached.n.norm(), 100 * accuracy * n0.norm());
    EXPECT_LT(reached.m.norm(), 100 * accuracy * m0.norm());
  }
}

// against the field a straight rod buckles, at M B = pi² EI / 4 L²
TEST_P(Magnetic, BucklesAgainstTheField) {
  const double EI = bending_stiffness(steel_rod(kLength, kRadius)),
               exact = std::pow(std::numbers::pi / (2 * kLength), 2) * EI / kMoment;
  const auto verdict = [&](double B) {
    StaticStudy study(finely(magnetic_wire({0, 0, kMoment}, uniform({0, 0, -B})), GetParam()));
    EXPECT_TRUE(study.solve().converged());
    const Stability judged = judge(study);
    EXPECT_EQ(judged.verdict, count_unstable(study.robot()).verdict);
    return judged.verdict;
  };
  EXPECT_EQ(verdict((1 - 1e-5) * exact), StabilityVerdict::kStable);
  EXPECT_EQ(verdict((1 + 1e-5) * exact), StabilityVerdict::kUnstable);
}

TEST_P(Magnetic, VibratesAsUnderAForceAtItsTip) {
  const Vec3 B(20, 0, 15);
  StaticStudy in_field(finely(magnetic_wire({0, 0, kMoment}, uniform(B)), GetParam())),
      pulled(finely(pulled_wire(kMoment * B), GetParam()));
  ASSERT_TRUE(in_field.solve().converged() && pulled.solve().converged());
  const auto a = natural_modes(in_field, 4), b = natural_modes(pulled, 4);
  ASSERT_EQ(a.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(a[i].frequency() / b[i].frequency(), 1, 1e-8) << i;
}

// The field is switched on: the motion is that under a force, and no energy is lost or found.
TEST_P(Magnetic, SwingsAsUnderAForceAtItsTip) {
  const Vec3 B(8, 3, 2);
  Scene scene = in_motion(magnetic_wire({0, 0, kMoment}, uniform(B)), GetParam(), 0.05),
        other = in_motion(pulled_wire(kMoment * B), GetParam(), 0.05);
  for (Scene* each : {&scene, &other})
    switch_on(*each, {Effect::kRotaryInertia});
  Simulation magnetic(scene), pulled(other);
  const Snapshot a = run_to_end(magnetic), b = run_to_end(pulled);
  ASSERT_EQ(magnetic.status(), RunStatus::kDone) << magnetic.failure();
  const Vec3 tip = a.rods[0].points.back().position;
  EXPECT_GT(tip.head<2>().norm(), 0.02);
  EXPECT_LT((tip - b.rods[0].points.back().position).norm(), 1e-8 * kLength);
  EXPECT_LT(a.energy.magnetic, -kMoment * B.z() * kLength);
  EXPECT_EQ(a.energy.work, 0);
  EXPECT_NEAR(a.energy.balance, b.energy.balance, 1e-8 * a.energy.elastic);
}

// next to a dipole, in a uniform field that grows and turns over: by every method the same motion
TEST_P(Magnetic, BalancesTheEnergyOfASwing) {
  Scene scene = magnetic_wire({0.05, 0, kMoment}, uniform({6, 3, 0}));
  scene.rods[0].magnets[0].from = 0.5;
  scene.magnetic_fields.push_back(dipole({0.08, 0, 0.42}, {3e4, 0, 5e4}));
  ProfileTerm sine;
  sine.shape = ShapeOfTime::kSine;
  sine.amplitude = 1;
  sine.frequency = 20;
  sine.end = HUGE_VAL;
  scene.magnetic_fields[0].has_profile = true;
  scene.magnetic_fields[0].profile.terms.push_back(sine);
  switch_on(scene, {Effect::kGravity, Effect::kRotaryInertia, Effect::kExtension});
  scene.simulation.initial_static = true;
  scene = in_motion(scene, GetParam(), 0.04);
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_GT(std::abs(end.energy.work), 1e-3 * end.energy.elastic);
  EXPECT_LT(std::abs(end.energy.balance), 1e-3 * std::abs(end.energy.work));
  Scene twin = scene;
  twin = finely(twin, GetParam() == Method::kStrain ? Method::kShooting : Method::kStrain);
  Simulation other(twin);
  EXPECT_LT((run_to_end(other).rods[0].points.back().position - end.rods[0].points.back().position)
                .norm(),
            5e-6 * kLength);
}

// next to a dipole, in the plane of the rod, the dipole and the moments
TEST(MagneticField, InAPlaneIsTheSame) {
  for (Method method : kEveryMethod) {
    Scene scene = magnetic_wire({0.1, 0, kMoment}, uniform({4, 0, -1}));
    scene.magnetic_fields.push_back(dipole({0.15, 0, 0.3}, {-2e3, 0, 4e3}));
    switch_on(scene, {Effect::kExtension, Effect::kShear});
    scene.solver.method = method;
    for (bool moves : {false, true}) {
      Scene space = moves ? in_motion(scene, method, 0.02) : finely(scene, method), plane = space;
      plane.planar_normal = Vec3(0, 1, 0);
      Vec3 tips[2];
      int i = 0;
      for (const Scene* each : {&space, &plane}) {
        if (moves) {
          Simulation simulation(*each);
          tips[i++] = run_to_end(simulation).rods[0].points.back().position;
          EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
        } else {
          const Equilibrium equilibrium(*each);
          EXPECT_TRUE(equilibrium.report.converged());
          tips[i++] = equilibrium.rod().points.back().position;
        }
      }
      EXPECT_GT(tips[0].x(), 0.01);
      EXPECT_LT((tips[1] - tips[0]).norm(), 1e-8 * kLength);
    }
  }
}

// a field that jumps does the work that the energy jumps by
TEST(MagneticField, AJumpOfTheFieldIsWork) {
  Scene scene = magnetic_wire({0, 0, kMoment}, uniform({5, 0, 4}));
  ProfileTerm step;
  step.shape = ShapeOfTime::kStep;
  step.from = 1;
  step.to = -0.5;
  step.start = 0.01;
  scene.magnetic_fields[0].has_profile = true;
  scene.magnetic_fields[0].profile.terms.push_back(step);
  scene.simulation.initial_static = true;
  Simulation simulation(in_motion(scene, Method::kShooting, 0.03));
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_GT(end.energy.work, 0.1);
  EXPECT_LT(std::abs(end.energy.balance), 1e-3 * end.energy.work);
}

// without the effect, or where a rod is without it, nothing of it is there
TEST(MagneticField, IsAskedFor) {
  Scene scene = magnetic_wire({0, 0, kMoment}, uniform({20, 0, 0}));
  scene.rods[0].without = {"magnetic"};
  EXPECT_LT(Equilibrium(scene).rod().points.back().position.x(), 1e-15);
  scene.rods[0].without.clear();
  EXPECT_GT(Equilibrium(scene).rod().points.back().position.x(), 0.1);
  scene.effects.set(Effect::kMagnetic, false);
  EXPECT_LT(Equilibrium(scene).rod().points.back().position.x(), 1e-15);
}

}  // namespace
}  // namespace cprsim
