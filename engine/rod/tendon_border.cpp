// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/tendon_border.h"

#include <Eigen/LU>

#include "engine/math/linear_solve.h"

namespace cprsim {
namespace {

constexpr Eigen::Index kOuter = 13;  // z, zeta_A, 1
constexpr double kDependent = 1e-12;

/// What stands before (z, zeta_A, 1) once z and the tensions are `outer` times that, by what stood
/// before (z, zeta_A, 1) and the tensions.
MatX substituted(const MatX& by, const MatX& outer) {
  MatX out = by.leftCols<6>() * outer.topRows<6>() +
             by.rightCols(by.cols() - kOuter) * outer.bottomRows(outer.rows() - 6);
  out.rightCols<7>() += by.middleCols<7>(6);
  return out;
}

}  // namespace

bool TendonBorder::linearize(TensionedRod& rod, const RodTendons& tendons, const Port& base,
                             const Port& tip, CondensedRod& out) {
  const Eigen::Index m = tendons.unknowns();
  const Vec6 none = Vec6::Zero();
  if (!rod.linearize_given(base, tip, out)) return false;
  const VecX affine = rod.direction_given(none, none);
  const Eigen::Index n = affine.size();
  MatX Y(n, kOuter + m), T(6, kOuter + m), WA(6, kOuter + m), WB(6, kOuter + m);
  for (Eigen::Index i = 0; i < 6; ++i) {
    Y.col(i) = rod.direction_given(Vec6::Unit(i), none) - affine;
    Y.col(6 + i) = rod.direction_given(none, Vec6::Unit(i)) - affine;
  }
  Y.col(12) = affine;
  T.leftCols<kOuter>() << out.T, out.T_A, out.t;
  WA.leftCols<kOuter>() << out.WA_z, out.WA_A, out.wa;
  WB.leftCols<kOuter>() << out.WB_z, out.WB_A, out.wb;
  for (Eigen::Index k = 0; k < m; ++k) {
    CondensedRod by;
    rod.add_tension(k, true);
    const bool regular = rod.linearize_given(base, tip, by);
    rod.add_tension(k, false);
    if (!regular) return false;
    const double unit = tendons.unit(k);
    Y.col(kOuter + k) = unit * (rod.direction_given(none, none) - affine);
    T.col(kOuter + k) = unit * (by.t - out.t);
    WA.col(kOuter + k) = unit * (by.wa - out.wa);
    WB.col(kOuter + k) = unit * (by.wb - out.wb);
  }
  // (1)
  MatX rows(m, kOuter + m);
  for (Eigen::Index c = 0; c < rows.cols(); ++c)
    rows.col(c) = tendons.gap_rates(rod.strain_rates(Y.col(c)));
  rows.col(12) += tendons.gaps();
  const VecX slack = tendons.gaps_by_tension();
  for (Eigen::Index k = 0; k < m; ++k)
    rows(k, kOuter + k) += tendons.unit(k) * slack[k];
  MatX inner(m, 6 + m), outer;
  inner << rows.leftCols<6>(), rows.rightCols(m);
  Eigen::FullPivLU<MatX> lu(inner);
  lu.setThreshold(kDependent);
  if (lu.rank() < m || !general_solution(inner, rows.middleCols<7>(6), outer)) return false;
  T = substituted(T, outer);
  WA = substituted(WA, outer);
  WB = substituted(WB, outer);
  out.T = T.leftCols<6>();
  out.T_A = T.middleCols<6>(6);
  out.t = T.col(12);
  out.WA_z = WA.leftCols<6>();
  out.WA_A = WA.middleCols<6>(6);
  out.wa = WA.col(12);
  out.WB_z = WB.leftCols<6>();
  out.WB_A = WB.middleCols<6>(6);
  out.wb = WB.col(12);
  columns_.resize(n + m, kOuter);
  columns_ << substituted(Y, outer), outer.bottomRows(m);
  for (Eigen::Index k = 0; k < m; ++k)
    columns_.row(n + k) *= tendons.unit(k);
  return true;
}

VecX TendonBorder::direction(const Vec6& z, const Vec6& zeta_A) const {
  return columns_.leftCols<6>() * z + columns_.middleCols<6>(6) * zeta_A + columns_.col(12);
}

}  // namespace cprsim
