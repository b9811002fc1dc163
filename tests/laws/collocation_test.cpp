// SPDX-License-Identifier: BSD-3-Clause
// Isogeometric collocation against closed forms and against shooting, with which it shares the ends
// of a rod and nothing in between.
#include "engine/rod/collocation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/so3.h"
#include "tests/support/elastica.h"
#include "tests/support/released_rod.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 1e-3;

Scene with_splines(Scene scene, int degree, int elements) {
  scene.solver.method = Method::kCollocation;
  scene.solver.degree = degree;
  scene.solver.elements = elements;
  return scene;
}

Scene with_shooting(Scene scene, int cells) {
  scene.solver.method = Method::kShooting;
  scene.solver.points = cells;
  return scene;
}

Scene cantilever() {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, kRadius));
  return scene;
}

double load_unit(const Scene& scene) {
  return bending_stiffness(scene.rods[0]) / (kLength * kLength);
}

/// The largest distance between two rods' points; those of `a` are where some of `b` are.
double distance(const RodSample& a, const RodSample& b) {
  double most = 0;
  for (const RodPoint& point : a.points)
    for (const RodPoint& other : b.points)
      if (std::abs(point.s - other.s) < 1e-9)
        most = std::max(most, (point.position - other.position).norm());
  return most;
}

TEST(Splines, RollUpToAFullCircleUnderAnEndMoment) {
  Scene scene = cantilever();
  const double M = 2 * std::numbers::pi * bending_stiffness(scene.rods[0]) / kLength;
  add_load(scene, 1, Vec3::Zero(), {0, M, 0});
  const Equilibrium equilibrium(with_splines(scene, 7, 16));
  ASSERT_TRUE(equilibrium.report.converged());
  EXPECT_EQ(equilibrium.report.stage, SolveStage::kNewton);
  const double r = kLength / (2 * std::numbers::pi);
  for (const RodPoint& point : equilibrium.rod().points) {
    const double phi = 2 * std::numbers::pi * point.s;
    const Vec3 expected(r * (1 - std::cos(phi)), 0, r * std::sin(phi));
    EXPECT_LT((point.position - expected).norm(), 1e-9 * kLength) << "at s = " << point.s;
    EXPECT_LT((point.rotation - exp_so3({0, phi, 0})).norm(), 1e-8) << "at s = " << point.s;
  }
}

class SplinesAsElastica : public ::testing::TestWithParam<double> {};

