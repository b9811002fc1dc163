// SPDX-License-Identifier: BSD-3-Clause
// Shapes to start from, gaps that close by and by, and what time schemes integrate.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/math/so3.h"
#include "engine/rod/collocation.h"
#include "engine/rod/tableau.h"

namespace cprsim {

/// R(s) = R_base exp(turn(s)^), unsheared and without force: interpolated at the Greville abscissae
/// of the fields' space, between which p is integrated.
void CollocationRod::set_shape(const Pose& X_WBase, const std::function<Vec3(double)>& turn) {
  set_turned(X_WBase, [&](double s) { return quaternion_of(turn(s)); });
}

void CollocationRod::set_turned(const Pose& X_WBase, const std::function<Vec4(double)>& turned) {
  const Vec4 q_base = quaternion_of(X_WBase.R);
  const auto q = [&](double s) { return quaternion_product(q_base, turned(s)); };
  const ArcTableau& gauss = arc_tableau(ArcIntegrator::kGauss6);
  Vec3 p = X_WBase.p;
  double s = 0;
  for (const Piece& piece : pieces_) {
    const std::vector<double> at = piece.space.greville();
    MatX values = MatX::Zero(piece.space.size(), 13);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double h = at[i] - s;
      for (int k = 0; k < gauss.stages; ++k)
        p += h * forcing_.length * gauss.b[k] * rotation_of(q(s + gauss.c[k] * h)).col(2);
      s = at[i];
      const auto row = static_cast<Eigen::Index>(i);
      values.block<1, 4>(row, kQ) = q(s).transpose();
      values.block<1, 3>(row, kP) = p.transpose();
    }
    const MatX control = piece.space.interpolate(values);
    for (Eigen::Index k = 0; k < control.rows(); ++k)
      control_[static_cast<std::size_t>(piece.first_control + k)] = control.row(k).transpose();
  }
  if (touch_) update_touch_nodes();
}

void CollocationRod::set_rotated(const Pose& X_WBase, const std::function<Mat3(double)>& rotation) {
  // of the two quaternions of a rotation the one next to the last
  Vec4 last = Vec4::UnitX();
  set_turned(X_WBase, [&](double s) {
    const Vec4 q = quaternion_of(rotation(s));
    last = q.dot(last) < 0 ? Vec4(-q) : q;
    return last;
  });
}

void CollocationRod::set_curve(const RodCurve& curve) {
  const Pose base = curve.pose(0);
  set_rotated(base, [&](double s) { return Mat3(base.R.transpose() * curve.pose(s).R); });
  for (std::size_t j = 0; j < points_.size(); ++j)
    points_[j].y.segment<3>(kP) = curve.pose(sites_[j].s).p;
}

void CollocationRod::set_unloaded(const Pose& X_WBase) {
  if (options_.along) {
    set_rotated(X_WBase, [&](double s) { return options_.along->unloaded(s, forcing_.length).R; });
    return;
  }
  set_shape(X_WBase, [&](double s) { return Vec3(s * forcing_.length * section_.u_rest); });
}

void CollocationRod::capture_gap(const Port& base, const Port& tip) {
  // a free end has no joint that could gape
  if (base_.held()) base_gap_start_ = base_.value(base_state(), base, scale_);
  if (tip_.held()) tip_gap_start_ = tip_.value(tip_state(), tip, scale_);
}

void CollocationRod::hold_gap(double fraction) {
  base_gap_ = fraction * base_gap_start_;
  tip_gap_ = fraction * tip_gap_start_;
}

// The buckled clamped column, as in engine/rod/shooting_observe.cpp.
void CollocationRod::bow(const Port& base, const Port& tip) {
  const Vec3 chord = tip.p - base.p;
  const double ratio = chord.norm() / forcing_.length;
  if (ratio > 0.999) return;
  Mat3 R = base.R;
  const Vec3 unloaded = options_.along
                            ? Vec3(R * options_.along->unloaded(1, forcing_.length).p)
                            : Vec3(R * right_jacobian(-forcing_.length * section_.u_rest).col(2));
  if (!base_.fixed() && ratio > 1e-6) R = rotation_between(unloaded, chord) * R;
  if (options_.along ? options_.along->bent_at_rest()
                     : !section_.u_rest.isZero()) {  // a bent rod knows where to go
    set_unloaded({R, base.p});
    return;
  }
  const double A = std::min(2.2, 2 * std::sqrt(1 - ratio));
  const int weaker = section_.K_bt.x() <= section_.K_bt.y() ? 0 : 1;
  const int axis = planar_axis_ < 0 ? weaker : planar_axis_;
  set_shape({R, base.p}, [&](double s) {
    return Vec3(A * std::sin(2 * std::numbers::pi * s) * Vec3::Unit(axis));
  });
}

void CollocationRod::mark_positions() {
  marked_.resize(points_.size());
  for (std::size_t j = 0; j < points_.size(); ++j)
    marked_[j] = points_[j].p();
}

std::vector<Track*> CollocationRod::tracks() {
  std::vector<Track*> all{&track_};
  if (tendons_) all.push_back(tendons_->track());
  if (options_.rotary_inertia) all.push_back(&rotation_track_);
  if (touch_ && touch_->turns()) all.push_back(touch_->turns());
  if (disks_ && disks_->turns()) all.push_back(disks_->turns());
  return all;
}

