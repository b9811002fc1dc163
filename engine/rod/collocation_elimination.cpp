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

/// [I; load_by_motion] as it acts on (phi, dp, dn, dm).
Mat12 passing(const Mat6& load_by_motion) {
  Mat12 P = Mat12::Identity();
  P.bottomLeftCorner<6, 6>() += load_by_motion;
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
  const auto add = [&](const auto& block) {
    for (int r = 0; r < block.rows(); ++r)
      for (int c = 0; c < block.cols(); ++c)
        if (block(r, c) != 0) system_.at(row + r, width() * control + c) += block(r, c);
  };
  if (planar_axis_ < 0)
    add(J);
  else
    add(Eigen::Matrix<double, 7, 7>(Eigen::Matrix<double, 7, 13>(rows_ * J) * increments_));
}

// The joint's rows, and |q|² = 1.
void CollocationRod::assemble_base(const Port& base) {
  const int d = static_cast<int>(space_.freedoms());
  const NodeState start = base_state();
  const ConditionRows rows = base_.rows(start, base, scale_);
  const MatX J = rows.by_state * passing(load_by_motion(0, Mat3(rotation_of(start)))) *
                 increment_units().tail<12>().asDiagonal() * space_.state;
  const MatX by_body = rows.by_body * space_.motion;
  const VecX value = rows.value - base_gap_;
  for (int r = 0; r < d; ++r) {
    for (int c = 0; c < 2 * d; ++c)
      system_.at(r, 1 + c) = J(r, c);
    for (int c = 0; c < d && base_moves_; ++c)
      system_.dense(r, c) = by_body(r, c);
    system_.dense(r, affine()) = value[r];
  }
  if (force_columns() > 0) assemble_contacts(rows);
  const double square = control_.front().head<4>().squaredNorm();
  system_.at(d, 0) = 2 * square;
  system_.dense(d, affine()) = square - 1;
}

void CollocationRod::assemble_join(std::size_t piece, int row) {
  const int at = pieces_[piece].first_control;
  const Vec4 q = control_[static_cast<std::size_t>(at - 1)].head<4>();
  Mat13 before = -Mat13::Identity();
  const Mat6 load = load_by_motion(piece, rotation_of(q));
  before.bottomLeftCorner<6, 4>() += load.leftCols<3>() * turn_by_quaternion(q);
  before.block<6, 3>(kN, kP) += load.rightCols<3>();
  put(row, at - 1, before);
  put(row, at, Mat13::Identity());
}

void CollocationRod::assemble_points(std::size_t piece, int row) {
  Mat13 by_y, by_y_s;
  for (int i = 0; i < pieces_[piece].points; ++i, row += width()) {
    const auto j = static_cast<std::size_t>(pieces_[piece].first_point + i);
    linearize_point(model(j), points_[j], by_y, by_y_s, fluid_at(j), tendons_at(j));
    const BasisValues& b = sites_[j].basis;
    for (int k = 0; k <= options_.degree; ++k)
      if (b.value[k] != 0 || b.slope[k] != 0)
        put(row, b.first + k, b.value[k] * by_y + b.slope[k] / forcing_.length * by_y_s);
  }
}

/// How far rows reach to both sides of the diagonal.
void CollocationRod::find_band() {
  const int w = width(), first_row = w / 2 + 1;
  lower_ = upper_ = 0;
  const auto reach = [&](int row, int first, int last) {
    lower_ = std::max(lower_, row + w - 1 - w * first);
    upper_ = std::max(upper_, w * last + w - 1 - row);
  };
  reach(first_row - w, 0, 0);
  int row = first_row;
  for (std::size_t g = 0; g < pieces_.size(); ++g) {
    if (g > 0) {
      reach(row, pieces_[g].first_control - 1, pieces_[g].first_control);
      row += w;
    }
    for (int i = 0; i < pieces_[g].points; ++i, row += w) {
      const int first = sites_[static_cast<std::size_t>(pieces_[g].first_point + i)].basis.first;
      reach(row, first, first + options_.degree);
    }
  }
}

void CollocationRod::assemble(const Port& base) {
  const int d = static_cast<int>(space_.freedoms());
  system_.reset(columns() - d, columns(), lower_, upper_, given());
  assemble_base(base);
  int row = d + 1;
  for (std::size_t g = 0; g < pieces_.size(); ++g) {
    if (g > 0) {
      assemble_join(g, row);
      row += width();
    }
    assemble_points(g, row);
    row += width() * pieces_[g].points;
  }
  row = d + 1;
  for (const Vec13& residual : residual_) {
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 13, 1> values = rows_ * residual;
    for (int i = 0; i < width(); ++i)
      system_.dense(row++, affine()) = values[i];
  }
  if (finds_tensions()) assemble_tensions();
}