TEST_P(SplinesAsElastica, MeetItToANanoLength) {
  Scene scene = cantilever();
  add_load(scene, 1, {GetParam() * load_unit(scene), 0, 0});
  const Elastica exact = solve_elastica(GetParam());
  const Equilibrium equilibrium(with_splines(scene, 7, 20));
  ASSERT_TRUE(equilibrium.report.converged());
  const Vec3 at = equilibrium.rod().points.back().position / kLength;
  EXPECT_NEAR(at.x(), exact.x, 1e-9);
  EXPECT_NEAR(at.z(), exact.z, 1e-9);
  EXPECT_NEAR(at.y(), 0, 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Loads, SplinesAsElastica, ::testing::Values(0.1, 1.0, 5.0, 10.0));

struct OrderCase {
  int degree, coarse;
};

class SplineOrder : public ::testing::TestWithParam<OrderCase> {};

// p for even degrees, p + 1 for odd ones.
TEST_P(SplineOrder, IsTheEvenNumberAtOrAboveTheDegree) {
  const int degree = GetParam().degree, coarse = GetParam().coarse;
  const Elastica exact = solve_elastica(5);
  const auto error = [&](int elements) {
    Scene scene = cantilever();
    add_load(scene, 1, {5 * load_unit(scene), 0, 0});
    const Equilibrium equilibrium(with_splines(scene, degree, elements));
    const Vec3 at = equilibrium.rod().points.back().position / kLength;
    return std::hypot(at.x() - exact.x, at.z() - exact.z);
  };
  const double observed = std::log2(error(coarse) / error(2 * coarse));
  const int order = degree + degree % 2;
  EXPECT_GT(observed, order - 0.45);
  EXPECT_LT(observed, order + 1.1);
}

INSTANTIATE_TEST_SUITE_P(Degrees, SplineOrder,
                         ::testing::Values(OrderCase{2, 32}, OrderCase{3, 24}, OrderCase{4, 24},
                                           OrderCase{5, 20}, OrderCase{6, 16}, OrderCase{7, 10},
                                           OrderCase{8, 10}));

/// Finer splines are divided by nearly the same smooth function.
std::vector<double> some_weights(int degree, int elements) {
  std::vector<double> breaks;
  for (int e = 0; e <= elements; ++e)
    breaks.push_back(static_cast<double>(e) / elements);
  const BsplineSpace space(degree, breaks);
  MatX values(space.size(), 1);
  int i = 0;
  for (const double x : space.greville())
    values(i++, 0) = 1 + 0.4 * std::sin(4 * x);
  const VecX weights = space.interpolate(values);
  return {weights.data(), weights.data() + weights.size()};
}

// Rational functions approximate as well as the polynomials that they are made of.
TEST_P(SplineOrder, IsThatOfNurbsToo) {
  const int degree = GetParam().degree, coarse = GetParam().coarse;
  const Elastica exact = solve_elastica(5);
  const auto error = [&](int elements) {
    Scene scene = with_splines(cantilever(), degree, elements);
    scene.solver.weights = some_weights(degree, elements);
    add_load(scene, 1, {5 * load_unit(scene), 0, 0});
    const Equilibrium equilibrium(scene);
    const Vec3 at = equilibrium.rod().points.back().position / kLength;
    return std::hypot(at.x() - exact.x, at.z() - exact.z);
  };
  // of degree 8 round-off comes before the order is quite reached
  const double observed = std::log2(error(coarse) / error(2 * coarse));
  EXPECT_GT(observed, degree - 0.8);
}

TEST(Nurbs, OfEqualWeightsAreBsplines) {
  Scene scene = with_splines(cantilever(), 4, 12);
  add_load(scene, 1, {3 * load_unit(scene), load_unit(scene), 0});
  add_load(scene, 0.37, {0, 2 * load_unit(scene), 0});
  Scene weighted = scene;
  weighted.solver.weights.assign(16, 2.5);
  const Equilibrium a(scene), b(weighted);
  ASSERT_TRUE(a.report.converged() && b.report.converged());
  EXPECT_LT(distance(a.rod(), b.rod()), 1e-13);
}

// A load between the knots cuts the splines in two; each part keeps the function that divides.
TEST(Nurbs, MeetShootingAcrossALoad) {
  Scene scene = with_splines(cantilever(), 7, 20);
  scene.solver.weights = some_weights(7, 20);
  add_load(scene, 1, {3 * load_unit(scene), load_unit(scene), 0});
  add_load(scene, 0.37, {0, 2 * load_unit(scene), 0});
  const Equilibrium a(scene), b(with_shooting(scene, 40));
  ASSERT_TRUE(a.report.converged() && b.report.converged());
  EXPECT_LT((a.rod().points.back().position - b.rod().points.back().position).norm(),
            1e-8 * kLength);
}

// Slenderness L/r from 20 to 20,000, shear and extension on and off: the error of the same coarse
// splines does not depend on it, where a displacement form locks by a factor of the slenderness.
TEST(Splines, DoNotLock) {
  const Elastica exact = solve_elastica(2);
  for (int degree : {2, 3, 5}) {
    double least = 1, most = 0;
    for (double slenderness : {20., 200., 2000., 20000.})
      for (bool soft : {false, true}) {
        Scene scene;
        scene.rods.push_back(steel_rod(kLength, kLength / slenderness));
        add_load(scene, 1, {2 * load_unit(scene), 0, 0});
        if (soft) switch_on(scene, {Effect::kShear, Effect::kExtension});
        const Equilibrium equilibrium(with_splines(scene, degree, 8));
        ASSERT_TRUE(equilibrium.report.converged()) << slenderness;
        const Vec3 at = equilibrium.rod().points.back().position / kLength;
        Vec3 truth(exact.x, 0, exact.z);
        if (soft) {
          const Equilibrium fine(with_shooting(scene, 24));
          truth = fine.rod().points.back().position / kLength;
        }
        const double error = (at - truth).norm();
        least = std::min(least, error);
        most = std::max(most, error);
      }
    // shear and extension themselves add 1 % at L/r = 20
    EXPECT_LT(most, 1.1 * least) << "degree " << degree;
  }
}

TEST(Splines, AgreeWithShootingWhenEverythingActs) {
  Scene scene = cantilever();
  RodSpec& spec = scene.rods[0];
  spec.section.shape = SectionShape::kRectangle;
  spec.section.size = {2e-3, 1e-3};
  spec.rest_curvature = {1, -2, 3};
  switch_on(scene, {Effect::kGravity, Effect::kShear, Effect::kExtension});
  scene.gravity = {3, -4, -9};
  add_load(scene, 1, {0.4, 0.3, -0.2}, {0.02, -0.03, 0.01});
  add_load(scene, 0.5, {-0.5, 0.2, 0.3}, {0.01, 0, 0}).follower = true;
  add_load(scene, 0.25, {0.1, -0.3, 0});
  const Equilibrium splines(with_splines(scene, 7, 16)), shooting(with_shooting(scene, 48));
  ASSERT_TRUE(splines.report.converged());
  ASSERT_TRUE(shooting.report.converged());
  const RodSample a = splines.rod(), b = shooting.rod();
  EXPECT_LT(distance(a, b), 2e-10);
  EXPECT_LT((a.points.front().force - b.points.front().force).norm(), 1e-9);
  EXPECT_LT((a.points.front().moment - b.points.front().moment).norm(), 1e-9);
}

// Growth exponent L sqrt(N / EI) = 114, as in cantilever_test.cpp; no segments are needed.
TEST(Splines, HoldThousandsOfTimesTheBucklingLoadInTension) {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, 0.25e-3));
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {-9.81, 0, 0};
  add_load(scene, 1, {0, 0, 50});
  const Equilibrium equilibrium(with_splines(scene, 5, 100));
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  const SectionProperties section = section_properties(scene.rods[0]);
  const double N = 50, q = section.rhoA * 9.81, a = std::sqrt(N / section.K_bt.x()), L = kLength;
  const double sag = q / N * (L * L / 2 - L / a + 1 / (a * a));
  EXPECT_NEAR(equilibrium.rod().points.back().position.x(), -sag, 1e-6 * sag);
}

