// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/tendon_border.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cprsim {
namespace {

// Of a row's largest entry: what elimination leaves of a row that says what others say.
constexpr double kDependent = 1e-12;

}  // namespace

// The d entries of [z; x] that stay free first get m pivots, row by row the largest of each.
bool TendonBorder::eliminate(Eigen::Index d) {
  const Eigen::Index m = rows_.rows(), all = rows_.cols(), given = all - m, c = d + m;
  for (Eigen::Index k = 0; k < m; ++k) {
    const double largest = std::max(rows_.row(k).head(d).cwiseAbs().maxCoeff(),
                                    rows_.row(k).tail(m).cwiseAbs().maxCoeff());
    if (!(largest > 0) || !std::isfinite(largest)) return false;
    rows_.row(k) /= largest;
  }
  // columns in the order x, z, the rest: entry of [z; x] that stands where
  entry_.resize(static_cast<std::size_t>(c));
  std::iota(entry_.begin(), entry_.end(), Eigen::Index{0});
  const auto column = [&](Eigen::Index i) {
    const Eigen::Index of = entry_[static_cast<std::size_t>(i)];
    return of < d ? of : given + of - d;
  };
  for (Eigen::Index k = 0; k < m; ++k) {
    Eigen::Index best = k;
    for (Eigen::Index j = k + 1; j < c; ++j)
      if (std::abs(rows_(k, column(j))) > std::abs(rows_(k, column(best)))) best = j;
    const double pivot = rows_(k, column(best));
    if (!(std::abs(pivot) > kDependent)) return false;
    std::swap(entry_[static_cast<std::size_t>(k)], entry_[static_cast<std::size_t>(best)]);
    rows_.row(k) /= pivot;
    for (Eigen::Index i = 0; i < m; ++i)
      if (i != k && rows_(i, column(k)) != 0) {
        const double factor = rows_(i, column(k));
        rows_.row(i) -= factor * rows_.row(k);
      }
  }
  outer_.setZero(c, all - m);
  for (Eigen::Index k = 0; k < c; ++k) {
    const Eigen::Index of = entry_[static_cast<std::size_t>(k)];
    if (k >= m) {
      outer_(of, k - m) = 1;
      continue;
    }
    for (Eigen::Index j = m; j < c; ++j)
      outer_(of, j - m) = -rows_(k, column(j));
    outer_.row(of).tail(given - d) = -rows_.row(k).segment(d, given - d);
  }
  return true;
}

/// What stands before what is left, zeta_A, 1 and F, by what stood before z, zeta_A, 1, F and x.
void TendonBorder::substitute(MatX& by) {
  const Eigen::Index m = by.cols() - outer_.cols(), d = outer_.rows() - m;
  answer_.noalias() = by.leftCols(d).lazyProduct(outer_.topRows(d));
  answer_.noalias() += by.rightCols(m).lazyProduct(outer_.bottomRows(m));
  answer_.rightCols(answer_.cols() - d) += by.middleCols(d, answer_.cols() - d);
}

void TendonBorder::put_together(MatX& by, const Eigen::Ref<const MatX>& z,
                                const Eigen::Ref<const MatX>& zeta,
                                const Eigen::Ref<const MatX>& one, const Eigen::Ref<const MatX>& F,
                                const Eigen::Ref<const MatX>& x) {
  const Eigen::Index d = z.cols();
  by.resize(z.rows(), 2 * d + 1 + F.cols() + x.cols());
  by.leftCols(d) = z;
  by.middleCols(d, d) = zeta;
  by.col(2 * d) = one;
  by.middleCols(2 * d + 1, F.cols()) = F;
  by.rightCols(x.cols()) = x;
  substitute(by);
}

bool TendonBorder::linearize(TensionedRod& rod, const RodTendons& tendons, const Port& base,
                             const Port& tip, CondensedRod& out) {
  if (!rod.linearize_given(base, tip, out, ports_)) return false;
  OpenPorts* const open = rod.ports_of_forces();
  OpenPorts& forces = open ? *open : none_;
  const Eigen::Index m = tendons.unknowns(), d = rod.freedoms(), f = open ? forces.T_F.cols() : 0,
                     given = 2 * d + 1 + f;
  // (1)
  if (cases_.rows() != given + m) cases_.setIdentity(given + m, given + m);
  rod.find_directions(cases_, directions_);
  rows_.resize(m, given + m);
  for (Eigen::Index c = 0; c < rows_.cols(); ++c) {
    // as of bodies that stand still
    if (directions_.col(c).isZero(0)) {
      rows_.col(c).setZero();
      continue;
    }
    rod.strain_rates(directions_.col(c), rates_);
    tendons.gap_rates(rates_, rows_.col(c));
  }
  rows_.col(2 * d) += tendons.gaps_found();
  for (Eigen::Index k = 0; k < m; ++k)
    rows_(k, given + k) += tendons.unit(k) * tendons.gap_by_own(k);
  if (!eliminate(d)) return false;

  const auto replace = [&](auto& z, auto& zeta, auto& one, auto& F, const MatX& x) {
    const Eigen::Index rows = x.rows();
    put_together(narrow_, z.topLeftCorner(rows, d), zeta.topLeftCorner(rows, d), one.head(rows),
                 F.topLeftCorner(rows, f), x);
    z.topLeftCorner(rows, d) = answer_.leftCols(d);
    zeta.topLeftCorner(rows, d) = answer_.middleCols(d, d);
    one.head(rows) = answer_.col(2 * d);
    F.topLeftCorner(rows, f) = answer_.rightCols(f);
  };
  replace(out.T, out.T_A, out.t, forces.T_F, ports_.T);
  replace(out.WA_z, out.WA_A, out.wa, forces.WA_F, ports_.WA);
  replace(out.WB_z, out.WB_A, out.wb, forces.WB_F, ports_.WB);
  for (std::size_t i = 0; open && i < forces.motions.size(); ++i) {
    OpenPorts::Motion& motion = forces.motions[i];
    put_together(wide_, motion.by_z, motion.by_A, motion.value, motion.by_F, ports_.motions[i]);
    motion.by_z = answer_.leftCols(d);
    motion.by_A = answer_.middleCols(d, d);
    motion.value = answer_.col(2 * d);
    motion.by_F = answer_.rightCols(f);
  }
  return true;
}

const MatX& TendonBorder::complete(const Vec6& z, const Vec6& zeta_A, const VecX& F) {
  const Eigen::Index left = outer_.cols(), m = rows_.rows(), d = outer_.rows() - m, f = F.size();
  left_.resize(left);
  left_ << z.head(d), zeta_A.head(d), 1, F;
  complete_.resize(2 * d + 1 + f + m, 1);
  complete_.topRows(d) = outer_.topRows(d) * left_;
  complete_.middleRows(d, d + 1 + f) = left_.tail(d + 1 + f);
  complete_.bottomRows(m) = outer_.bottomRows(m) * left_;
  return complete_;
}

VecX TendonBorder::tensions(const RodTendons& tendons) const {
  const Eigen::Index m = rows_.rows();
  VecX x = complete_.col(0).tail(m);
  for (Eigen::Index k = 0; k < m; ++k)
    x[k] *= tendons.unit(k);
  return x;
}

}  // namespace cprsim
