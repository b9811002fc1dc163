// SPDX-License-Identifier: BSD-3-Clause
// The linear side: rows of increments (growth of |q|, phi, dp, dn, dm) of the control points, and
// their elimination.
#include <algorithm>
#include <cmath>

#include "engine/math/linear_solve.h"
#include "engine/math/so3.h"
#include "engine/rod/collocation.h"

namespace cprsim {
namespace {

/// Affine part first, then the base body's motion.
constexpr int kAffine = 0, kBody = 1;

/// [I; load_by_turn] as it acts on (phi, dp, dn, dm).
Mat12 passing(const Mat6& load_by_turn) {
  Mat12 P = Mat12::Identity();
  P.bottomLeftCorner<6, 6>() += load_by_turn;
  return P;
}

}  // namespace

Vec13 CollocationRod::increment_units() const {
  Vec13 d;
  d << Vec4::Ones(), Vec3::Constant(unit_.length), Vec3::Constant(unit_.force),
      Vec3::Constant(unit_.moment);
  return d;
}

/// Adds a block of rows that are derivatives by (q, p, n, m) of a control point.
void CollocationRod::put(int row, int control, const Mat13& by_fields) {
  Mat13 J = by_fields;
  const Vec4 q = control_[static_cast<std::size_t>(control)].head<4>();
  J.leftCols<4>() = (J.leftCols<4>() * quaternion_by_increment(q)).eval();
  J *= increment_units().asDiagonal();
  for (int r = 0; r < 13; ++r)
    for (int c = 0; c < 13; ++c)
      if (J(r, c) != 0) system_.at(row + r, 13 * control + c) += J(r, c);
}

// Six rows of the joint, and |q|² = 1.
void CollocationRod::assemble_base(const Port& base) {
  const NodeState start = base_state();
  const EndRows rows = base_.rows(start, base, scale_);
  const Mat6x12 J = rows.by_state * passing(load_by_turn(0, Mat3(rotation_of(start)))) *
                    increment_units().tail<12>().asDiagonal();
  const Vec6 value = rows.value - base_gap_;
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 12; ++c)
      system_.at(r, 1 + c) = J(r, c);
    system_.dense(r, kAffine) = value[r];
    for (int c = 0; c < 6 && base_moves_; ++c)
      system_.dense(r, kBody + c) = rows.by_body(r, c);
  }
  const double square = control_.front().head<4>().squaredNorm();
  system_.at(6, 0) = 2 * square;
  system_.dense(6, kAffine) = square - 1;
}

void CollocationRod::assemble_join(std::size_t piece, int row) {
  const int at = pieces_[piece].first_control;
  const Vec4 q = control_[static_cast<std::size_t>(at - 1)].head<4>();
  Mat13 before = -Mat13::Identity();
  before.bottomLeftCorner<6, 4>() +=
      load_by_turn(piece, rotation_of(q)).leftCols<3>() * turn_by_quaternion(q);
  put(row, at - 1, before);
  put(row, at, Mat13::Identity());
}

void CollocationRod::assemble_points(std::size_t piece, int row) {
  Mat13 by_y, by_y_s;
  for (int i = 0; i < pieces_[piece].points; ++i, row += 13) {
    const auto j = static_cast<std::size_t>(pieces_[piece].first_point + i);
    linearize_point(model_, points_[j], by_y, by_y_s);
    const BasisValues& b = sites_[j].basis;
    for (int k = 0; k <= options_.degree; ++k)
      if (b.value[k] != 0 || b.slope[k] != 0)
        put(row, b.first + k, b.value[k] * by_y + b.slope[k] / forcing_.length * by_y_s);
  }
}

/// How far rows reach to both sides of the diagonal.
void CollocationRod::find_band() {
  lower_ = upper_ = 0;
  const auto reach = [&](int row, int first, int last) {
    lower_ = std::max(lower_, row + 12 - 13 * first);
    upper_ = std::max(upper_, 13 * last + 12 - row);
  };
  reach(-6, 0, 0);
  int row = 7;
  for (std::size_t g = 0; g < pieces_.size(); ++g) {
    if (g > 0) {
      reach(row, pieces_[g].first_control - 1, pieces_[g].first_control);
      row += 13;
    }
    for (int i = 0; i < pieces_[g].points; ++i, row += 13) {
      const int first = sites_[static_cast<std::size_t>(pieces_[g].first_point + i)].basis.first;
      reach(row, first, first + options_.degree);
    }
  }
}

