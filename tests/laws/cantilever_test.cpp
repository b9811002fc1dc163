// SPDX-License-Identifier: BSD-3-Clause
// A clamped rod against closed forms and against CVODE.
#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "engine/rod/tableau.h"
#include "tests/support/elastica.h"
#include "tests/support/reference_arc.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 1e-3;

Scene cantilever(int cells, ArcIntegrator integrator = ArcIntegrator::kGauss6) {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, kRadius));
  scene.solver.points = cells;
  scene.solver.integrator = integrator;
  return scene;
}

Vec3 tip(const Scene& scene) {
  const Equilibrium equilibrium(scene);
  EXPECT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  return equilibrium.rod().points.back().position;
}

TEST(Cantilever, RollsUpToAFullCircleUnderAnEndMoment) {
  Scene scene = cantilever(40);
  const double M = 2 * std::numbers::pi * bending_stiffness(scene.rods[0]) / kLength;
  add_load(scene, 1, Vec3::Zero(), {0, M, 0});
  const Equilibrium equilibrium(scene);
  ASSERT_TRUE(equilibrium.report.converged());
  EXPECT_EQ(equilibrium.report.stage, SolveStage::kNewton);
  const RodSample rod = equilibrium.rod();
  // rotations of constant curvature are exact, positions those of sixth-order quadrature of a
  // cosine
  EXPECT_LT(rod.points.back().position.norm(), 1e-13 * kLength);
  EXPECT_LT((rod.points.back().rotation - Mat3::Identity()).norm(), 1e-12);
  const double r = kLength / (2 * std::numbers::pi);
  for (const RodPoint& point : rod.points) {
    const double phi = 2 * std::numbers::pi * point.s;
    const Vec3 expected(r * (1 - std::cos(phi)), 0, r * std::sin(phi));
    EXPECT_LT((point.position - expected).norm(), 1e-11 * kLength) << "at s = " << point.s;
  }
}

class ElasticaAtLoad : public ::testing::TestWithParam<double> {};

TEST_P(ElasticaAtLoad, IsMetToANanoLength) {
  Scene scene = cantilever(30);
  const double P = GetParam() * bending_stiffness(scene.rods[0]) / (kLength * kLength);
  add_load(scene, 1, {P, 0, 0});
  const Elastica exact = solve_elastica(GetParam());
  const Vec3 at = tip(scene) / kLength;
  EXPECT_NEAR(at.x(), exact.x, 1e-9);
  EXPECT_NEAR(at.z(), exact.z, 1e-9);
  EXPECT_NEAR(at.y(), 0, 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Loads, ElasticaAtLoad, ::testing::Values(0.1, 1.0, 5.0, 10.0, 30.0));

struct OrderCase {
  ArcIntegrator integrator;
  int coarse;
};

class ArcOrder : public ::testing::TestWithParam<OrderCase> {};

TEST_P(ArcOrder, IsThatOfTheIntegrator) {
  const OrderCase c = GetParam();
  const Elastica exact = solve_elastica(5);
  auto error = [&](int cells) {
    Scene scene = cantilever(cells, c.integrator);
    add_load(scene, 1, {5 * bending_stiffness(scene.rods[0]) / (kLength * kLength), 0, 0});
    const Vec3 at = tip(scene) / kLength;
    return std::hypot(at.x() - exact.x, at.z() - exact.z);
  };
  const double observed = std::log2(error(c.coarse) / error(2 * c.coarse));
  EXPECT_NEAR(observed, arc_tableau(c.integrator).order, 0.35);
}

INSTANTIATE_TEST_SUITE_P(Integrators, ArcOrder,
                         ::testing::Values(OrderCase{ArcIntegrator::kEuler, 200},
                                           OrderCase{ArcIntegrator::kGauss2, 20},
                                           OrderCase{ArcIntegrator::kGauss4, 10},
                                           OrderCase{ArcIntegrator::kGauss6, 8},
                                           OrderCase{ArcIntegrator::kRk4, 40}));

// Everything at once, out of plane, with the base wrench found here handed to an integrator that
// shares no code.
TEST(Cantilever, AgreesWithCvodeUnderForceMomentWeightShearAndExtension) {
  Scene scene = cantilever(24);
  RodSpec& spec = scene.rods[0];
  spec.section.shape = SectionShape::kRectangle;
  spec.section.size = {2e-3, 1e-3};
  switch_on(scene, {Effect::kGravity, Effect::kShear, Effect::kExtension});
  scene.gravity = {3, -4, -9};
  add_load(scene, 1, {0.4, 0.3, -0.2}, {0.02, -0.03, 0.01});
  const Equilibrium equilibrium(scene);
  ASSERT_TRUE(equilibrium.report.converged());
  const SectionProperties section = section_properties(spec);
  ReferenceRod reference;
  reference.length = kLength;
  reference.C_bt = section.K_bt.cwiseInverse().asDiagonal();
  reference.C_se = section.K_se.cwiseInverse().asDiagonal();
  reference.f = section.rhoA * scene.gravity;
  const RodSample rod = equilibrium.rod();
  ReferenceSection base;
  base.n = rod.points.front().force;
  base.m = rod.points.front().moment;
  const ReferenceSection end = integrate_reference_arc(reference, base);
  EXPECT_LT((end.X_WS.p - rod.points.back().position).norm(), 1e-10 * kLength);
  EXPECT_LT((end.X_WS.R - rod.points.back().rotation).norm(), 1e-9);
  EXPECT_LT((end.n - rod.points.back().force - scene.loads[0].force).norm(), 1e-9);
}

TEST(Cantilever, FollowsATipForceThatTurnsWithIt) {
  // a follower force keeps its angle to the tangent: n there is the force in section axes, whatever
  // the bend
  Scene scene = cantilever(12);
  const double P = 3 * bending_stiffness(scene.rods[0]) / (kLength * kLength);
  add_load(scene, 1, {P, 0, 0}).follower = true;
  const Equilibrium equilibrium(scene);
  ASSERT_TRUE(equilibrium.report.converged());
  const RodSample rod = equilibrium.rod();
  const RodPoint& end = rod.points.back();
  // the node's wrench is what lies beyond the load: nothing; the base carries the turned force
  EXPECT_LT((rod.points.front().force - end.rotation * Vec3(P, 0, 0)).norm(), 1e-10 * P);
  EXPECT_LT(end.force.norm(), 1e-10 * P);
}

TEST(Cantilever, HoldsThousandsOfTimesItsBucklingLoadInTension) {
  // growth exponent L sqrt(N / EI) = 114: single shooting would lose all digits (hard case N3)
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, 0.25e-3));
  scene.solver.points = 400;
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {-9.81, 0, 0};
  add_load(scene, 1, {0, 0, 50});
  const Equilibrium equilibrium(scene);
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  EXPECT_GE(equilibrium.robot.rods[0].model->segments(), 19);
  // EI y'' - N y = q (L - s)² / 2 - N y_L, clamped at 0; exp(-a L) = 1e-50 is left out
  const SectionProperties section = section_properties(scene.rods[0]);
  const double N = 50, q = section.rhoA * 9.81, a = std::sqrt(N / section.K_bt.x()), L = kLength;
  const double sag = q / N * (L * L / 2 - L / a + 1 / (a * a));
  EXPECT_NEAR(equilibrium.rod().points.back().position.x(), -sag, 1e-6 * sag);
}

}  // namespace
}  // namespace cprsim
