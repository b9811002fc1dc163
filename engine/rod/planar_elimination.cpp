// SPDX-License-Identifier: BSD-3-Clause
// The variational sweep and the stable elimination of everything between a planar rod's ends; as
// engine/rod/shooting_elimination.cpp, with angles that need no logarithm.
#include <algorithm>
#include <cmath>

#include "engine/rod/planar.h"

namespace cprsim {
namespace {

using Row6 = Eigen::Matrix<double, 1, 6>;
using Mat3x6 = Eigen::Matrix<double, 3, 6>;
using ColumnsMap = Eigen::Map<Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>>;
using ConstColumnsMap = Eigen::Map<const Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>>;

Vec6 state_units(const RodScale& s) {
  Vec6 d;
  d << 1, s.length, s.length, s.force, s.force, s.moment;
  return d;
}

/// Q with orthonormal columns, A = Q R, R upper triangular: Gram-Schmidt, each column twice.
void orthonormal_columns(const Mat6x3& A, Mat6x3& Q, Mat3& R) {
  R.setZero();
  for (int k = 0; k < 3; ++k) {
    Vec6 q = A.col(k);
    for (int pass = 0; pass < 2; ++pass)
      for (int i = 0; i < k; ++i) {
        const double along = Q.col(i).dot(q);
        R(i, k) += along;
        q -= along * Q.col(i);
      }
    R(k, k) = q.norm();
    Q.col(k) = q / R(k, k);
  }
}

Vec3 solve_upper(const Mat3& R, const Vec3& b) {
  Vec3 x;
  x[2] = b[2] / R(2, 2);
  x[1] = (b[1] - R(1, 2) * x[2]) / R(1, 1);
  x[0] = (b[0] - R(0, 1) * x[1] - R(0, 2) * x[2]) / R(0, 0);
  return x;
}

Mat3 solve_upper(const Mat3& R, const Mat3& B) {
  Mat3 X;
  for (int c = 0; c < 3; ++c)
    X.col(c) = solve_upper(R, Vec3(B.col(c)));
  return X;
}

Vec6 difference(const PlanarNode& a, const PlanarNode& b) {
  Vec6 d;
  d << a.theta - b.theta, a.p[0] - b.p[0], a.p[1] - b.p[1], a.n[0] - b.n[0], a.n[1] - b.n[1],
      a.m - b.m;
  return d;
}

/// Derivative of (m + r × n, n) by the state, r from the body's reference point to the rod's end.
Mat3x6 wrench_by_state(const PlanarNode& at, const Vec2& r) {
  Mat3x6 W = Mat3x6::Zero();
  W.row(0) << 0, at.n[1], -at.n[0], -r.y(), r.x(), 1;
  W(1, 3) = W(2, 4) = 1;
  return W;
}

}  // namespace

// Columns of the state at the base: what the joint leaves free (three z), the base body's motion,
// the joint's gap.
void PlanarRod::start_columns(const Place& base, double* Y0) const {
  ColumnsMap Y(Y0, 6, columns_);
  Y.setZero();
  const int affine = affine_column();
  const PlanarNode& start = starts_.front();
  const Vec3 value = end_value(base_, start, base, 1) - base_gap_;
  if (base_ == PlanarHold::kFree) {
    Y(0, 0) = 1;
    Y(1, 1) = Y(2, 2) = port_scale_.length;
    Y(3, affine) = -value[0] * scale_.force;
    Y(4, affine) = -value[1] * scale_.force;
    Y(5, affine) = -value[2] * scale_.moment;
    return;
  }
  Y(3, 0) = Y(4, 1) = port_scale_.force;
  Y(1, affine) = -value[0] * scale_.length;
  Y(2, affine) = -value[1] * scale_.length;
  if (base_ == PlanarHold::kFixed) {
    Y(5, 2) = port_scale_.moment;
    Y(0, affine) = -value[2];
  } else {
    Y(0, 2) = 1;
    Y(5, affine) = -value[2] * scale_.moment;
  }
  if (columns_ != kPlanarWide) return;
  // dp = dp_body + phi e3 × arm
  if (base_ == PlanarHold::kFixed) Y(0, 3) = 1;
  Y(1, 3) = -base.arm.y();
  Y(2, 3) = base.arm.x();
  Y(1, 4) = Y(2, 5) = 1;
}

// A follower load turns with its section: d(R F) = dtheta e3 × R F.
void PlanarRod::apply_load_columns(std::size_t node, const PlanarNode& state, double* Y,
                                   int columns) const {
  for (std::size_t i = 0; i < load_at_.size(); ++i) {
    const PointLoad& load = forcing_.loads[i];
    if (load_at_[i] != node || !load.follower) continue;
    const Vec3 f = offset_ * load.force;
    const double F1 = state.c * f.x() - state.s * f.y(), F2 = state.s * f.x() + state.c * f.y();
    for (int c = 0; c < columns; ++c) {
      Y[3 * columns + c] += F2 * Y[c];
      Y[4 * columns + c] -= F1 * Y[c];
    }
  }
  for (const Disk& disk : disks_) {
    if (disk.node != node) continue;
    for (int c = 0; c < columns; ++c) {
      Y[3 * columns + c] += disk.k * Y[columns + c];
      Y[4 * columns + c] += disk.k * Y[2 * columns + c];
      Y[5 * columns + c] += disk.k_J * Y[c];
    }
  }
}

// At a segment's end: y = Y [z; zeta_A; 1] + mismatch. With D^-1 Y_z = Q R the new unknowns are
// z' = R z + G_A zeta_A + g, and the particular columns keep only what is orthogonal to Q.
void PlanarRod::orthonormalize(std::size_t segment, const PlanarNode& reached, double* Y0) {
  ColumnsMap Y(Y0, 6, columns_);
  const int affine = affine_column();
  const Vec6 d = state_units(port_scale_), per_unit = d.cwiseInverse();
  const Mat6x3 Y_z = per_unit.asDiagonal() * Mat6x3(Y.leftCols<3>());
  transition_ = std::max(transition_, Y_z.cwiseAbs().maxCoeff());
  Recombination& rec = recombinations_[segment];
  Mat6x3 Q;
  orthonormal_columns(Y_z, Q, rec.R);
  Vec6 y = per_unit.cwiseProduct(Vec6(Y.col(affine) + difference(reached, starts_[segment + 1])));
  rec.g = Q.transpose() * y;
  y -= Q * rec.g;
  Y.col(affine) = d.cwiseProduct(y);
  rec.G_A.setZero();
  if (columns_ == kPlanarWide) {
    Mat6x3 Y_A = per_unit.asDiagonal() * Mat6x3(Y.middleCols<3>(3));
    rec.G_A = Q.transpose() * Y_A;
    Y_A -= Q * rec.G_A;
    Y.middleCols<3>(3) = d.asDiagonal() * Y_A;
  }
  Y.leftCols<3>() = d.asDiagonal() * Q;
  for (PulledColumns::Block& block : pulled_.blocks) {
    Mat6 Y_x = per_unit.asDiagonal() * block.leftCols<PulledColumns::kUsed>();
    pulled_.G[segment].emplace_back(Q.transpose() * Y_x);
    Y_x -= Q * pulled_.G[segment].back();
    block.leftCols<PulledColumns::kUsed>() = d.asDiagonal() * Y_x;
  }
}

bool PlanarRod::sweep_columns(const Place& base) {
  const auto S = static_cast<std::size_t>(table_->stages);
  const auto lifted = static_cast<std::size_t>(kernel_.lifted);
  const auto width = static_cast<std::size_t>(columns_);
  const auto M = static_cast<std::size_t>(segments());
  const auto linearize =
      columns_ == kPlanarNarrow ? kernel_.linearize_narrow : kernel_.linearize_wide;
  start_columns_.resize((M + 1) * 6 * width);
  recombinations_.resize(M);
  cell_directions_.resize(static_cast<std::size_t>(cells_) * lifted * width);
  transition_ = 0;
  if (finds_tensions()) begin_pulled_columns();
  alignas(64) double Y[6 * kPlanarWide];
  start_columns(base, Y);
  for (std::size_t g = 0; g < M; ++g) {
    std::copy_n(Y, 6 * width, &start_columns_[g * 6 * width]);
    if (finds_tensions()) pulled_.at_segment[g] = pulled_.blocks;
    if (g == 0) apply_load_columns(0, starts_.front(), Y, columns_);
    for (std::size_t c = segment_first_[g]; c < segment_first_[g + 1]; ++c) {
      enter(c);
      if (!linearize(model_, &stages_[c * S], Y, &cell_directions_[c * lifted * width]))
        return false;
      if (finds_tensions() && !sweep_pulled_columns(c)) return false;
      apply_load_columns(c + 1, nodes_[c + 1], Y, columns_);
    }
    if (g + 1 < M) orthonormalize(g, nodes_[segment_first_[g + 1]], Y);
  }
  std::copy_n(Y, 6 * width, &start_columns_[M * 6 * width]);
  return true;
}

bool PlanarRod::condense(const Port& base, const Port& tip, CondensedRod& out,
                         TensionPorts* tensions) {
  columns_ = base.moves ? kPlanarWide : kPlanarNarrow;
  const Place base_place = place(base);
  if (!sweep_columns(base_place)) return false;
  const auto last = static_cast<std::size_t>(segments() * 6 * columns_);
  const TipRows rows = close_tip(place(tip), &start_columns_[last], out);
  const Mat3 by_z_of_base = close_base(base_place, out);
  if (tensions) close_pulled(rows, by_z_of_base, *tensions);
  out.growth = transition_;
  return true;
}

// The tip's three rows in terms of z and the bodies, and the wrench on the tip's body.
PlanarRod::TipRows PlanarRod::close_tip(const Place& tip, const double* Y0,
                                        CondensedRod& out) const {
  const ConstColumnsMap Y(Y0, 6, columns_);
  const PlanarNode& end = nodes_.back();
  const bool held = tip_ != PlanarHold::kFree;
  // which entries of the state the rows are, and in which units
  const int rows[3] = {held ? 1 : 3, held ? 2 : 4, tip_ == PlanarHold::kFixed ? 0 : 5};
  const double unit = held ? scale_.length : scale_.force;
  const Vec3 per_unit(1 / unit, 1 / unit, tip_ == PlanarHold::kFixed ? 1 : 1 / scale_.moment);
  const Mat6x3 Y_z = Y.leftCols<3>();
  const Mat6x3 Y_A = columns_ == kPlanarWide ? Mat6x3(Y.middleCols<3>(3)) : Mat6x3(Mat6x3::Zero());
  const Vec6 y = Y.col(affine_column());
  const Vec3 value = end_value(tip_, end, tip, 1) - tip_gap_;
  TipRows found;
  for (int i = 0; i < 3; ++i) {
    out.T.block<1, 3>(i, 0) = per_unit[i] * Y_z.row(rows[i]);
    out.T_A.block<1, 3>(i, 0) = per_unit[i] * Y_A.row(rows[i]);
    out.t[i] = value[i] + per_unit[i] * y[rows[i]];
    found.T(i, rows[i]) = per_unit[i];
  }
  auto T_B = out.T_B.topLeftCorner<3, 3>(), WB_B = out.WB_B.topLeftCorner<3, 3>();
  T_B.setZero();
  WB_B.setZero();
  out.WB_z.topLeftCorner<3, 3>().setZero();
  out.WB_A.topLeftCorner<3, 3>().setZero();
  out.wb.head<3>().setZero();
  if (!held) return found;
  T_B(0, 0) = tip.arm.y() / scale_.length;
  T_B(1, 0) = -tip.arm.x() / scale_.length;
  T_B(0, 1) = T_B(1, 2) = -1 / scale_.length;
  if (tip_ == PlanarHold::kFixed) T_B(2, 0) = -1;
  const Vec2 r = Vec2(end.p[0], end.p[1]) - tip.p + tip.arm;
  const Mat3x6 W = wrench_by_state(end, r);
  out.WB_z.topLeftCorner<3, 3>() = -W * Y_z;
  out.WB_A.topLeftCorner<3, 3>() = -W * Y_A;
  WB_B(0, 1) = end.n[1];
  WB_B(0, 2) = -end.n[0];
  out.wb.head<3>() = -(planar_wrench(end, tip) + W * y);
  found.W = -W;
  return found;
}

// The wrench on the base's body needs z at the first segment: back through the recombinations.
/// @return that wrench by z there
Mat3 PlanarRod::close_base(const Place& base, CondensedRod& out) const {
  auto WA_z = out.WA_z.topLeftCorner<3, 3>(), WA_A = out.WA_A.topLeftCorner<3, 3>();
  WA_z.setZero();
  WA_A.setZero();
  out.wa.head<3>().setZero();
  if (base_ == PlanarHold::kFree || columns_ != kPlanarWide) return Mat3::Zero();
  Mat3 Z = Mat3::Identity(), Z_A = Mat3::Zero();
  Vec3 z0 = Vec3::Zero();
  for (int g = segments() - 2; g >= 0; --g) {
    const Recombination& rec = recombinations_[static_cast<std::size_t>(g)];
    Z = solve_upper(rec.R, Z);
    Z_A = solve_upper(rec.R, Mat3(Z_A - rec.G_A));
    z0 = solve_upper(rec.R, Vec3(z0 - rec.g));
  }
  const ConstColumnsMap Y(start_columns_.data(), 6, columns_);
  const PlanarNode& start = starts_.front();
  const Vec2 r = Vec2(start.p[0], start.p[1]) - base.p + base.arm;
  const Mat3x6 W = wrench_by_state(start, r);
  const Mat3 W_z = W * Mat6x3(Y.leftCols<3>());
  WA_z = W_z * Z;
  WA_A = W * Mat6x3(Y.middleCols<3>(3)) + W_z * Z_A;
  WA_A(0, 1) -= start.n[1];
  WA_A(0, 2) += start.n[0];
  out.wa.head<3>() = planar_wrench(start, base) + W * Vec6(Y.col(affine_column())) + W_z * z0;
  return W_z;
}

Vec3 PlanarRod::planar_wrench(const PlanarNode& node, const Place& at) const {
  const Vec2 r = Vec2(node.p[0], node.p[1]) - at.p + at.arm;
  return {node.m + r.x() * node.n[1] - r.y() * node.n[0], node.n[0], node.n[1]};
}

Vec6 PlanarRod::to_world(const Vec3& wrench) const {
  Vec6 w;
  w << wrench[0] * plane_.col(2), plane_.leftCols<2>() * wrench.tail<2>();
  return w;
}

Vec6 PlanarRod::wrench_on_base(const Port& base) const {
  return to_world(planar_wrench(starts_.front(), place(base)));
}

Vec6 PlanarRod::wrench_on_tip(const Port& tip) const {
  return to_world(-planar_wrench(nodes_.back(), place(tip)));
}

// @param share of the affine part
void PlanarRod::find_direction(const Vec3& z, const Vec3& zeta_A, double share) {
  const auto M = static_cast<std::size_t>(segments());
  const auto lifted = static_cast<std::size_t>(kernel_.lifted);
  const auto width = static_cast<std::size_t>(columns_);
  start_direction_.resize(M);
  lifted_direction_.resize(static_cast<std::size_t>(cells_) * lifted);
  Vec3 z_g = z;
  double weights[kPlanarWide] = {};
  if (columns_ == kPlanarWide) std::copy_n(zeta_A.data(), 3, weights + 3);
  weights[affine_column()] = share;
  const auto times_weights = [&](const double* row) {
    double sum = 0;
    for (std::size_t k = 0; k < width; ++k)
      sum += row[k] * weights[k];
    return sum;
  };
  for (std::size_t g = M; g-- > 0;) {
    if (g + 1 < M) {
      const Recombination& rec = recombinations_[g];
      z_g -= rec.G_A * zeta_A + share * rec.g;
      for (std::size_t b = 0; b < pulled_.blocks.size(); ++b)
        z_g -= pulled_.G[g][b] * pulled_.weights_of(b);
      z_g = solve_upper(rec.R, z_g);
    }
    std::copy_n(z_g.data(), 3, weights);
    for (std::size_t i = 0; i < 6; ++i)
      start_direction_[g][static_cast<Eigen::Index>(i)] =
          times_weights(&start_columns_[(g * 6 + i) * width]);
    for (std::size_t i = segment_first_[g] * lifted; i < segment_first_[g + 1] * lifted; ++i)
      lifted_direction_[i] = times_weights(&cell_directions_[i * width]);
  }
  add_pulled_direction();
}

void PlanarRod::keep() {
  if (finds_tensions()) tendons_->in_space().keep();
  kept_starts_ = starts_;
  kept_lifted_.resize(3 * stages_.size());
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    kept_lifted_[3 * j] = stages_[j].kappa;
    std::copy_n(stages_[j].v, 2, &kept_lifted_[3 * j + 1]);
  }
}

