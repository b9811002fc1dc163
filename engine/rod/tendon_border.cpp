// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/tendon_border.h"

#include <Eigen/LU>

namespace cprsim {
namespace {

constexpr Eigen::Index kOuter = 13;  // z, zeta_A, 1

/// out += by_x X, X's columns those of (z, zeta_A, 1).
void substitute(const MatX& by_x, const MatX& X, Mat6& by_z, Mat6& by_A, Vec6& affine) {
  by_z += by_x * X.leftCols<6>();
  by_A += by_x * X.middleCols<6>(6);
  affine += by_x * X.col(12);
}

}  // namespace

bool TendonBorder::linearize(TensionedRod& rod, const RodTendons& tendons, const Port& base,
                             const Port& tip, CondensedRod& out) {
  const Eigen::Index m = tendons.unknowns();
  const Vec6 none = Vec6::Zero();
  if (!rod.linearize_given(base, tip, out)) return false;
  const VecX affine = rod.direction_given(none, none);
  const Eigen::Index n = affine.size();
  MatX Y(n, kOuter + m), T_x(6, m), WA_x(6, m), WB_x(6, m);
  for (Eigen::Index i = 0; i < 6; ++i) {
    Y.col(i) = rod.direction_given(Vec6::Unit(i), none) - affine;
    Y.col(6 + i) = rod.direction_given(none, Vec6::Unit(i)) - affine;
  }
  Y.col(12) = affine;
  for (Eigen::Index k = 0; k < m; ++k) {
    CondensedRod by;
    rod.add_tension(k, true);
    const bool regular = rod.linearize_given(base, tip, by);
    rod.add_tension(k, false);
    if (!regular) return false;
    Y.col(kOuter + k) = rod.direction_given(none, none) - affine;
    T_x.col(k) = by.t - out.t;
    WA_x.col(k) = by.wa - out.wa;
    WB_x.col(k) = by.wb - out.wb;
  }
  // (1)
  MatX rows(m, kOuter + m);
  for (Eigen::Index c = 0; c < rows.cols(); ++c)
    rows.col(c) = tendons.gap_rates(rod.strain_rates(Y.col(c)));
  rows.col(12) += tendons.gaps();
  rows.rightCols(m).diagonal() += tendons.gaps_by_tension();
  const Eigen::FullPivLU<MatX> lu(rows.rightCols(m));
  if (!lu.isInvertible()) return false;
  const MatX X = -lu.solve(rows.leftCols(kOuter));
  substitute(T_x, X, out.T, out.T_A, out.t);
  substitute(WA_x, X, out.WA_z, out.WA_A, out.wa);
  substitute(WB_x, X, out.WB_z, out.WB_A, out.wb);
  columns_.resize(n + m, kOuter);
  columns_ << Y.leftCols(kOuter) + Y.rightCols(m) * X, X;
  return true;
}

VecX TendonBorder::direction(const Vec6& z, const Vec6& zeta_A) const {
  return columns_.leftCols<6>() * z + columns_.middleCols<6>(6) * zeta_A + columns_.col(12);
}

}  // namespace cprsim
