// SPDX-License-Identifier: BSD-3-Clause
#include "engine/math/so3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRoundOff = 1e-15;

/// Directions with nothing special, and axes.
std::vector<Vec3> directions() {
  return {Vec3(0.48, -0.6, 0.64), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1),
          Vec3(1, 1, -1).normalized()};
}

/// Zero, tiny, both sides of where series end, large, near pi.
constexpr double kAngles[] = {0, 1e-12, 1e-8, 1e-4, 0.1, 0.4999, 0.5001, 1, 2, 3, kPi - 1e-8};

Mat3 eigen_rotation(double angle, const Vec3& axis) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

TEST(So3, ExpIsTheRotationByItsVector) {
  for (const Vec3& a : directions())
    for (double t : kAngles) {
      EXPECT_LT((exp_so3(t * a) - eigen_rotation(t, a)).norm(), 3 * kRoundOff) << t;
      EXPECT_LT((exp_so3(t * a).transpose() * exp_so3(t * a) - Mat3::Identity()).norm(),
                3 * kRoundOff)
          << t;
    }
}

TEST(So3, RotationBetweenIsTheShortestTurn) {
  const Vec3 a(0.48, -0.6, 0.64);
  const Vec3 across = a.cross(Vec3(0.3, 0.5, -0.2)).normalized();
  for (double t : {0., 1e-9, 0.3, 1.5, 2.6, 2.7, 3., kPi - 1e-4, kPi - 1e-9}) {
    const Vec3 b = std::cos(t) * a + std::sin(t) * across.cross(a);
    const Mat3 R = rotation_between(2 * a, 0.5 * b);
    EXPECT_LT((R - eigen_rotation(t, across)).norm(), 1e-14 + 1e-15 / (kPi - t)) << t;
  }
}

TEST(So3, RotationBetweenOppositeDirectionsIsHalfATurn) {
  for (const Vec3& a : directions()) {
    const Mat3 R = rotation_between(a, -a);
    EXPECT_LT((R * a + a).norm(), 2 * kRoundOff);
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), 4 * kRoundOff);
    EXPECT_NEAR(R.trace(), -1, 4 * kRoundOff);
  }
}

TEST(So3, LogInvertsExp) {
  for (const Vec3& a : directions())
    for (double t : kAngles) {
      // relative for small angles: a log good to 1e-8 of itself would pass an absolute bound
      const double error = (log_so3(exp_so3(t * a)) - t * a).norm();
      EXPECT_LT(error, t < 1e-3 ? 1e-15 * t + 1e-17 * (t > 0) + 1e-300 : 4 * kRoundOff) << t;
    }
}

TEST(So3, LogOfAHalfTurnIsItsAxisUpToSign) {
  for (const Vec3& a : directions()) {
    const Vec3 theta = log_so3(2 * a * a.transpose() - Mat3::Identity());
    EXPECT_NEAR(theta.norm(), kPi, 2 * kRoundOff);
    EXPECT_LT(theta.cross(a).norm(), 1e-7);  // the axis is a square root of round-off near a pole
  }
}

TEST(So3, RightJacobianTurnsRatesIntoBodyAngularVelocity) {
  for (const Vec3& a : directions())
    for (double t : kAngles) {
      const Vec3 theta = t * a;
      const auto f = [&](const VecX& d) -> VecX {
        return log_so3(exp_so3(theta).transpose() * exp_so3(theta + d));
      };
      // truncation (1e-3)^4 and round-off 1e-16/1e-3
      EXPECT_TRUE(jacobians_agree(right_jacobian(theta), difference_jacobian(f, VecX::Zero(3)),
                                  1e-11, 1e-11))
          << t;
    }
}

TEST(So3, RightJacobianInverseInverts) {
  for (const Vec3& a : directions())
    for (double t : {0., 1e-8, 0.4999, 0.5001, 1., 3., kPi, 4., 6.}) {
      const Mat3 I = right_jacobian(t * a) * right_jacobian_inverse(t * a);
      // J_r is singular at 2 pi
      EXPECT_LT((I - Mat3::Identity()).norm(), 4 * kRoundOff / (1 - t / (2 * kPi))) << t;
    }
}

TEST(So3, RightJacobianDerivativeIsTheDerivative) {
  const Vec3 w(0.7, -0.4, 1.1);
  for (const Vec3& a : directions())
    for (double t : kAngles) {
      const auto f = [&](const VecX& theta) -> VecX { return right_jacobian(theta) * w; };
      EXPECT_TRUE(jacobians_agree(right_jacobian_derivative(t * a, w),
                                  difference_jacobian(f, VecX(t * a)), 1e-11, 1e-11))
          << t;
    }
}

TEST(So3, SeriesAndClosedFormAgreeWhereTheyMeet) {
  const Vec3 w(0.7, -0.4, 1.1);
  for (const Vec3& a : directions()) {
    const Vec3 below = (0.5 - 2e-16) * a, above = (0.5 + 2e-16) * a;
    const auto jump = [&](const auto& f) { return (f(above) - f(below)).cwiseAbs().maxCoeff(); };
    EXPECT_LT(jump(exp_so3), kRoundOff);
    EXPECT_LT(jump(right_jacobian), 2 * kRoundOff);
    EXPECT_LT(jump(right_jacobian_inverse), kRoundOff);
    // the closed form of B' subtracts numbers near 1 to |theta|^5 / 60 and divides by |theta|^5
    EXPECT_LT(jump([&](const Vec3& theta) { return right_jacobian_derivative(theta, w); }),
              60 * kRoundOff);
  }
}

TEST(So3, HatIsTheCrossProduct) {
  const Vec3 a(1, 2, 3), b(-0.4, 0.7, 0.9);
  EXPECT_EQ(hat(a) * b, a.cross(b));
}

TEST(So3, OrthonormalizedRemovesDrift) {
  const Mat3 R = exp_so3({0.4, -1.2, 0.8});
  Mat3 drifted = R;
  drifted(0, 1) += 1e-9;
  drifted(2, 2) -= 2e-9;
  const Mat3 clean = orthonormalized(drifted);
  EXPECT_LT((clean.transpose() * clean - Mat3::Identity()).norm(), kRoundOff);
  EXPECT_LT((clean - R).norm(), 3e-9);  // no farther than what came in
}

}  // namespace
}  // namespace cprsim
