// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/tableau.h"

#include <gtest/gtest.h>

#include "tests/engine/time/butcher.h"

namespace cprsim {
namespace {

constexpr double kRoundOff = 1e-15;  // of sums of numbers below 1

constexpr ArcIntegrator kAll[] = {ArcIntegrator::kEuler, ArcIntegrator::kRk4,
                                  ArcIntegrator::kGauss2, ArcIntegrator::kGauss4,
                                  ArcIntegrator::kGauss6};

ButcherTable butcher(const ArcTableau& t) {
  ButcherTable B;
  const auto n = static_cast<Eigen::Index>(t.stages);
  B.A = Eigen::Map<const Eigen::Matrix<double, kMaxStages, kMaxStages, Eigen::RowMajor>>(&t.a[0][0])
            .topLeftCorner(n, n);
  B.b = Eigen::Map<const VecX>(t.b, n);
  return B;
}

TEST(ArcTableau, MeetsTheConditionsOfItsOrderAndNoMore) {
  for (ArcIntegrator integrator : kAll) {
    const ArcTableau& t = arc_tableau(integrator);
    const int known = std::min(t.order, 4);
    EXPECT_LT(order_defect(butcher(t), known), kRoundOff) << t.name;
    if (t.order < 4) {
      EXPECT_GT(order_defect(butcher(t), t.order + 1), 1e-3) << t.name;
    }
  }
}

TEST(ArcTableau, NodesAreRowSums) {
  for (ArcIntegrator integrator : kAll) {
    const ArcTableau& t = arc_tableau(integrator);
    const VecX c = Eigen::Map<const VecX>(t.c, t.stages);
    EXPECT_LT((butcher(t).A.rowwise().sum() - c).norm(), kRoundOff) << t.name;
  }
}

// Collocation: B(2S) and C(S), from which order 2S follows (Butcher 1964).
TEST(ArcTableau, GaussIsCollocationAtTheGaussPoints) {
  for (ArcIntegrator integrator :
       {ArcIntegrator::kGauss2, ArcIntegrator::kGauss4, ArcIntegrator::kGauss6}) {
    const ArcTableau& t = arc_tableau(integrator);
    EXPECT_EQ(t.order, 2 * t.stages);
    EXPECT_LT(quadrature_defect(butcher(t), 2 * t.stages), kRoundOff) << t.name;
    EXPECT_GT(quadrature_defect(butcher(t), 2 * t.stages + 1), 1e-4) << t.name;
    EXPECT_LT(stage_defect(butcher(t), t.stages), kRoundOff) << t.name;
  }
}

TEST(ArcTableau, GaussIsSymmetric) {
  for (ArcIntegrator integrator :
       {ArcIntegrator::kGauss2, ArcIntegrator::kGauss4, ArcIntegrator::kGauss6}) {
    const ArcTableau& t = arc_tableau(integrator);
    for (int i = 0; i < t.stages; ++i)
      for (int j = 0; j < t.stages; ++j) {
        const int p = t.stages - 1 - i, q = t.stages - 1 - j;
        EXPECT_NEAR(t.a[i][j] + t.a[p][q], t.b[j], kRoundOff) << t.name;
      }
  }
}

}  // namespace
}  // namespace cprsim
