// SPDX-License-Identifier: BSD-3-Clause
#include "engine/math/legendre.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cprsim {
namespace {

TEST(Legendre, PolynomialsAreOrthonormal) {
  constexpr int kDegree = 20;
  const GaussRule rule = gauss_rule(kDegree + 1);
  MatX gram = MatX::Zero(kDegree + 1, kDegree + 1);
  for (Eigen::Index i = 0; i < rule.points.size(); ++i) {
    const VecX phi = legendre(rule.points[i], kDegree);
    gram += rule.weights[i] * phi * phi.transpose();
  }
  EXPECT_LT((gram - MatX::Identity(kDegree + 1, kDegree + 1)).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Legendre, GaussRuleIsExactUpToTwiceItsPoints) {
  for (int n : {1, 2, 3, 7, 16, 44}) {
    const GaussRule rule = gauss_rule(n);
    const auto integral = [&](int power) {
      return rule.weights.dot(rule.points.unaryExpr([&](double x) { return std::pow(x, power); }));
    };
    for (int power = 0; power <= 2 * n - 1; ++power)
      EXPECT_NEAR(integral(power), 1.0 / (power + 1), 1e-14) << n << " points, x^" << power;
    if (n < 8) {
      EXPECT_GT(std::abs(integral(2 * n) - 1.0 / (2 * n + 1)), 1e-9) << n;
    }
  }
}

TEST(Legendre, IntegrationMatrixIsExactForPolynomialsBelowItsSize) {
  const GaussRule rule = gauss_rule(6);
  const MatX a = integration_matrix(rule);
  for (int power = 0; power < 6; ++power) {
    const auto of = [&](int p) {
      return VecX(rule.points.unaryExpr([p](double x) { return std::pow(x, p); }));
    };
    EXPECT_LT((a * of(power) - of(power + 1) / (power + 1)).cwiseAbs().maxCoeff(), 1e-15) << power;
    EXPECT_NEAR(interpolation_weights(rule, 0.3).dot(of(power)), std::pow(0.3, power), 1e-14);
  }
}

TEST(Legendre, IntegralsAreThoseOfThePolynomials) {
  for (double x : {0., 0.2, 0.77, 1.}) {
    const GaussRule rule = gauss_rule(8);
    VecX expected = VecX::Zero(13);
    for (Eigen::Index i = 0; i < rule.points.size(); ++i)
      expected += x * rule.weights[i] * legendre(x * rule.points[i], 12);
    EXPECT_LT((legendre_integrals(x, 12) - expected).cwiseAbs().maxCoeff(), 1e-14) << x;
  }
}

}  // namespace
}  // namespace cprsim