void CollocationRod::assemble(const Port& base) {
  const int columns = 13 * static_cast<int>(control_.size());
  system_.reset(columns - 6, columns, lower_, upper_, base_moves_ ? 7 : 1);
  assemble_base(base);
  int row = 7;
  for (std::size_t g = 0; g < pieces_.size(); ++g) {
    if (g > 0) {
      assemble_join(g, row);
      row += 13;
    }
    assemble_points(g, row);
    row += 13 * pieces_[g].points;
  }
  for (std::size_t k = 0; k < residual_.size(); ++k)
    for (int i = 0; i < 13; ++i)
      system_.dense(7 + 13 * static_cast<int>(k) + i, kAffine) = residual_[k][i];
}

// Six rows B y + B_A zeta_A + b = 0 remain on the last control point's y = (phi, dp, dn, dm) in
// units: y = Q2 z - Q1 R^-T (B_A zeta_A + b) with B^T = Q1 R.
bool CollocationRod::linearize(const Port& base, const Port& tip, CondensedRod& out) {
  base_moves_ = base_.held() && base.moves;
  assemble(base);
  system_.scale_rows();
  if (!system_.eliminate(13 * static_cast<int>(control_.size()) - 12)) return false;
  const TallQr qr(Mat12x6(system_.remaining().transpose()));
  MatX rhs = system_.remaining_dense();
  const Mat6 lower = qr.R.transpose();
  lower.triangularView<Eigen::Lower>().solveInPlace(rhs);
  last_.by_z = qr.Q2;
  last_.affine = -(qr.Q1 * rhs.col(kAffine));
  last_.by_A.setZero();
  if (base_moves_) last_.by_A = -(qr.Q1 * rhs.middleCols<6>(kBody));

  const NodeState end = tip_state();
  const Mat12 to_end = passing(-load_by_turn(pieces_.size(), Mat3(rotation_of(end)))) *
                       increment_units().tail<12>().asDiagonal();
  const EndColumns Y{to_end * last_.by_z, to_end * last_.by_A, to_end * last_.affine};
  condense_tip(tip_, end, tip, scale_, tip_gap_, Y, out);
  const NodeState start = base_state();
  condense_base(base_moves_, start, base, base_moves_ ? base_columns(start) : EndColumns{}, out);
  out.growth = 0;
  return true;
}

/// The state before a load at the base, by back-substitution of all columns.
EndColumns CollocationRod::base_columns(const NodeState& start) const {
  MatX last(12, 13), w = MatX::Zero(7, 13);
  last << last_.by_z, last_.by_A, last_.affine;
  w.block<6, 6>(kBody, 6).setIdentity();
  w(kAffine, 12) = 1;
  const Eigen::Matrix<double, 12, 13> first = passing(load_by_turn(0, Mat3(rotation_of(start)))) *
                                              increment_units().tail<12>().asDiagonal() *
                                              system_.substitute(last, w).middleRows(1, 12);
  return {first.leftCols<6>(), first.middleCols<6>(6), first.col(12)};
}

Vec6 CollocationRod::wrench_on_base(const Port& base) const {
  return cprsim::wrench_on_base(base_state(), base);
}

Vec6 CollocationRod::wrench_on_tip(const Port& tip) const {
  return cprsim::wrench_on_tip(tip_state(), tip);
}

void CollocationRod::set_direction(const Vec6& z, const Vec6& zeta_A) {
  const Vec12 last = last_.by_z * z + last_.by_A * zeta_A + last_.affine;
  VecX w(base_moves_ ? 7 : 1);
  w[kAffine] = 1;
  if (base_moves_) w.tail<6>() = zeta_A;
  const MatX x = system_.substitute(last, w);
  const Vec13 units = increment_units();
  direction_.resize(control_.size());
  for (std::size_t k = 0; k < control_.size(); ++k)
    direction_[k] = units.cwiseProduct(Vec13(x.block<13, 1>(13 * static_cast<Eigen::Index>(k), 0)));
}

void CollocationRod::keep() {
  kept_ = control_;
}

void CollocationRod::move(double alpha) {
  for (std::size_t k = 0; k < control_.size(); ++k) {
    const Vec13 d = alpha * direction_[k];
    control_[k].head<4>() =
        std::exp(d[0]) *
        quaternion_product(quaternion_of(Vec3(d.segment<3>(1))), Vec4(kept_[k].head<4>()));
    control_[k].tail<9>() = kept_[k].tail<9>() + d.tail<9>();
  }
}

}  // namespace cprsim