TEST(Splines, PutTheStewartGoughRobotWhereItsPublishedLegLengthsDo) {
  for (bool clamped : {false, true}) {
    const std::vector<double> lengths =
        clamped ? std::vector<double>{0.3973214576, 0.3973214576, 0.3997200876,
                                      0.4216198875, 0.4216198875, 0.3997200876}
                : std::vector<double>{0.3973263874, 0.3973263874, 0.3997201023,
                                      0.4216240113, 0.4216240113, 0.3997201023};
    const Equilibrium equilibrium(with_splines(stewart_gough(lengths, clamped), 7, 8), 1e-10);
    ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
    EXPECT_EQ(equilibrium.report.stage, SolveStage::kNewton);
    const RigidBody& plate = equilibrium.robot.bodies[0];
    EXPECT_LT((plate.p - Vec3(0, 0, 0.4)).norm(), 1e-8);  // lengths are given to 1e-10 m
    EXPECT_LT((log_so3(plate.R) - Vec3(0, 10 * std::numbers::pi / 180, 0)).norm(), 1e-7);
  }
}

TEST(Splines, AreAsManyAsTheAccuracyAsksFor) {
  const std::vector<double> lengths{0.3973263874, 0.3973263874, 0.3997201023,
                                    0.4216240113, 0.4216240113, 0.3997201023};
  const Scene scene = stewart_gough(lengths, false);
  const Vec3 fine = Equilibrium(with_shooting(scene, 48)).robot.bodies[0].p;
  for (int degree = kLeastDegree; degree <= kMaxDegree; ++degree)
    for (double accuracy : {1e-4, 1e-6, 1e-8}) {
      if (degree == 2 && accuracy < 1e-5) continue;  // a thousand elements and more
      Scene asked = scene;
      asked.solver.method = Method::kCollocation;
      asked.solver.degree = degree;
      asked.solver.accuracy = accuracy;
      const Equilibrium equilibrium(asked);
      EXPECT_LT((equilibrium.robot.bodies[0].p - fine).norm(), accuracy) << "degree " << degree;
    }
}

