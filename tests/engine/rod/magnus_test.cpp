// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/magnus.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/legendre.h"
#include "engine/math/so3.h"
#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

Vec3 curvature(double s) {
  return {2 * std::cos(3 * s), 1.5 - s * s, 3 * std::sin(2 * s) - 1};
}

Mat3 at_gauss_points(double from, double h) {
  const GaussRule rule = gauss_rule(3);
  Mat3 u;
  for (Eigen::Index g = 0; g < 3; ++g)
    u.col(g) = curvature(from + h * rule.points[g]);
  return u;
}

/// Over [0, 1.6] in equal steps.
Mat3 turned(int steps) {
  Mat3 R = Mat3::Identity();
  const double h = 1.6 / steps;
  for (int i = 0; i < steps; ++i)
    R = R * exp_so3(magnus_step(h, at_gauss_points(i * h, h)));
  return R;
}

TEST(Magnus, IsOfSixthOrder) {
  const Mat3 exact = turned(400);
  const double coarse = (turned(8) - exact).norm(), fine = (turned(16) - exact).norm();
  EXPECT_NEAR(std::log2(coarse / fine), 6, 0.3) << coarse << ", " << fine;
}

TEST(Magnus, TurnsTheWayTheCurvatureSays) {
  // R_s = R u^, by differences of a short step
  const double h = 1e-4;
  const Mat3 R = exp_so3(magnus_step(h, at_gauss_points(0.7, h)));
  const Mat3 rate = (R - R.transpose()) / (2 * h);
  EXPECT_LT((rate - hat(curvature(0.7 + 0.5 * h))).norm(), 1e-7);
}

TEST(Magnus, OfConstantCurvatureIsExact) {
  Mat3 u;
  u.colwise() = Vec3(3, -2, 5);
  EXPECT_LT((magnus_step(0.8, u) - 0.8 * Vec3(3, -2, 5)).norm(), 1e-14);
}

TEST(Magnus, BackwardsIsTheInverse) {
  const Mat3 u = at_gauss_points(0.1, 0.9);
  EXPECT_LT((magnus_step(0.9, u) + magnus_step(-0.9, u.rowwise().reverse())).norm(), 1e-14);
}

TEST(Magnus, TangentIsItsDerivative) {
  const Mat3 u = at_gauss_points(0.1, 0.9);
  const auto f = [](const Mat3& at) { return VecX(magnus_step(0.9, at)); };
  const auto add = [](const Mat3& at, const VecX& d) {
    return Mat3(at + Eigen::Map<const Mat3>(d.data()));
  };
  EXPECT_LT((magnus_tangent(0.9, u) - difference_jacobian(f, u, 9, add)).cwiseAbs().maxCoeff(),
            1e-10);
}

}  // namespace
}  // namespace cprsim
