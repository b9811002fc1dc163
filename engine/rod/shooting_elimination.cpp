// SPDX-License-Identifier: BSD-3-Clause
// The variational sweep and the stable elimination of everything between a rod's ends.
#include <algorithm>
#include <cmath>

#include "engine/math/linear_solve.h"
#include "engine/math/so3.h"
#include "engine/rod/shooting_open.h"

namespace cprsim {
namespace {

using RowMajor12 = Eigen::Matrix<double, 12, Eigen::Dynamic, Eigen::RowMajor>;
using ColumnsMap = Eigen::Map<RowMajor12>;
using ConstColumnsMap = Eigen::Map<const RowMajor12>;
using Mat12x6 = Eigen::Matrix<double, 12, 6>;

/// Column of the affine part.
int affine_column(int columns) {
  return columns == kNarrow ? 6 : 12;
}

Vec12 state_units(const RodScale& s) {
  Vec12 d;
  d << Vec3::Ones(), Vec3::Constant(s.length), Vec3::Constant(s.force), Vec3::Constant(s.moment);
  return d;
}

/// The body's motion seen at the rod's end: phi_E = phi, dp_E = dp + phi × arm.
Mat6 carried_to(const Vec3& arm) {
  Mat6 C = Mat6::Identity();
  C.block<3, 3>(3, 0) = -hat(arm);
  return C;
}

}  // namespace

// Columns of the state at the base: what the joint leaves free (six z), the base body's motion, the
// joint's gap.
void ShootingRod::start_columns(const Port& base, double* Y0) const {
  ColumnsMap Y(Y0, 12, columns_);
  Y.setZero();
  const int affine = affine_column(columns_);
  const NodeState& start = starts_.front();
  if (base_.fixed()) {
    const Mat3 Q = base.R.transpose() * Mat3(rotation_of(start));
    const Vec3 gap = base_gap_.head<3>() * scale_.length, e = log_so3(Q);
    // d log Q = J_l^-1(e) psi
    Y.block<3, 1>(0, affine) = -(base.R * (right_jacobian(-e) * (e - base_gap_.tail<3>())));
    Y.block<3, 1>(3, affine) = base.p + base.R * gap - position_of(start);
    Y.block<3, 3>(6, 0).diagonal().setConstant(port_scale_.force);
    Y.block<3, 3>(9, 3).diagonal().setConstant(port_scale_.moment);
    if (columns_ == kWide) Y.block<6, 6>(0, 6) = carried_to(position_of(start) - base.p + base.arm);
    return;
  }
  const EndRows rows = base_.rows(start, base, scale_);
  const Vec12 d = state_units(scale_);
  const TallQr qr((rows.by_state * d.asDiagonal()).transpose());
  const Mat6 lower = qr.R.transpose();
  const Mat12x6 Q1 = d.asDiagonal() * qr.Q1, Q2 = d.asDiagonal() * qr.Q2;
  // B y + by_body zeta + value = 0  =>  y = Q2 z - Q1 R^-T (by_body zeta + value)
  Y.leftCols<6>() = Q2;
  Vec6 value = rows.value - base_gap_;
  lower.triangularView<Eigen::Lower>().solveInPlace(value);
  Y.col(affine) = -(Q1 * value);
  if (columns_ == kNarrow) return;
  Mat6 by_body = rows.by_body;
  lower.triangularView<Eigen::Lower>().solveInPlace(by_body);
  Y.middleCols<6>(6) = -(Q1 * by_body);
}

// A follower load turns with its section: d(R F) = phi × R F.
void ShootingRod::apply_load_columns(std::size_t node, const NodeState& state, double* Y0,
                                     int columns) const {
  for (std::size_t i = 0; i < load_at_.size(); ++i) {
    const PointLoad& load = forcing_.loads[i];
    if (load_at_[i] != node || !load.follower) continue;
    const Mat3 R = rotation_of(state);
    ColumnsMap Y(Y0, 12, columns);
    Y.middleRows<3>(6) += hat(R * load.force) * Y.topRows<3>();
    Y.middleRows<3>(9) += hat(R * load.torque) * Y.topRows<3>();
  }
  if (disks_) disks_->pass_columns(node, ColumnsMap(Y0, 12, columns));
}

// At a boundary: y = Y [z; zeta_A; 1] + mismatch. With D^-1 Y_z = Q R the new unknowns are z' = R z
// + G_A zeta_A + g, and the particular columns keep only what is orthogonal to Q. Turning is joined
// by log(R_reached R_start^T) = e = 0, hence phi_start = exp(-e) (phi_reached + e).
void ShootingRod::orthonormalize(std::size_t zone, const Vec12& mismatch, double* Y0) {
  ColumnsMap Y(Y0, 12, columns_);
  const int affine = affine_column(columns_);
  if (!mismatch.isZero(0)) {
    Y.col(affine) += mismatch;
    const Mat3 back = exp_so3(-mismatch.head<3>());
    for (int c = 0; c < columns_; ++c)
      Y.col(c).head<3>() = (back * Y.col(c).head<3>()).eval();
  }
  const Vec12 d = state_units(port_scale_);
  const Vec12 per_unit = d.cwiseInverse();
  const Mat12x6 Y_z = per_unit.asDiagonal() * Mat12x6(Y.leftCols<6>());
  transition_ = std::max(transition_, Y_z.cwiseAbs().maxCoeff());
  const TallQr qr(Y_z);
  const Mat6x12 Qt = qr.Q1.transpose();
  Recombination& rec = recombinations_[zone];
  rec.R = qr.R;
  Vec12 y = per_unit.cwiseProduct(Vec12(Y.col(affine)));
  rec.g = Qt * y;
  y -= qr.Q1 * rec.g;
  Y.col(affine) = d.cwiseProduct(y);
  rec.G_A.setZero();
  if (columns_ == kWide) {
    Mat12x6 Y_A = per_unit.asDiagonal() * Mat12x6(Y.middleCols<6>(6));
    rec.G_A = Qt * Y_A;
    Y_A -= qr.Q1 * rec.G_A;
    Y.middleCols<6>(6) = d.asDiagonal() * Y_A;
  }
  Y.leftCols<6>() = d.asDiagonal() * qr.Q1;
  if (is_open()) orthogonalize_open_columns(zone, mismatch.head<3>(), d, qr.Q1);
}

void ShootingRod::cut_zones() {
  boundaries_.clear();
  std::size_t contact = 0, segment = 1;
  for (std::size_t node = 0; node <= static_cast<std::size_t>(cells_); ++node) {
    for (; contact < contact_count() && touch_->contacts[contact].closing_node() == node; ++contact)
      if (touch_->contacts[contact].role == ContactRole::kOwn)
        boundaries_.push_back({node, -1, static_cast<int>(contact)});
    if (segment + 1 < segment_first_.size() && segment_first_[segment] == node)
      boundaries_.push_back({node, static_cast<int>(segment++), -1});
  }
}

bool ShootingRod::cross_boundary(std::size_t zone, double* Y) {
  const Boundary& boundary = boundaries_[zone];
  Vec12 mismatch = Vec12::Zero();
  if (boundary.contact >= 0) {
    if (!meet_contact(static_cast<std::size_t>(boundary.contact), zone, Y)) return false;
  } else {
    const NodeState& reached = nodes_[boundary.node];
    const NodeState& start = starts_[static_cast<std::size_t>(boundary.segment)];
    mismatch << log_so3(rotation_of(reached) * rotation_of(start).transpose()),
        position_of(reached) - position_of(start), force_of(reached) - force_of(start),
        moment_of(reached) - moment_of(start);
  }
  orthonormalize(zone, mismatch, Y);
  return true;
}

bool ShootingRod::sweep_columns(const Port& base) {
  const auto S = static_cast<std::size_t>(table_->stages);
  const auto lifted = static_cast<std::size_t>(kernel_->lifted);
  const auto width = static_cast<std::size_t>(columns_);
  const auto linearize = columns_ == kNarrow ? kernel_->linearize_narrow : kernel_->linearize_wide;
  cut_zones();
  const std::size_t zones = boundaries_.size() + 1;
  zone_start_columns_.resize(zones);
  recombinations_.resize(zones);
  cell_directions_.resize(static_cast<std::size_t>(cells_) * lifted * width);
  transition_ = 0;
  if (touch_ || finds_tensions()) begin_open_columns();
  const bool open = is_open();
  alignas(64) double Y[12 * kWide];
  start_columns(base, Y);
  for (std::size_t g = 0; g < zones; ++g) {
    zone_start_columns_[g].assign(Y, Y + 12 * width);
    if (open) keep_open_columns(g);
    if (g == 0) apply_load_columns(0, starts_.front(), Y, columns_);
    if (g == 0 && open) close_open_forces(0, 0, Y);
    for (std::size_t c = zone_first(g); c < zone_end(g); ++c) {
      enter_cell(c);
      if (contact_in(c)) open_contact_columns(c, Y);
      if (open) enter_open_forces(c, g, Y);
      if (!linearize(model_, &stages_[c * S], cell_state(c), nodes_[c + 1], Y,
                     &cell_directions_[c * lifted * width]))
        return false;
      if (open && !sweep_open_columns(c)) return false;
      apply_load_columns(c + 1, nodes_[c + 1], Y, columns_);
      if (open) close_open_forces(c + 1, g, Y);
    }
    if (g + 1 < zones && !cross_boundary(g, Y)) return false;
  }
  // the last zone's columns are left behind the starts
  zone_start_columns_.emplace_back(Y, Y + 12 * width);
  return true;
}

bool ShootingRod::linearize(const Port& base, const Port& tip, CondensedRod& out) {
  return finds_tensions() ? border_.linearize(*this, *tendons_, base, tip, out)
                          : condense(base, tip, out, nullptr);
}

bool ShootingRod::condense(const Port& base, const Port& tip, CondensedRod& out,
                           TensionPorts* tensions) {
  columns_ = base.moves || contact_count() > 0 ? kWide : kNarrow;
  if (!sweep_columns(base)) return false;
  close_tip(tip, zone_start_columns_.back().data(), out);
  close_base(base, out);
  if (is_open()) close_open_ports(base, tip, tensions);
  out.growth = transition_;
  return true;
}

// The tip's six rows in terms of z and the bodies, and the wrench on the tip's body.
void ShootingRod::close_tip(const Port& tip, const double* Y0, CondensedRod& out) const {
  const ConstColumnsMap Y(Y0, 12, columns_);
  const int affine = affine_column(columns_);
  const NodeState& end = nodes_.back();
  const EndRows rows = tip_.rows(end, tip, scale_);
  const Mat12x6 Y_z = Y.leftCols<6>(),
                Y_A = columns_ == kWide ? Mat12x6(Y.middleCols<6>(6)) : Mat12x6(Mat12x6::Zero());
  const Vec12 y = Y.col(affine);
  out.T = rows.by_state * Y_z;
  out.t = rows.value - tip_gap_ + rows.by_state * y;
  out.T_B = rows.by_body;
  out.T_A = rows.by_state * Y_A;
  out.WB_z.setZero();
  out.WB_A.setZero();
  out.WB_B.setZero();
  out.wb.setZero();
  if (!tip_.held()) return;
  const Mat6x12 W = tip_wrench_by_state(tip);
  out.WB_z = W * Y_z;
  out.WB_A = W * Y_A;
  out.WB_B.block<3, 3>(0, 3) = -hat(force_of(end));
  out.wb = wrench_on_tip(tip) + W * y;
}

// On the body: force -n, moment -(m + r × n), r from the body's reference point to the rod's end.
Mat6x12 ShootingRod::tip_wrench_by_state(const Port& tip) const {
  Mat6x12 W = Mat6x12::Zero();
  if (!tip_.held()) return W;
  const NodeState& end = nodes_.back();
  W.block<3, 3>(0, 3) = hat(force_of(end));
  W.block<3, 3>(0, 6) = -hat(position_of(end) - tip.p + tip.arm);
  W.block<3, 3>(0, 9) = -Mat3::Identity();
  W.block<3, 3>(3, 6) = -Mat3::Identity();
  return W;
}

Mat6x12 ShootingRod::base_wrench_by_state(const Port& base) const {
  const NodeState& start = starts_.front();
  Mat6x12 W = Mat6x12::Zero();
  W.block<3, 3>(0, 3) = -hat(force_of(start));
  W.block<3, 3>(0, 6) = hat(position_of(start) - base.p + base.arm);
  W.block<3, 3>(0, 9) = Mat3::Identity();
  W.block<3, 3>(3, 6) = Mat3::Identity();
  return W;
}

// The wrench on the base's body needs z at the first segment: back through the recombinations.
void ShootingRod::close_base(const Port& base, CondensedRod& out) const {
  out.WA_z.setZero();
  out.WA_A.setZero();
  out.wa.setZero();
  if (!base_.held() || !base.moves) return;
  Mat6 Z = Mat6::Identity(), Z_A = Mat6::Zero();
  Vec6 z0 = Vec6::Zero();
  for (std::size_t g = boundaries_.size(); g-- > 0;) {
    const Recombination& rec = recombinations_[g];
    const auto R = rec.R.triangularView<Eigen::Upper>();
    Z_A -= rec.G_A;
    z0 -= rec.g;
    R.solveInPlace(Z);
    R.solveInPlace(Z_A);
    R.solveInPlace(z0);
    if (boundaries_[g].contact < 0) continue;
    Z = (rec.N * Z).eval();
    Z_A = (rec.N * Z_A + rec.P_A).eval();
    z0 = (rec.N * z0 + rec.p).eval();
  }
  const ConstColumnsMap Y(zone_start_columns_.front().data(), 12, columns_);
  const Mat6x12 W = base_wrench_by_state(base);
  const Mat6 W_z = W * Mat12x6(Y.leftCols<6>());
  out.WA_z = W_z * Z;
  out.WA_A = W * Mat12x6(Y.middleCols<6>(6));
  out.WA_A += W_z * Z_A;
  out.WA_A.block<3, 3>(0, 3) += hat(force_of(starts_.front()));
  out.wa = wrench_on_base(base) + W * Vec12(Y.col(affine_column(columns_)));
  out.wa += W_z * z0;
}

Vec6 ShootingRod::wrench_on_base(const Port& base) const {
  const NodeState& start = starts_.front();
  const Vec3 r = position_of(start) - base.p + base.arm;
  Vec6 w;
  w << moment_of(start) + r.cross(force_of(start)), force_of(start);
  return w;
}

Vec6 ShootingRod::wrench_on_tip(const Port& tip) const {
  const NodeState& end = nodes_.back();
  const Vec3 r = position_of(end) - tip.p + tip.arm;
  Vec6 w;
  w << -(moment_of(end) + r.cross(force_of(end))), -force_of(end);
  return w;
}

void ShootingRod::set_direction(const Vec6& z, const Vec6& zeta_A) {
  if (finds_tensions()) {
    find_direction_in_case(border_.complete(z, zeta_A, open_forces()).col(0));
    tension_direction_ = border_.tensions(*tendons_);
  } else {
    find_direction(z, zeta_A, 1);
  }
}

// @param share of the affine part
void ShootingRod::find_direction(const Vec6& z, const Vec6& zeta_A, double share) {
  const auto lifted = static_cast<std::size_t>(kernel_->lifted);
  const auto width = static_cast<std::size_t>(columns_);
  const int affine = affine_column(columns_);
  start_direction_.resize(starts_.size());
  lifted_direction_.resize(static_cast<std::size_t>(cells_) * lifted);
  const bool open = is_open();
  if (touch_) touch_->direction.resize(contact_count());
  Vec6 z_g = z;
  Eigen::Matrix<double, kWide, 1> weights = Eigen::Matrix<double, kWide, 1>::Zero();
  if (columns_ == kWide) weights.segment<6>(6) = zeta_A;
  weights[affine] = share;
  for (std::size_t g = boundaries_.size() + 1; g-- > 0;) {
    if (g < boundaries_.size()) {
      const Recombination& rec = recombinations_[g];
      z_g -= rec.G_A * zeta_A + share * rec.g;
      if (open) step_back_open(g, z_g);
      rec.R.triangularView<Eigen::Upper>().solveInPlace(z_g);
      if (boundaries_[g].contact >= 0) {
        Vec3 df = rec.F * z_g + rec.F_A * zeta_A + share * rec.f;
        Vec6 z_met = rec.N * z_g + rec.P_A * zeta_A + share * rec.p;
        if (open) meet_back_open(g, z_met, df);
        touch_->direction[static_cast<std::size_t>(boundaries_[g].contact)] = df;
        weights.segment<3>(kContactColumn) = df / port_scale_.force;
        z_g = z_met;
      }
    }
    weights.head<6>() = z_g;
    const int segment = g == 0 ? 0 : boundaries_[g - 1].segment;
    if (segment >= 0)
      start_direction_[static_cast<std::size_t>(segment)] =
          ConstColumnsMap(zone_start_columns_[g].data(), 12, columns_)
              .lazyProduct(weights.head(columns_));
    for (std::size_t c = zone_first(g); c < zone_end(g); ++c) {
      const double* D = &cell_directions_[c * lifted * width];
      for (std::size_t i = 0; i < lifted; ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < width; ++k)
          sum += D[i * width + k] * weights[static_cast<Eigen::Index>(k)];
        lifted_direction_[c * lifted + i] = sum;
      }
    }
  }
  if (open) add_open_directions();
}