// Two legs of each method under one plate.
TEST(Splines, ShareARobotWithLegsOfOtherMethods) {
  const std::vector<double> lengths{0.3973263874, 0.3973263874, 0.3997201023,
                                    0.4216240113, 0.4216240113, 0.3997201023};
  Scene scene = with_splines(stewart_gough(lengths, false), 7, 8);
  for (std::size_t i : {0u, 3u})
    scene.rods[i].method = Method::kShooting;
  for (std::size_t i : {1u, 5u})
    scene.rods[i].method = Method::kStrain;
  scene.solver.points = 12;
  scene.solver.order = 4;
  const Equilibrium mixed(scene, 1e-10);
  ASSERT_TRUE(mixed.report.converged());
  EXPECT_LT((mixed.robot.bodies[0].p - Vec3(0, 0, 0.4)).norm(), 1e-8);
}

// The laboratory frame does not matter: quaternions turn by a constant factor.
TEST(Splines, DoNotDependOnTheFrame) {
  Scene scene = cantilever();
  switch_on(scene, {Effect::kShear, Effect::kExtension});
  scene.rods[0].rest_curvature = {2, 1, -3};
  const Vec3 force = 4 * load_unit(scene) * Vec3(1, 0.5, -0.4);
  add_load(scene, 1, force);
  const RodSample here = Equilibrium(with_splines(scene, 4, 5)).rod();
  const Pose X{exp_so3({1.1, -2.3, 0.7}), {0.3, -0.2, 0.5}};
  scene.rods[0].base.at.X_BF = X;
  scene.loads[0].force = X.R * force;
  const RodSample there = Equilibrium(with_splines(scene, 4, 5)).rod();
  for (std::size_t k = 0; k < here.points.size(); ++k) {
    EXPECT_LT((there.points[k].position - X * here.points[k].position).norm(), 1e-12);
    EXPECT_LT((there.points[k].rotation - X.R * here.points[k].rotation).norm(), 1e-11);
  }
}

// Base and tip exchanged: the same rod seen from its other end, turned by half a turn.
TEST(Splines, DoNotDependOnWhichEndIsTheBase) {
  Scene scene = cantilever();
  switch_on(scene, {Effect::kShear, Effect::kExtension, Effect::kGravity});
  const Pose tip{exp_so3({0.3, 0.5, 0.4}), {0.1, 0.05, 0.33}};
  const Mat3 flip = exp_so3({std::numbers::pi, 0, 0});
  RodSpec& rod = scene.rods[0];
  rod.rest_curvature = {1, 2, 0};
  rod.tip.joint = EndJoint::kFixed;
  rod.tip.at.X_BF = tip;
  const RodSample forth = Equilibrium(with_splines(scene, 5, 6)).rod();
  rod.base.at.X_BF = {tip.R * flip, tip.p};
  rod.tip.at.X_BF = {flip, Vec3::Zero()};
  // about flipped axes, along a flipped arc: u'(s') = -flip u
  rod.rest_curvature = -(flip * Vec3(1, 2, 0));
  const RodSample back = Equilibrium(with_splines(scene, 5, 6)).rod();
  ASSERT_EQ(forth.points.size(), back.points.size());
  for (std::size_t k = 0; k < forth.points.size(); ++k) {
    const RodPoint& a = forth.points[k];
    const RodPoint& b = back.points[back.points.size() - 1 - k];
    EXPECT_LT((a.position - b.position).norm(), 1e-10) << a.s;
    EXPECT_LT((a.force + b.force).norm(), 1e-7 * (1 + a.force.norm())) << a.s;
  }
}

}  // namespace
}  // namespace cprsim
