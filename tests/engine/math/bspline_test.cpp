// SPDX-License-Identifier: BSD-3-Clause
#include "engine/math/bspline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cprsim {
namespace {

const std::vector<double> kBreaks{-0.3, 0.1, 0.25, 0.9, 1.1};  // nothing uniform

std::vector<double> places() {
  std::vector<double> x = kBreaks;
  for (int i = 0; i <= 37; ++i)
    x.push_back(-0.3 + 1.4 * i / 37);
  return x;
}

Eigen::RowVectorXd value(const BsplineSpace& space, const MatX& control, double x) {
  const BasisValues b = space.basis(x);
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(control.cols());
  for (int j = 0; j <= space.degree(); ++j)
    sum += b.value[j] * control.row(b.first + j);
  return sum;
}

Eigen::RowVectorXd slope(const BsplineSpace& space, const MatX& control, double x) {
  const BasisValues b = space.basis(x);
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(control.cols());
  for (int j = 0; j <= space.degree(); ++j)
    sum += b.slope[j] * control.row(b.first + j);
  return sum;
}

/// Anything that is different in every entry.
MatX some_control_points(int n) {
  MatX c(n, 2);
  for (int i = 0; i < n; ++i)
    c.row(i) << std::sin(2.0 * i + 1), std::cos(1.3 * i * i);
  return c;
}

class Bspline : public ::testing::TestWithParam<int> {};

TEST_P(Bspline, FunctionsAreNotNegativeAndSumToOne) {
  const BsplineSpace space(GetParam(), kBreaks);
  EXPECT_EQ(space.size(), static_cast<int>(kBreaks.size()) - 1 + GetParam());
  for (double x : places()) {
    const BasisValues b = space.basis(x);
    double sum = 0, slopes = 0, steepest = 0;
    for (int j = 0; j <= space.degree(); ++j) {
      EXPECT_GE(b.value[j], 0) << x;
      sum += b.value[j];
      slopes += b.slope[j];
      steepest = std::max(steepest, std::abs(b.slope[j]));
    }
    EXPECT_NEAR(sum, 1, 1e-14) << x;
    EXPECT_NEAR(slopes, 0, 1e-14 * (1 + steepest)) << x;
  }
}

TEST_P(Bspline, SlopesAreThoseOfTheValues) {
  const BsplineSpace space(GetParam(), kBreaks);
  const MatX control = some_control_points(space.size());
  for (double x : {-0.21, 0.07, 0.18, 0.6, 1.03}) {
    const double h = 1e-4;
    const Eigen::RowVectorXd difference =
        (8 * (value(space, control, x + h) - value(space, control, x - h)) -
         (value(space, control, x + 2 * h) - value(space, control, x - 2 * h))) /
        (12 * h);
    EXPECT_LT((slope(space, control, x) - difference).norm(), 1e-8 * (1 + difference.norm())) << x;
  }
}

TEST_P(Bspline, CurvesStartAtTheFirstControlPointAndEndAtTheLast) {
  const BsplineSpace space(GetParam(), kBreaks);
  const MatX control = some_control_points(space.size());
  EXPECT_EQ(value(space, control, -0.3), control.row(0));
  EXPECT_EQ(value(space, control, 1.1), control.row(space.size() - 1));
}

TEST_P(Bspline, InterpolationReproducesPolynomialsOfTheDegree) {
  const BsplineSpace space(GetParam(), kBreaks);
  const std::vector<double> at = space.greville();
  const auto polynomial = [](double x) { return std::pow(x - 0.2, GetParam()) - 0.5 * x; };
  VecX values(space.size());
  for (int i = 0; i < space.size(); ++i)
    values[i] = polynomial(at[static_cast<std::size_t>(i)]);
  const MatX control = space.interpolate(values);
  for (double x : places())
    EXPECT_NEAR(value(space, control, x)[0], polynomial(x), 1e-13) << x;
}

// Greville abscissae are the control points of the identity.
TEST_P(Bspline, GrevilleAbscissaeAreTheControlPointsOfTheIdentity) {
  const BsplineSpace space(GetParam(), kBreaks);
  const std::vector<double> at = space.greville();
  const VecX control = Eigen::Map<const VecX>(at.data(), space.size());
  for (double x : places())
    EXPECT_NEAR(value(space, control, x)[0], x, 1e-14);
}

// Knot insertion: the same curve has control points in every finer space.
TEST_P(Bspline, CurvesAreUnchangedByMoreKnots) {
  const BsplineSpace coarse(GetParam(), kBreaks);
  const BsplineSpace fine(GetParam(), {-0.3, -0.05, 0.1, 0.25, 0.5, 0.52, 0.9, 1.1});
  const MatX control = some_control_points(coarse.size());
  const std::vector<double> at = fine.greville();
  MatX values(fine.size(), 2);
  for (int i = 0; i < fine.size(); ++i)
    values.row(i) = value(coarse, control, at[static_cast<std::size_t>(i)]);
  const MatX refined = fine.interpolate(values);
  for (double x : places()) {
    EXPECT_LT((value(fine, refined, x) - value(coarse, control, x)).norm(), 1e-12) << x;
    EXPECT_LT((slope(fine, refined, x) - slope(coarse, control, x)).norm(), 1e-10) << x;
  }
}

// The derivative's control points are scaled differences: Piegl & Tiller eq. 3.4.
TEST_P(Bspline, DerivativesAreSplinesOfOneDegreeLess) {
  const int p = GetParam();
  const BsplineSpace space(p, kBreaks), derivatives = space.derivatives();
  ASSERT_EQ(derivatives.size(), space.size() - 1);
  ASSERT_EQ(derivatives.degree(), p - 1);
  const MatX control = some_control_points(space.size());
  MatX differences(space.size() - 1, 2);
  for (int i = 0; i + 1 < space.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    differences.row(i) =
        p * (control.row(i + 1) - control.row(i)) /
        (space.knots()[k + static_cast<std::size_t>(p) + 1] - space.knots()[k + 1]);
  }
  for (double x : places())
    EXPECT_LT((value(derivatives, differences, x) - slope(space, control, x)).norm(), 1e-12) << x;
}

TEST_P(Bspline, WeightsIntegrateTheSplinesAndArePositive) {
  const BsplineSpace space = BsplineSpace(GetParam(), kBreaks).derivatives();
  const MatX control = some_control_points(space.size());
  const VecX weights = space.greville_weights();
  const std::vector<double> at = space.greville();
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(2);
  for (int i = 0; i < space.size(); ++i)
    sum += weights[i] * value(space, control, at[static_cast<std::size_t>(i)]);
  // midpoints of a fine grid that has the breaks among its nodes
  Eigen::RowVectorXd fine = Eigen::RowVectorXd::Zero(2);
  const int n = 28000;
  for (int i = 0; i < n; ++i)
    fine += 1.4 / n * value(space, control, -0.3 + 1.4 * (i + 0.5) / n);
  EXPECT_LT((sum - fine).norm(), 1e-6);
  EXPECT_NEAR(weights.sum(), 1.4, 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Degrees, Bspline, ::testing::Range(2, kMaxDegree + 1));

TEST_P(Bspline, WithWeightsIsRationalAndSumsToOne) {
  BsplineSpace space(GetParam(), kBreaks);
  VecX weights(space.size());
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    weights[i] = 1.5 + std::sin(3.0 * static_cast<double>(i));
  space.weigh(weights);
  const MatX control = some_control_points(space.size());
  for (double x : places()) {
    const BasisValues b = space.basis(x);
    double sum = 0, slopes = 0;
    for (int j = 0; j <= space.degree(); ++j) {
      EXPECT_GE(b.value[j], 0) << x;
      sum += b.value[j];
      slopes += b.slope[j];
    }
    EXPECT_NEAR(sum, 1, 1e-14) << x;
    EXPECT_NEAR(slopes, 0, 1e-11) << x;
    const double h = 1e-5;
    const bool at_break = std::any_of(kBreaks.begin(), kBreaks.end(),
                                      [&](double end) { return std::abs(x - end) <= h; });
    if (at_break) continue;
    const Eigen::RowVectorXd difference =
        (value(space, control, x + h) - value(space, control, x - h)) / (2 * h);
    EXPECT_LT((slope(space, control, x) - difference).norm(), 1e-6) << x;
  }
  const MatX same = space.interpolate([&] {
    MatX values(space.size(), 2);
    const std::vector<double> at = space.greville();
    for (int i = 0; i < space.size(); ++i)
      values.row(i) = value(space, control, at[static_cast<std::size_t>(i)]);
    return values;
  }());
  EXPECT_LT((same - control).norm(), 1e-9);
}

// Piegl & Tiller, "The NURBS book", example 7.1: what no polynomial is.
TEST(Bspline, WithWeightsIsACircle) {
  BsplineSpace quadratic(2, {0, 1});
  quadratic.weigh(Vec3(1, std::sqrt(0.5), 1));
  MatX control(3, 2);
  control << 1, 0, 1, 1, 0, 1;
  for (double x = 0; x <= 1; x += 0.125) {
    const Eigen::RowVectorXd at = value(quadratic, control, x);
    EXPECT_NEAR(at.norm(), 1, 1e-15);
    EXPECT_NEAR(at.dot(slope(quadratic, control, x)), 0, 1e-15);
  }
}

TEST(Bspline, HasTheKnownValuesOnUniformKnots) {
  const BsplineSpace quadratic(2, {0, 1, 2, 3, 4, 5}), cubic(3, {0, 1, 2, 3, 4, 5});
  const BasisValues q = quadratic.basis(2.5), c = cubic.basis(2);
  EXPECT_EQ(q.first, 2);
  for (int j = 0; j < 3; ++j)
    EXPECT_NEAR(q.value[j], (std::vector<double>{1. / 8, 6. / 8, 1. / 8})[std::size_t(j)], 1e-15);
  EXPECT_EQ(c.first, 2);
  for (int j = 0; j < 4; ++j) {
    EXPECT_NEAR(c.value[j], (std::vector<double>{1. / 6, 4. / 6, 1. / 6, 0})[std::size_t(j)],
                1e-15);
    EXPECT_NEAR(c.slope[j], (std::vector<double>{-0.5, 0, 0.5, 0})[std::size_t(j)], 1e-15);
  }
}

// Uniform knots, as rods have them between loads: no weight is negative, so energies are not.
TEST(Bspline, GrevilleWeightsArePositiveOnUniformKnots) {
  for (int degree = 1; degree < kMaxDegree; ++degree)
    for (int pieces : {1, 2, 3, 5, 16}) {
      std::vector<double> breaks;
      for (int i = 0; i <= pieces; ++i)
        breaks.push_back(i);
      EXPECT_GT(BsplineSpace(degree, breaks).greville_weights().minCoeff(), 0)
          << "degree " << degree << ", pieces " << pieces;
    }
}

}  // namespace
}  // namespace cprsim
