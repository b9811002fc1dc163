// SPDX-License-Identifier: BSD-3-Clause
// What a linearisation says about parameters, against closed forms of linear regression.
#include "engine/fit/confidence.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cprsim {
namespace {

ConfidenceOptions options_for(const MatX& J) {
  ConfidenceOptions options;
  options.derivative_error = VecX::Constant(J.cols(), 1e-9);
  options.widest = VecX::Constant(J.cols(), 1e9);
  options.fixed.assign(static_cast<std::size_t>(J.cols()), false);
  return options;
}

/// A line through n points: columns 1 and x = 0, 1, ... n - 1.
MatX line(int n) {
  MatX J(n, 2);
  for (int i = 0; i < n; ++i)
    J.row(i) << 1, i;
  return J;
}

TEST(StudentT, HasTheValuesOfTheTables) {
  // Abramowitz & Stegun, table 26.10, and the closed forms tan(0.475 pi) for 1, normal for infinity
  EXPECT_NEAR(student_t(0.95, 1), std::tan(0.475 * std::acos(-1.0)), 1e-9);
  EXPECT_NEAR(student_t(0.95, 2), 4.302652729911275, 1e-9);
  EXPECT_NEAR(student_t(0.95, 10), 2.2281388519649385, 1e-9);
  EXPECT_NEAR(student_t(0.99, 30), 2.749995653567231, 1e-9);
  EXPECT_NEAR(student_t(0.95, 0), 1.959963984540054, 1e-9);
  EXPECT_NEAR(student_t(0.95, 1000000), student_t(0.95, 0), 1e-5);
}

TEST(Confidence, IsThatOfARegressionLine) {
  const int n = 7;
  const MatX J = line(n);
  VecX r(n);
  r << 1, -1, 0, 0.5, -0.5, -1, 1;
  const Confidence c = confidence(J, r, options_for(J));
  // slope: sigma / sqrt(sum (x - mean)^2), mean 3, sum 28; intercept: sigma sqrt(1/n + 9/28)
  const double sigma = r.norm() / std::sqrt(n - 2.0);
  EXPECT_EQ(c.freedom, n - 2);
  EXPECT_NEAR(c.sigma, sigma, 1e-14);
  EXPECT_NEAR(c.standard_error[1], sigma / std::sqrt(28), 1e-13);
  EXPECT_NEAR(c.standard_error[0], sigma * std::sqrt(1.0 / n + 9.0 / 28), 1e-13);
  EXPECT_NEAR(c.half_width[1], student_t(0.95, n - 2) * sigma / std::sqrt(28), 1e-12);
  EXPECT_NEAR(c.correlation(0, 1), -3 / std::sqrt(28.0 / n + 9), 1e-13);
}

TEST(Confidence, TakesSigmaAsGivenWhereItIs) {
  const MatX J = line(7);
  ConfidenceOptions options = options_for(J);
  options.sigma_known = true;
  const Confidence c = confidence(J, VecX::Constant(7, 100), options);
  EXPECT_NEAR(c.standard_error[1], 1 / std::sqrt(28), 1e-14);
  EXPECT_NEAR(c.half_width[1], 1.959963984540054 / std::sqrt(28), 1e-10);
  EXPECT_NEAR(c.reduced_chi_square, 7e4 / 5, 1e-9);
}

TEST(Confidence, NamesWhatNothingDependsOn) {
  MatX J(7, 3);
  J << line(7), VecX::Constant(7, 1e-10);
  const Confidence c = confidence(J, VecX::Ones(7), options_for(J));
  EXPECT_EQ(c.observable[2], Observability::kNoInfluence);
  EXPECT_TRUE(std::isnan(c.standard_error[2]));
  EXPECT_EQ(c.observable[0], Observability::kObservable);
  ASSERT_EQ(c.combinations.size(), 1U);
  EXPECT_EQ(c.combinations[0], VecX::Unit(3, 2));
}

TEST(Confidence, NamesTheCombinationAndLeavesTheOthersAlone) {
  // column 2 is twice column 1: z1 = 2, z2 = -1 changes nothing; column 0 stands for itself
  MatX J(7, 3);
  J << line(7), 2 * line(7).col(1);
  const Confidence c = confidence(J, VecX::Ones(7), options_for(J));
  EXPECT_EQ(c.observable[0], Observability::kObservable);
  EXPECT_EQ(c.observable[1], Observability::kDependent);
  EXPECT_EQ(c.observable[2], Observability::kDependent);
  ASSERT_EQ(c.combinations.size(), 1U);
  const VecX& v = c.combinations[0];
  EXPECT_NEAR(v[0], 0, 1e-12);
  EXPECT_NEAR(v[1] / v[2], -2, 1e-9);
  EXPECT_GT(c.condition, 1e9);
}

TEST(Confidence, SaysWhenAnIntervalIsAsWideAsItsBounds) {
  const MatX J = line(7);
  ConfidenceOptions options = options_for(J);
  options.widest << 0.1, 1e9;
  const Confidence c = confidence(J, VecX::Ones(7), options);
  EXPECT_EQ(c.observable[0], Observability::kTooUncertain);
  EXPECT_EQ(c.observable[1], Observability::kObservable);
}

TEST(Confidence, CountsNoParameterThatIsHeld) {
  const MatX J = line(7);
  ConfidenceOptions options = options_for(J);
  options.fixed[1] = true;
  const Confidence c = confidence(J, VecX::Ones(7), options);
  EXPECT_EQ(c.freedom, 6);
  EXPECT_NEAR(c.standard_error[0], std::sqrt(7.0 / 6) / std::sqrt(7.0), 1e-14);
  EXPECT_TRUE(std::isnan(c.standard_error[1]));
}

}  // namespace
}  // namespace cprsim