// d rows remain on the last control point's 2d unknowns (phi, dp, dn, dm).
bool CollocationRod::linearize(const Port& base, const Port& tip, CondensedRod& out) {
  return finds_tensions() ? border_.linearize(*this, *tendons_, base, tip, out)
                          : condense(base, tip, out, nullptr);
}

bool CollocationRod::condense(const Port& base, const Port& tip, CondensedRod& out,
                              TensionPorts* tensions) {
  const Eigen::Index d = space_.freedoms();
  base_moves_ = base_.held() && base.moves;
  assemble(base);
  system_.scale_rows();
  if (!system_.eliminate(columns() - static_cast<int>(2 * d))) return false;
  MatX general;
  if (!general_solution(system_.remaining(), system_.remaining_dense(), general)) return false;
  const int forces = force_columns(), pulls = tension_columns();
  last_ = MatX::Zero(2 * d, 2 * d + 1 + forces + pulls);
  last_.leftCols(d) = general.leftCols(d);
  last_.rightCols(given()) = general.rightCols(given());

  const NodeState end = tip_state();
  MatX Y = passing(-load_by_motion(pieces_.size(), Mat3(rotation_of(end)))) *
           increment_units().tail<12>().asDiagonal() * space_.state * last_;
  const MorePorts more{forces > 0 ? &touch_->ports() : nullptr, tensions, pulls};
  if (more.forces) {
    Y.block(6, 2 * d + 1, 6, forces) -= contact_loads(pieces_.size());
    more.forces->WA_F.setZero(6, forces);
  }
  if (tensions) tensions->WA.setZero(d, pulls);
  ConditionRows rows = tip_.rows(end, tip, scale_);
  rows.value -= tip_gap_;
  condense_tip(space_, rows, tip_.held(), end, tip, Y, out, more);
  out.WA_z.setZero();
  out.WA_A.setZero();
  out.wa.setZero();
  const NodeState start = base_state();
  if (base_moves_) condense_base(space_, start, base, base_columns(start), out, more);
  if (more.forces) describe_contacts(tensions);
  out.growth = 0;
  return true;
}

/// The state before a load at the base, by back-substitution of all columns.
MatX CollocationRod::base_columns(const NodeState& start) const {
  const Eigen::Index d = space_.freedoms();
  MatX w = MatX::Zero(given(), d + given());
  w.rightCols(given()).setIdentity();
  MatX Y = passing(load_by_motion(0, Mat3(rotation_of(start)))) *
           increment_units().tail<12>().asDiagonal() * space_.state *
           system_.substitute(last_, w).middleRows(1, 2 * d);
  if (force_columns() > 0) Y.block(6, 2 * d + 1, 6, force_columns()) += contact_loads(0);
  return Y;
}

Vec6 CollocationRod::wrench_on_base(const Port& base) const {
  return cprsim::wrench_on_base(space_, base_state(), base);
}

Vec6 CollocationRod::wrench_on_tip(const Port& tip) const {
  return cprsim::wrench_on_tip(space_, tip_state(), tip);
}

void CollocationRod::set_direction(const Vec6& z, const Vec6& zeta_A) {
  const Eigen::Index d = space_.freedoms();
  const VecX forces = force_columns() > 0 ? touch_->direction() : VecX(0);
  VecX all;
  if (finds_tensions()) {
    all = border_.complete(z, zeta_A, forces);
    tension_direction_ = border_.tensions(*tendons_);
  } else {
    all.resize(2 * d + 1 + forces.size());
    all << z.head(d), zeta_A.head(d), 1, forces;
  }
  const MatX x = system_.substitute(last_ * all, all.tail(given()));
  const Vec13 units = increment_units();
  direction_.resize(control_.size());
  for (std::size_t k = 0; k < control_.size(); ++k)
    direction_[k] = units.cwiseProduct(
        Vec13(increments_ * x.middleRows(static_cast<Eigen::Index>(k) * width(), width())));
}

void CollocationRod::keep() {
  if (finds_tensions()) tendons_->keep();
  if (touch_) touch_->keep();
  kept_ = control_;
}

void CollocationRod::move(double alpha) {
  if (finds_tensions()) tendons_->move(alpha, tension_direction_);
  if (touch_) touch_->move(alpha);
  for (std::size_t k = 0; k < control_.size(); ++k) {
    const Vec13 d = alpha * direction_[k];
    control_[k].head<4>() =
        std::exp(d[0]) *
        quaternion_product(quaternion_of(Vec3(d.segment<3>(1))), Vec4(kept_[k].head<4>()));
    control_[k].tail<9>() = kept_[k].tail<9>() + d.tail<9>();
  }
}

}  // namespace cprsim