void ShootingRod::keep() {
  if (finds_tensions()) tendons_->keep();
  kept_starts_ = starts_;
  if (touch_) {
    touch_->kept.clear();
    for (const RodContact& contact : touch_->contacts)
      touch_->kept.push_back(contact.force);
  }
  kept_lifted_.resize(6 * stages_.size());
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    std::copy_n(stages_[j].w, 3, &kept_lifted_[6 * j]);
    std::copy_n(stages_[j].v, 3, &kept_lifted_[6 * j + 3]);
  }
}

void ShootingRod::move(double alpha) {
  if (finds_tensions()) tendons_->move(alpha, tension_direction_);
  for (std::size_t i = 0; i < contact_count(); ++i)
    touch_->contacts[i].force = touch_->kept[i] + alpha * touch_->direction[i];
  for (std::size_t g = 0; g < starts_.size(); ++g) {
    const Vec12 d = alpha * start_direction_[g];
    NodeState& s = starts_[g];
    const NodeState& kept = kept_starts_[g];
    const Mat3 R = exp_so3(d.head<3>()) * Mat3(rotation_of(kept));
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(s.R) = orthonormalized(R);
    Eigen::Map<Vec3>(s.p) = position_of(kept) + d.segment<3>(3);
    Eigen::Map<Vec3>(s.n) = force_of(kept) + d.segment<3>(6);
    Eigen::Map<Vec3>(s.m) = moment_of(kept) + d.segment<3>(9);
  }
  const auto S = static_cast<std::size_t>(table_->stages);
  const auto lifted = static_cast<std::size_t>(kernel_->lifted);
  for (std::size_t j = 0; j < stages_.size(); ++j) {
    const double* d = &lifted_direction_[j / S * lifted + 3 * (j % S)];
    for (std::size_t i = 0; i < 3; ++i)
      stages_[j].w[i] = kept_lifted_[6 * j + i] + alpha * d[i];
    if (lifts_stretch(law_))
      for (std::size_t i = 0; i < 3; ++i)
        stages_[j].v[i] = kept_lifted_[6 * j + 3 + i] + alpha * d[3 * S + i];
  }
}

}  // namespace cprsim
