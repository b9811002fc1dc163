// SPDX-License-Identifier: BSD-3-Clause
#include "engine/math/banded_elimination.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/linear_solve.h"

namespace cprsim {
namespace {

constexpr int kRows = 19, kColumns = 22, kLower = 4, kUpper = 6, kDense = 2;

/// Zeros on the diagonal, so that nothing goes without interchanges.
double entry(int r, int c) {
  return r == c ? 0 : std::sin(1.7 * r + 0.9 * c * c + 0.3);
}

double dense_entry(int r, int c) {
  return std::cos(2.1 * r - c);
}

struct System {
  BandedElimination band;
  MatX A = MatX::Zero(kRows, kColumns), B = MatX::Zero(kRows, kDense);

  System() {
    band.reset(kRows, kColumns, kLower, kUpper, kDense);
    for (int r = 0; r < kRows; ++r) {
      for (int c = std::max(0, r - kLower); c <= std::min(kColumns - 1, r + kUpper); ++c)
        A(r, c) = band.at(r, c) = entry(r, c) * (r % 3 == 0 ? 1e6 : 1);
      for (int c = 0; c < kDense; ++c)
        B(r, c) = band.dense(r, c) = dense_entry(r, c);
    }
  }
};

// Whatever the last unknowns are, substitution meets every eliminated row, and the remaining rows
// are the rest.
TEST(BandedElimination, MeetsTheRowsItHasEliminated) {
  for (bool scaled : {false, true}) {
    System s;
    if (scaled) s.band.scale_rows();
    const int count = kColumns - 5;
    ASSERT_TRUE(s.band.eliminate(count));
    const MatX left = s.band.remaining(), left_dense = s.band.remaining_dense();
    ASSERT_EQ(left.rows(), kRows - count);
    ASSERT_EQ(left.cols(), 5);
    MatX w(kDense, 3);
    w << 1, -2, 0, 0.5, 3, 1;
    MatX free = MatX::Random(3, 3);
    // two rows remain: the first two of the last five unknowns follow from the other three
    MatX last(5, 3);
    last.bottomRows(3) = free;
    last.topRows(2) = -solve_columns(left.leftCols(2), left.rightCols(3) * free + left_dense * w);
    const MatX x = s.band.substitute(last, w);
    const MatX rows =
        s.A.rowwise().lpNorm<Eigen::Infinity>().cwiseInverse().asDiagonal() * (s.A * x + s.B * w);
    EXPECT_LT(rows.cwiseAbs().maxCoeff(), 1e-13 * x.cwiseAbs().maxCoeff()) << "scaled " << scaled;
    EXPECT_EQ(x.bottomRows(5), last);
  }
}

TEST(BandedElimination, ReportsAColumnWithoutPivot) {
  System s;
  for (int r = 3; r <= 7 + kLower; ++r)
    s.band.at(r, 7) = 0;
  EXPECT_TRUE(System().band.eliminate(kRows));
  for (int r = 1; r < 3; ++r)
    s.band.at(r, 7) = 0;
  EXPECT_FALSE(s.band.eliminate(kRows));
}

}  // namespace
}  // namespace cprsim
