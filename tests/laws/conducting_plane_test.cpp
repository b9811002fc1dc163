// SPDX-License-Identifier: BSD-3-Clause
// A charged rod in front of a conducting plane. On a spring K it moves towards it by x with
// K x = c / (h - x), c = q² L / (4 pi epsilon_0): x = (h - sqrt(h² - 4 c / K)) / 2, until at
// c = K h² / 4 nothing holds it. Bent ones against CVODE.
#include <gtest/gtest.h>

#include "engine/study/modes.h"
#include "engine/study/stability.h"
#include "tests/support/methods.h"
#include "tests/support/reference_arc.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kCharge = 5e-8, kGap = 0.02, kPi = std::numbers::pi;
constexpr double kPull = kCharge * kCharge / (4 * kPi * 8.8541878128e-12);  // N: times L / h

int law_of(const std::string& word) {
  int law = 0;
  while (kPlaceLaws[law].word != word)
    ++law;
  return law;
}

/// Rod 0 is charged, the plane stands across x at `gap`.
void charge(Scene& scene, double charge, double gap) {
  LoadSpec& load = add_load(scene, 0, Vec3::Zero());
  load.to = 1;
  load.law = law_of("conducting_plane");
  load.law_values = {charge, gap, 0, 0, -1, 0, 0};
}

/// A stiff rod along the plane, its base on a carriage that a spring holds.
Scene on_a_spring(double stiffness) {
  Scene scene;
  RodSpec rod = steel_rod(kLength, 5e-3);
  rod.stiffness.bending_x = rod.stiffness.bending_y = 1e3;
  rod.base.at.body = 0;
  scene.rods.push_back(rod);
  BodySpec carriage;
  carriage.name = "carriage";
  carriage.mass = 0.05;
  carriage.inertia = 1e-5 * Mat3::Identity();
  scene.bodies.push_back(carriage);
  JointSpec rail;
  rail.name = "rail";
  rail.kind = JointKind::kPrismatic;
  rail.axis = Vec3::UnitX();
  rail.child = 0;
  rail.spring_stiffness = stiffness;
  scene.joints.push_back(rail);
  charge(scene, kCharge, kGap);
  return scene;
}

class ConductingPlane : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, ConductingPlane, ::testing::ValuesIn(kEveryMethod), test_name);

TEST_P(ConductingPlane, PullsARodOnASpring) {
  const double c = kPull * kLength, K = c / (0.15 * kGap * kGap),
               x = (kGap - std::sqrt(kGap * kGap - 4 * c / K)) / 2;
  Scene scene = finely(on_a_spring(K), GetParam());
  scene.solver.residual_tolerance = 1e-13;  // the spring is weak beside the rod
  StaticStudy study(scene);
  ASSERT_TRUE(study.solve().converged());
  // the rod bends by 4 nm
  EXPECT_NEAR(study.robot().bodies[0].p.x() / x, 1, 1e-5);
  EXPECT_EQ(judge(study).verdict, StabilityVerdict::kStable);
  // what the plane adds to the spring is a negative stiffness
  const double mass = 0.05 + section_properties(study.robot().rods[0].spec[0]).rhoA * kLength,
               omega2 = (K - c / std::pow(kGap - x, 2)) / mass;
  const auto modes = natural_modes(study, 1);
  EXPECT_NEAR(std::pow(2 * kPi * modes[0].frequency(), 2) / omega2, 1, 1e-5);
}

TEST_P(ConductingPlane, BendsAThreadAsCvodeSays) {
  Scene scene;
  RodSpec thread = steel_rod(kLength, 1e-3);
  thread.material->youngs_modulus = 2.5e8;  // polyethylene
  thread.material->shear_modulus = 9e7;
  scene.rods.push_back(thread);
  const double q = 1.5e-7, gap = 0.1;
  charge(scene, q, gap);
  const Equilibrium bent(finely(scene, GetParam()), 1e-13);
  ASSERT_TRUE(bent.report.converged()) << bent.report.worst_row;
  const RodSample rod = bent.rod();
  const SectionProperties section = section_properties(scene.rods[0]);
  ReferenceRod reference;
  reference.length = kLength;
  reference.C_bt = section.K_bt.cwiseInverse().asDiagonal();
  reference.vary_at = [=](const Pose& X, ReferenceRod& here) {
    here.f = Vec3(q * q / (4 * kPi * 8.8541878128e-12 * (gap - X.p.x())), 0, 0);
  };
  ReferenceSection at;
  at.n = rod.points.front().force;
  at.m = rod.points.front().moment;
  const Vec3 n0 = at.n, m0 = at.m;
  at = integrate_reference_arc(reference, at, 1, 1e-13);
  EXPECT_GT(at.X_WS.p.x(), 0.02);
  EXPECT_LT((at.X_WS.p - rod.points.back().position).norm(), 1e-9 * kLength);
  EXPECT_LT(at.n.norm(), 1e-8 * n0.norm());
  EXPECT_LT(at.m.norm(), 1e-8 * m0.norm());
}

}  // namespace
}  // namespace cprsim