void PlanarRod::move(double alpha) {
  if (finds_tensions()) tendons_->in_space().move(alpha, tension_direction_);
  for (std::size_t g = 0; g < starts_.size(); ++g) {
    const Vec6& d = start_direction_[g];
    PlanarNode& s = starts_[g];
    const PlanarNode& kept = kept_starts_[g];
    s.theta = kept.theta + alpha * d[0];
    s.c = std::cos(s.theta);
    s.s = std::sin(s.theta);
    for (int i = 0; i < 2; ++i) {
      s.p[i] = kept.p[i] + alpha * d[1 + i];
      s.n[i] = kept.n[i] + alpha * d[3 + i];
    }
    s.m = kept.m + alpha * d[5];
  }
  const auto S = static_cast<std::size_t>(table_->stages);
  const auto lifted = static_cast<std::size_t>(kernel_.lifted);
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const double* d = &lifted_direction_[j / S * lifted];
    stages_[j].kappa = kept_lifted_[3 * j] + alpha * d[j % S];
    if (lifts_stretch(law_))
      for (std::size_t i = 0; i < 2; ++i)
        stages_[j].v[i] = kept_lifted_[3 * j + 1 + i] + alpha * d[S + 2 * (j % S) + i];
  }
}

}  // namespace cprsim