void CollocationRod::fill_tracks() {
  if (tendons_) tendons_->fill_track();
  if (touch_) touch_->fill_turns();
  if (disks_) disks_->fill_turns();
  const auto n = static_cast<Eigen::Index>(points_.size());
  for (std::size_t j = 0; j < points_.size(); ++j) {
    const CollocationPoint& point = points_[j];
    const auto i = 3 * static_cast<Eigen::Index>(j), strain = strain_track() + i;
    track_.x.segment<3>(i) = point.p();
    if (options_.damping) track_.x.segment<3>(strain) = point.u;
    if (options_.damping && extensible_) track_.x.segment<3>(strain + 3 * n) = point.v;
    if (!options_.rotary_inertia) continue;
    rotation_track_.x.segment<3>(i) = Eigen::Map<const Vec3>(point.spin.theta);
    rotation_track_.v.segment<3>(i) = Eigen::Map<const Vec3>(point.spin.omega);
  }
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    track_.x.segment<3>(3 * (n + static_cast<Eigen::Index>(k))) = value(nodes_[k]).segment<3>(kP);
}

void CollocationRod::accept_tracks() {
  if (touch_) touch_->accept_contacts();
  if (tendons_) tendons_->accept();
  if (disks_) disks_->accept();
  if (!options_.rotary_inertia) return;
  for (std::size_t j = 0; j < points_.size(); ++j)
    reference_rotations_[j] = points_[j].R;
}

void CollocationRod::start_tracks() {
  accept_tracks();
  if (tendons_) tendons_->start_track();
  if (disks_) disks_->start();
  for (CollocationPoint& point : points_) {
    std::fill_n(point.spin.theta, 3, 0.0);
    std::fill_n(point.spin.omega, 3, 0.0);
  }
  fill_tracks();
  track_.set_start(track_.x, VecX::Zero(track_.x.size()));
  if (touch_) touch_->start_turns();
  if (options_.rotary_inertia)
    rotation_track_.set_start(VecX::Zero(rotation_track_.x.size()),
                              VecX::Zero(rotation_track_.x.size()));
}

// The direction of the control points is one of the fields, and rows (2), (3) of
// engine/rod/collocation_point.h say what it is of the strains.
void CollocationRod::start_tracks_moving() {
  start_tracks();
  if (tendons_) {
    VecX all(13 * static_cast<Eigen::Index>(direction_.size()));
    for (std::size_t k = 0; k < direction_.size(); ++k)
      all.segment<13>(13 * static_cast<Eigen::Index>(k)) = direction_[k];
    std::vector<Vec6> rates;
    strain_rates(all, rates);
    tendons_->start_track_moving(rates);
  }
  const auto n = static_cast<Eigen::Index>(points_.size());
  std::vector<Vec13> moving = control_;
  for (std::size_t k = 0; k < control_.size(); ++k) {
    const Vec4 q = control_[k].head<4>();
    moving[k] << quaternion_by_increment(q) * direction_[k].head<4>(), direction_[k].tail<9>();
  }
  control_.swap(moving);  // value() and derivative() of the direction
  PointModel rigid = model_;
  rigid.C_bt.setZero();
  Mat13 by_y, by_y_s;
  for (std::size_t j = 0; j < points_.size(); ++j) {
    CollocationPoint& point = points_[j];
    const auto i = 3 * static_cast<Eigen::Index>(j), strain = strain_track() + i;
    const Vec13 y = value(sites_[j]), y_s = derivative(sites_[j]);
    const Vec3 phi = turn_by_quaternion(Vec4(point.y.head<4>())) * y.head<4>();
    Eigen::Map<Vec3>(point.spin.omega) = point.R.transpose() * phi;
    track_.v.segment<3>(i) = y.segment<3>(kP);
    if (options_.rotary_inertia)
      rotation_track_.v.segment<3>(i) = Eigen::Map<const Vec3>(point.spin.omega);
    if (!options_.damping) continue;
    linearize_point(rigid, point, by_y, by_y_s);
    track_.v.segment<3>(strain) = (by_y * y + by_y_s * y_s).segment<3>(kQ + 1);
    if (extensible_ && tendons_)  // whose law does not say what v is
      track_.v.segment<3>(strain + 3 * n) =
          point.R.transpose() * (y_s.segment<3>(kP) + point.y_s.segment<3>(kP).cross(phi));
    else if (extensible_)
      track_.v.segment<3>(strain + 3 * n) = model(j).C_se.cwiseProduct(
          point.R.transpose() * (y.segment<3>(kN) + point.n().cross(phi)));
  }
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    track_.v.segment<3>(3 * (n + static_cast<Eigen::Index>(k))) = value(nodes_[k]).segment<3>(kP);
  control_.swap(moving);
  track_.set_start(track_.x, VecX(track_.v));
  if (disks_) {
    for (std::size_t g = 1; g <= pieces_.size(); ++g) {
      const auto end = static_cast<std::size_t>(&end_of_piece(g) - control_.data());
      disks_->set_rate(g, direction_[end].segment<3>(1));
    }
    disks_->start_moving();
  }
  if (options_.rotary_inertia)
    rotation_track_.set_start(VecX::Zero(rotation_track_.x.size()), VecX(rotation_track_.v));
}

}  // namespace cprsim
