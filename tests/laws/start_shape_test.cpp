// SPDX-License-Identifier: BSD-3-Clause
// Rods that start in a shape that the scene gives them, by every method: the curve through its
// points against a helix, the equilibrium that it leads to against the elastica.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/math/so3.h"
#include "engine/rod/rod_curve.h"
#include "engine/run/simulation.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kPi = std::numbers::pi;

/// Along a helix of radius a and pitch 2 pi b about z, one metre of it.
Vec3 helix(double s) {
  constexpr double a = 0.1, b = 0.05;
  const double t = s / std::hypot(a, b);
  return {a * std::cos(t), a * std::sin(t), b * t};
}

std::vector<CurveSample> sampled(int pieces) {
  std::vector<CurveSample> samples;
  for (int i = 0; i <= pieces; ++i) {
    const double s = static_cast<double>(i) / pieces;
    samples.push_back({s, helix(s)});
  }
  return samples;
}

// kappa = a / (a² + b²), whatever the axes are; untwisted sections turn about no tangent.
double worst_curvature(int pieces) {
  const RodCurve curve(sampled(pieces), 1, Mat3::Identity(), nullptr);
  double worst = 0;
  for (int i = 0; i <= 500; ++i) {
    const Vec3 u = curve.curvature(i / 500.);
    worst = std::max({worst, std::abs(u.norm() - 8), std::abs(u.z())});
  }
  return worst;
}

TEST(RodCurve, HasTheCurvatureOfAHelixToSecondOrder) {
  const double coarse = worst_curvature(50), fine = worst_curvature(100);
  EXPECT_LT(fine, 0.01 * 8);
  EXPECT_GT(std::log2(coarse / fine), 1.8);
}

TEST(RodCurve, ItsSectionsTurnAsItsCurvatureSays) {
  const Mat3 tip = exp_so3(Vec3(0.3, -0.2, 1.1));
  for (const Mat3* end : {static_cast<const Mat3*>(nullptr), &tip}) {
    const RodCurve curve(sampled(100), 1, Mat3::Identity(), end);
    constexpr double h = 1e-4;
    for (double s : {0.013, 0.31, 0.777}) {
      const Vec3 turned = log_so3(curve.pose(s - h).R.transpose() * curve.pose(s + h).R) / (2 * h);
      EXPECT_LT((turned - curve.curvature(s)).norm(), 0.02) << s;
      EXPECT_LT((curve.pose(s).p - helix(s)).norm(), 1e-6) << s;
    }
  }
}

TEST(RodCurve, MeetsTheTipsAxesByTwist) {
  const RodCurve straight(sampled(100), 1, Mat3::Identity(), nullptr);
  const Mat3 tip = straight.pose(1).R * exp_so3(Vec3(0, 0, 2));
  const RodCurve twisted(sampled(100), 1, Mat3::Identity(), &tip);
  EXPECT_LT((twisted.pose(1).R - tip).norm(), 1e-9);
  EXPECT_NEAR(twisted.curvature(0.4).z(), 2, 1e-9);
}

class StartShape : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, StartShape, ::testing::ValuesIn(kEveryMethod), test_name);

/// A rod of 1 m along x, clamped with its ends 0.9 m apart, that starts as a bow of one wave above
/// (1) or below (-1).
Scene arch(double side) {
  Scene scene;
  RodSpec rod = steel_rod(1, 1e-3);
  const Mat3 along_x = exp_so3(Vec3(0, kPi / 2, 0));
  rod.base.at.X_BF.R = along_x;
  rod.tip = rod.base;
  rod.tip.at.X_BF.p.x() = 0.9;
  for (int i = 0; i <= 60; ++i) {
    const double s = i / 60.;
    // that s is the length along it, but for terms of fourth order in its height
    rod.start.push_back(
        {s,
         {0.9 * s + 0.0079 * std::sin(4 * kPi * s), 0, side * 0.1 * (1 - std::cos(2 * kPi * s))}});
  }
  scene.rods.push_back(rod);
  scene.simulation.initial_static = true;
  return scene;
}

// Of the elastica between clamps (Love, Mathematical Theory of Elasticity, section 262) with
// modulus p: 2 E / K - 1 is the distance of the ends over the length, p / K the height of its
// middle.
constexpr double kHeight = 0.19492431137557384;

double middle_of(const Scene& scene, bool planar) {
  Scene held = scene;
  if (planar) held.planar_normal = Vec3::UnitY();
  Simulation simulation(held);
  EXPECT_TRUE(simulation.start().converged()) << simulation.failure();
  const std::vector<RodPoint>& points = simulation.now().rods[0].points;
  for (const RodPoint& point : points)
    if (std::abs(point.s - 0.5) < 1e-12) return point.position.z();
  ADD_FAILURE() << "no point in the middle";
  return 0;
}

TEST_P(StartShape, LeadsToTheEquilibriumOnItsSide) {
  for (const double side : {1., -1.})
    for (const bool planar : {false, true})
      EXPECT_NEAR(middle_of(finely(arch(side), GetParam()), planar), side * kHeight, 1e-8)
          << side << (planar ? " in a plane" : "");
}

// A quarter of a circle that is let go: it is there, at rest, with the energy of its bending but
// for what the free end, which bears no moment, straightens; and none is made.
TEST_P(StartShape, IsWhereMotionBegins) {
  Scene scene;
  RodSpec rod = steel_rod(1, 1e-3);
  constexpr double R = 2 / kPi;
  for (int i = 0; i <= 40; ++i) {
    const double angle = kPi / 2 * i / 40;
    rod.start.push_back({i / 40., {0, R * (1 - std::cos(angle)), R * std::sin(angle)}});
  }
  const double EI = bending_stiffness(rod);
  scene.rods.push_back(rod);
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.duration = 0.02;
  scene.max_step_size = 1e-3;
  scene.solver.scheme = SchemeKind::kBackwardEuler;
  for (const bool planar : {false, true}) {
    Scene let_go = finely(scene, GetParam());
    if (planar) let_go.planar_normal = Vec3::UnitX();
    Simulation simulation(let_go);
    ASSERT_TRUE(simulation.start().converged()) << simulation.failure();
    for (const RodPoint& point : simulation.now().rods[0].points) {
      const double angle = kPi / 2 * point.s;
      const Vec3 there(0, R * (1 - std::cos(angle)), R * std::sin(angle));
      EXPECT_LT((point.position - there).norm(), 1e-3) << point.s;
      EXPECT_LT(point.velocity.norm(), 1e-12) << point.s;
    }
    const double begun = simulation.now().energy.total, bent = EI / (2 * R * R);
    EXPECT_NEAR(begun, bent, 0.03 * bent);
    while (simulation.status() == RunStatus::kRunning) {
      simulation.advance();
      EXPECT_LE(simulation.now().energy.total, begun * (1 + 1e-6));
    }
    EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    EXPECT_GT(simulation.now().energy.kinetic, 0.01 * begun);
  }
}

}  // namespace
}  // namespace cprsim
