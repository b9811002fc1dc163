// SPDX-License-Identifier: BSD-3-Clause
// Runge-Kutta tables: order, stage order, stability function R(z) = 1 + z b^T (I - zA)^-1 e.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <complex>

#include "engine/time/scheme.h"
#include "tests/engine/time/butcher.h"

namespace cprsim {
namespace {

constexpr double kRoundOff = 2e-15;  // of sums of numbers near 1

const DirkTable* const kAll[] = {&tr_bdf2(), &esdirk32(), &esdirk43(), &sdirk3()};

ButcherTable butcher(const DirkTable& t) {
  ButcherTable B;
  const auto n = static_cast<Eigen::Index>(t.stages);
  B.A = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(&t.a[0][0])
            .topLeftCorner(n, n);
  B.b = B.A.row(n - 1).transpose();  // stiffly accurate: its rows say it, its type has no b
  return B;
}

ButcherTable embedded(const DirkTable& t) {
  ButcherTable B = butcher(t);
  B.b -= Eigen::Map<const VecX>(t.b_error, t.stages);
  return B;
}

std::complex<double> stability(const ButcherTable& t, std::complex<double> z) {
  const Eigen::Index n = t.b.size();
  const Eigen::MatrixXcd M =
      Eigen::MatrixXcd::Identity(n, n) - z * t.A.cast<std::complex<double>>();
  const Eigen::VectorXcd y = M.lu().solve(Eigen::VectorXcd::Ones(n));
  return 1. + z * t.b.cast<std::complex<double>>().dot(y);
}

TEST(DirkTable, MeetsTheConditionsOfItsOrderAndNoMore) {
  for (const DirkTable* t : kAll) {
    EXPECT_LT(order_defect(butcher(*t), t->order), kRoundOff) << t->name;
    if (t->order < 4) {
      EXPECT_GT(order_defect(butcher(*t), t->order + 1), 1e-3) << t->name;
    }
  }
}

TEST(DirkTable, EmbeddedFormulaMeetsTheConditionsOfItsOrder) {
  // rationals of Kennedy & Carpenter hold 25 digits between two integers; their quotient is rounded
  for (const DirkTable* t : kAll)
    EXPECT_LT(order_defect(embedded(*t), t->embedded_order), 1e-14) << t->name;
}

TEST(DirkTable, ErrorEstimateIsOfTheLowerOrderOfTheTwo) {
  for (const DirkTable* t : kAll) {
    ButcherTable difference = butcher(*t);
    difference.b = Eigen::Map<const VecX>(t->b_error, t->stages);
    EXPECT_GT(difference.b.norm(), 1e-2) << t->name;
    const int higher = std::min(4, t->embedded_order + 1);
    const double main = order_defect(butcher(*t), higher),
                 other = order_defect(embedded(*t), higher);
    EXPECT_GT(std::abs(main - other), 1e-4) << t->name;
  }
}

TEST(DirkTable, NodesAreRowSumsAndEndWithTheStep) {
  for (const DirkTable* t : kAll) {
    const VecX c = butcher(*t).A.rowwise().sum();
    for (int i = 0; i < t->stages; ++i)
      EXPECT_NEAR(t->c[i], c[i], kRoundOff) << t->name;
    EXPECT_NEAR(t->c[t->stages - 1], 1, kRoundOff) << t->name;
  }
}

TEST(DirkTable, DiagonalIsOneNumber) {
  for (const DirkTable* t : kAll)
    for (int i = 0; i < t->stages; ++i) {
      const bool explicit_stage = i == 0 && t->explicit_first;
      EXPECT_NEAR(t->a[i][i], explicit_stage ? 0 : t->diagonal, 1e-16) << t->name;
      for (int j = i + 1; j < t->stages; ++j)
        EXPECT_EQ(t->a[i][j], 0) << t->name;
    }
  EXPECT_EQ(sdirk3().diagonal, esdirk32().diagonal);
}

TEST(DirkTable, ExplicitFirstStageGivesStageOrderTwo) {
  for (const DirkTable* t : {&tr_bdf2(), &esdirk32(), &esdirk43()})
    EXPECT_LT(stage_defect(butcher(*t), 2), kRoundOff) << t->name;
  EXPECT_LT(stage_defect(butcher(sdirk3()), 1), kRoundOff);
}

TEST(DirkTable, IsLStable) {
  for (const DirkTable* t : kAll) {
    const ButcherTable B = butcher(*t);
    EXPECT_LT(std::abs(stability(B, -1e9)), 1e-7) << t->name;  // R falls at least like 1/z
    for (double y = 1e-3; y < 1e6; y *= 1.3)
      EXPECT_LE(std::abs(stability(B, {0, y})), 1 + 1e-13) << t->name << ", z = " << y << "i";
  }
}

}  // namespace
}  // namespace cprsim
