// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/tendon_border.h"

#include <Eigen/LU>

#include "engine/math/linear_solve.h"

namespace cprsim {
namespace {

constexpr double kDependent = 1e-12;

/// What stands before (z, zeta_A, 1) once z and the tendons' unknowns are `outer` times that, by
/// what stood before (z, zeta_A, 1) and those unknowns.
MatX substituted(const MatX& by, const MatX& outer) {
  const Eigen::Index m = by.cols() - outer.cols(), d = outer.rows() - m;
  MatX out = by.leftCols(d) * outer.topRows(d) + by.rightCols(m) * outer.bottomRows(m);
  out.rightCols(d + 1) += by.middleCols(d, d + 1);
  return out;
}

}  // namespace

bool TendonBorder::linearize(TensionedRod& rod, const RodTendons& tendons, const Port& base,
                             const Port& tip, CondensedRod& out) {
  const Eigen::Index m = tendons.unknowns(), d = rod.freedoms(), given = 2 * d + 1;
  const Vec6 none = Vec6::Zero();
  if (!rod.linearize_given(base, tip, out)) return false;
  const VecX affine = rod.direction_given(none, none);
  const Eigen::Index n = affine.size();
  MatX Y(n, given + m), T(d, given + m), WA(d, given + m), WB(d, given + m);
  for (Eigen::Index i = 0; i < d; ++i) {
    Y.col(i) = rod.direction_given(Vec6::Unit(i), none) - affine;
    Y.col(d + i) = rod.direction_given(none, Vec6::Unit(i)) - affine;
  }
  Y.col(2 * d) = affine;
  T.leftCols(given) << out.T.topLeftCorner(d, d), out.T_A.topLeftCorner(d, d), out.t.head(d);
  WA.leftCols(given) << out.WA_z.topLeftCorner(d, d), out.WA_A.topLeftCorner(d, d), out.wa.head(d);
  WB.leftCols(given) << out.WB_z.topLeftCorner(d, d), out.WB_A.topLeftCorner(d, d), out.wb.head(d);
  for (Eigen::Index k = 0; k < m; ++k) {
    CondensedRod by;
    rod.add_tension(k, true);
    const bool regular = rod.linearize_given(base, tip, by);
    rod.add_tension(k, false);
    if (!regular) return false;
    const double unit = tendons.unit(k);
    Y.col(given + k) = unit * (rod.direction_given(none, none) - affine);
    T.col(given + k) = unit * (by.t - out.t).head(d);
    WA.col(given + k) = unit * (by.wa - out.wa).head(d);
    WB.col(given + k) = unit * (by.wb - out.wb).head(d);
  }
  // (1)
  MatX rows(m, given + m);
  for (Eigen::Index c = 0; c < rows.cols(); ++c)
    rows.col(c) = tendons.gap_rates(rod.strain_rates(Y.col(c)));
  rows.col(2 * d) += tendons.gaps_found();
  const VecX own = tendons.gaps_by_own();
  for (Eigen::Index k = 0; k < m; ++k)
    rows(k, given + k) += tendons.unit(k) * own[k];
  MatX inner(m, d + m), outer;
  inner << rows.leftCols(d), rows.rightCols(m);
  Eigen::FullPivLU<MatX> lu(inner);
  lu.setThreshold(kDependent);
  if (lu.rank() < m || !general_solution(inner, rows.middleCols(d, d + 1), outer)) return false;
  T = substituted(T, outer);
  WA = substituted(WA, outer);
  WB = substituted(WB, outer);
  out.T.topLeftCorner(d, d) = T.leftCols(d);
  out.T_A.topLeftCorner(d, d) = T.middleCols(d, d);
  out.t.head(d) = T.col(2 * d);
  out.WA_z.topLeftCorner(d, d) = WA.leftCols(d);
  out.WA_A.topLeftCorner(d, d) = WA.middleCols(d, d);
  out.wa.head(d) = WA.col(2 * d);
  out.WB_z.topLeftCorner(d, d) = WB.leftCols(d);
  out.WB_A.topLeftCorner(d, d) = WB.middleCols(d, d);
  out.wb.head(d) = WB.col(2 * d);
  columns_.resize(n + m, given);
  columns_ << substituted(Y, outer), outer.bottomRows(m);
  for (Eigen::Index k = 0; k < m; ++k)
    columns_.row(n + k) *= tendons.unit(k);
  return true;
}

VecX TendonBorder::direction(const Vec6& z, const Vec6& zeta_A) const {
  const Eigen::Index d = (columns_.cols() - 1) / 2;
  return columns_.leftCols(d) * z.head(d) + columns_.middleCols(d, d) * zeta_A.head(d) +
         columns_.col(2 * d);
}

}  // namespace cprsim
