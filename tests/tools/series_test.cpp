// SPDX-License-Identifier: BSD-3-Clause
// Trajectories against each other: errors, attitudes, lags and frames whose values are known.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/math/so3.h"
#include "tools/series/alignment.h"
#include "tools/series/comparison.h"
#include "tools/series/read_series.h"

namespace cprsim {
namespace {

/// A point on a helix, and a body that turns about a skew axis; at `count` instants of 2 s.
Series helix(std::size_t count, double lag = 0) {
  Series series;
  series.path = "helix";
  for (const char* name : {"p.position.x", "p.position.y", "p.position.z"})
    series.columns.push_back({name, "m", {}});
  for (const char* name :
       {"p.orientation.x", "p.orientation.y", "p.orientation.z", "p.orientation.w"})
    series.columns.push_back({name, "1", {}});
  for (std::size_t k = 0; k < count; ++k) {
    const double t = 2.0 * static_cast<double>(k) / static_cast<double>(count - 1), s = t - lag;
    series.time.push_back(t);
    const Vec3 p(std::cos(5 * s), std::sin(5 * s), 0.3 * s);
    const Quat q(exp_so3(1.5 * s * Vec3(1, 2, 2) / 3));
    const double values[] = {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
    for (std::size_t i = 0; i < 7; ++i)
      series.columns[i].values.push_back(values[i]);
  }
  return series;
}

std::vector<QuantityPair> pairs_of(const Series& a, const Series& b) {
  std::vector<QuantityPair> pairs;
  for (std::size_t i = 0; i < quantities_of(a).size(); ++i)
    pairs.push_back({quantities_of(a)[i], quantities_of(b)[i]});
  return pairs;
}

TEST(Series, GroupsComponentsIntoVectorsAndAttitudes) {
  const auto quantities = quantities_of(helix(3));
  ASSERT_EQ(quantities.size(), 2U);
  EXPECT_EQ(quantities[0].name, "p.position");
  EXPECT_EQ(quantities[0].kind, QuantityKind::kVector);
  EXPECT_EQ(quantities[1].kind, QuantityKind::kAttitude);
  const Series scalars = parse_series("time [s],a.x,b [mm]\n0,1,2\n1,2,3\n", "t.csv");
  EXPECT_EQ(quantities_of(scalars).size(), 2U);
  EXPECT_DOUBLE_EQ(scalars.columns[1].values[1], 3e-3);
  EXPECT_EQ(scalars.columns[1].unit, "m");
}

TEST(Series, ReadsTumAndNamesTheLineThatIsNone) {
  const Series tum =
      parse_series("# t x y z qx qy qz qw\n0 1 2 3 0 0 0 1\n0.5 1 2 4 0 0 1 0\n", "a");
  ASSERT_EQ(tum.size(), 2U);
  EXPECT_EQ(tum.columns[2].name, "position.z");
  EXPECT_EQ(tum.columns[2].values[1], 4);
  for (const auto& [text, place] : {std::pair("0 1 2 3 0 0 0 1\n1 2 3\n", "a:2:"),
                                    std::pair("0 1 2 3 0 0 0 1\n0 1 2 3 0 0 0 1\n", "a:2:"),
                                    std::pair("t,x\n1,1\n0,2\n", "a:3:")}) {
    try {
      parse_series(text, "a");
      ADD_FAILURE() << text;
    } catch (const TableError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(place, 0), 0U) << error.what();
    }
  }
}

TEST(Comparison, LinearInterpolationErrsWithTheSquareOfTheStep) {
  const Series fine = helix(2001);
  double last = 0;
  for (const std::size_t count : {51U, 101U, 201U}) {
    const Series coarse = helix(count);
    const auto c = compare_quantity(coarse, quantities_of(coarse)[0], fine, quantities_of(fine)[0]);
    EXPECT_EQ(c.outside, 0U);
    if (last > 0) {
      EXPECT_NEAR(last / c.numbers.max, 4, 0.1);
    }
    last = c.numbers.max;
  }
  // h² / 8 times the largest acceleration, 25 m/s²
  EXPECT_NEAR(last, 0.01 * 0.01 / 8 * 25, 1e-6);
}

TEST(Comparison, AttitudesAreInterpolatedAlongTheArcAndSignsDoNotMatter) {
  Series coarse = helix(5);  // the body turns at a constant rate: an arc is exact
  const Series fine = helix(401);
  for (std::size_t i = 3; i < 7; ++i)
    coarse.columns[i].values[2] *= -1;
  const auto c = compare_quantity(coarse, quantities_of(coarse)[1], fine, quantities_of(fine)[1]);
  EXPECT_LT(c.numbers.max, 1e-14);
}

TEST(Comparison, NothingIsExtrapolatedAndHolesAreLeftOut) {
  Series half = helix(101), reference = helix(201);
  half.time.resize(51);
  reference.columns[1].values[10] = std::nan("");
  const auto c =
      compare_quantity(half, quantities_of(half)[0], reference, quantities_of(reference)[0]);
  EXPECT_EQ(c.time.size(), 100U);
  EXPECT_EQ(c.outside, 101U);
  EXPECT_DOUBLE_EQ(c.time.back(), 1.0);
}

TEST(Comparison, NumbersOfAKnownError) {
  std::vector<double> time;
  std::vector<QuantityValue> value, expected;
  for (int k = 0; k <= 100; ++k) {
    time.push_back(0.01 * k);
    expected.emplace_back(k, 0, 0, 0);
    value.emplace_back(k + 0.03 * k, 0.04 * k, 0, 0);  // errs by 0.05 k
  }
  const ErrorNumbers n = error_numbers(QuantityKind::kVector, time, value, expected);
  EXPECT_NEAR(n.max, 5, 1e-12);
  EXPECT_NEAR(n.max_time, 1, 1e-12);
  EXPECT_NEAR(n.mean, 2.5, 1e-12);
  EXPECT_NEAR(n.median, 2.5, 1e-12);
  EXPECT_NEAR(n.percentile_95, 4.75, 1e-12);
  EXPECT_NEAR(n.rms, 5 * std::sqrt(201.0 / 600), 1e-12);  // sum k² = n (n + 1)(2 n + 1) / 6
  EXPECT_NEAR(n.bias, 2.5, 1e-12);
  EXPECT_NEAR(n.range, 100, 1e-12);
}

TEST(Comparison, FindsTheLagThatWasPutIn) {
  const Series reference = helix(201);
  for (const double lag : {0.0371, -0.12, 0.0}) {
    const Series late = helix(2001, lag);
    const auto found = estimate_lag(late, reference, pairs_of(late, reference));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->seconds, lag, 1e-5) << lag;
    EXPECT_LT(found->after, 1e-4);
  }
}

TEST(Comparison, WhatDoesNotMoveHasNoLag) {
  Series still = helix(11);
  for (SeriesColumn& column : still.columns)
    std::fill(column.values.begin(), column.values.end(), 0.5);
  EXPECT_FALSE(estimate_lag(still, still, pairs_of(still, still)));
}

TEST(Alignment, FindsTheFrameThatWasPutIn) {
  const Series ours = helix(101);
  const auto positions = [](const Series& series) {
    MatX p(3, series.size());
    for (std::size_t k = 0; k < series.size(); ++k)
      p.col(static_cast<Eigen::Index>(k)) = value_at(series, quantities_of(series)[0], k).head<3>();
    return p;
  };
  for (const auto& [alignment, turn] : {std::pair(Alignment::kFull, Vec3(0.3, -2.5, 1.1)),
                                        std::pair(Alignment::kYaw, Vec3(0, 0, 2.9)),
                                        std::pair(Alignment::kTranslation, Vec3(0, 0, 0))}) {
    const Pose X{exp_so3(turn), Vec3(0.4, -1, 2)};
    Series theirs = ours;
    change_frame(theirs, X.inverse());
    const Pose found = fit_frame(alignment, positions(ours), positions(theirs));
    EXPECT_LT((found.R - X.R).norm(), 1e-12);
    EXPECT_LT((found.p - X.p).norm(), 1e-12);
    change_frame(theirs, found);
    const auto c = compare_quantity(theirs, quantities_of(theirs)[1], ours, quantities_of(ours)[1]);
    EXPECT_LT(c.numbers.max, 1e-12);
  }
}

TEST(Alignment, TangentsAlongXBecomeTangentsAlongZ) {
  Series series = helix(3);
  const Vec4 before = value_at(series, quantities_of(series)[1], 2);
  put_tangent_on_z(series);
  const Vec4 after = value_at(series, quantities_of(series)[1], 2);
  const Mat3 R = Quat(before[3], before[0], before[1], before[2]).toRotationMatrix();
  const Mat3 S = Quat(after[3], after[0], after[1], after[2]).toRotationMatrix();
  EXPECT_LT((S.col(2) - R.col(0)).norm(), 1e-12);
  EXPECT_LT((S.col(0) - R.col(1)).norm(), 1e-12);
  EXPECT_NEAR(S.determinant(), 1, 1e-12);
}

}  // namespace
}  // namespace cprsim
