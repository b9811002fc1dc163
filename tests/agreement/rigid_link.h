// SPDX-License-Identifier: BSD-3-Clause
// A discretisation that the program does not know: the simplest there can be, a massless rigid
// link. This file alone holds it.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "engine/math/archive.h"
#include "engine/math/so3.h"
#include "engine/rod/make_rod.h"

namespace cprsim {

/// Rigid and without mass, clamped at both ends. With frames A and B of its ends, r = L R_A e_z and
/// the wrench (m, n) that it exerts on the tip's body at B, world axes:
///   (1) log(R_A^T R_B) = 0,  (R_A^T (p_B - p_A) - L e_z) / L = 0
///   (2) W_B = (m + arm_B x n, n),  W_A = (-m - (arm_A + r) x n, -n)     about reference points
/// z = (m, n) in units of EI/L and EI/L². The rows do not contain it, T = 0: a link transmits any
/// wrench, so that its own is an unknown of the robot.
class RigidLink : public RodModel {
 public:
  explicit RigidLink(const RodPlan& plan)
      : name_(plan.spec->name), L_(plan.length), X_WA_(plan.X_WBase), X_WB_(plan.X_WTip) {
    const bool clamped = plan.spec->base.joint == EndJoint::kFixed && !plan.spec->base.spin_free &&
                         plan.spec->tip.joint == EndJoint::kFixed && !plan.spec->tip.spin_free;
    if (!clamped || plan.plane || !plan.stations.empty() || !plan.tendons.empty() ||
        !plan.spec->disks.empty() || plan.line_loads || plan.touches)
      throw std::invalid_argument("'" + name_ + "': a rigid link is clamped, and bears nothing");
    const double EI = plan.section.K_bt.head<2>().maxCoeff();
    units_ << Vec3::Constant(EI / L_), Vec3::Constant(EI / (L_ * L_));
    track_.resize(6);
  }

  void prepare(const StageRates&, const RodForcing& forcing) override { L_ = forcing.length; }

  RodResidual evaluate(const Port& base, const Port& tip) override {
    X_WA_ = {base.R, base.p};
    X_WB_ = {tip.R, tip.p};
    closure_ = closure(base, tip);
    const Vec6 rows = closure_ - held_gap_;
    RodResidual residual;
    residual.sum_squares = rows.squaredNorm();
    residual.largest = rows.cwiseAbs().maxCoeff(&residual.worst_row);
    residual.finite = rows.allFinite();
    return residual;
  }

  bool linearize(const Port& base, const Port& tip, CondensedRod& out) override {
    out.growth = 0;
    const Mat3 to_A = base.R.transpose(), n = hat(force());
    const Vec3 across = tip.p - base.p, r = L_ * base.R.col(2);
    // d log(exp(delta) Q) = J_l^-1 delta, and J_l(rho) = J_r(-rho)
    const Mat3 turned = right_jacobian_inverse(-closure_.head<3>()) * to_A;
    out.T.setZero();
    out.T_A.setZero();
    out.T_A.topLeftCorner<3, 3>() = -turned;
    out.T_A.bottomLeftCorner<3, 3>() = to_A * (hat(base.arm) + hat(across)) / L_;
    out.T_A.bottomRightCorner<3, 3>() = -to_A / L_;
    out.T_B.setZero();
    out.T_B.topLeftCorner<3, 3>() = turned;
    out.T_B.bottomLeftCorner<3, 3>() = -to_A * hat(tip.arm) / L_;
    out.T_B.bottomRightCorner<3, 3>() = to_A / L_;
    out.t = closure_ - held_gap_;
    out.WB_z.setIdentity();
    out.WB_z.topRightCorner<3, 3>() = hat(tip.arm);
    out.WB_z = out.WB_z * units_.asDiagonal();
    out.WB_A.setZero();
    out.WB_B.setZero();
    out.WB_B.topLeftCorner<3, 3>() = n * hat(tip.arm);
    out.wb = wrench_on_tip(tip);
    out.WA_z = -Mat6::Identity();
    out.WA_z.topRightCorner<3, 3>() = -hat(base.arm + r);
    out.WA_z = out.WA_z * units_.asDiagonal();
    out.WA_A.setZero();
    out.WA_A.topLeftCorner<3, 3>() = -n * hat(base.arm + r);
    out.wa = wrench_on_base(base);
    return true;
  }

  void set_direction(const Vec6& z, const Vec6&) override { direction_ = z; }

  void keep() override { kept_ = z_; }

  void move(double alpha) override { z_ = kept_ + alpha * direction_; }

  Vec6 wrench_on_base(const Port& base) const override {
    Vec6 wrench;
    wrench << -moment() - (base.arm + L_ * base.R.col(2)).cross(force()), -force();
    return wrench;
  }

  Vec6 wrench_on_tip(const Port& tip) const override {
    Vec6 wrench;
    wrench << moment() + tip.arm.cross(force()), force();
    return wrench;
  }

  void capture_gap(const Port& base, const Port& tip) override { gap_ = closure(base, tip); }

  void hold_gap(double fraction) override { held_gap_ = fraction * gap_; }

  void set_curve(const RodCurve&) override {}

  void bow(const Port&, const Port&) override {}  // nothing of it can

  void mark_positions() override {}

  // its ends, whose velocities are shown
  std::vector<Track*> tracks() override { return {&track_}; }

  void fill_tracks() override { track_.x << X_WA_.p, X_WB_.p; }

  Eigen::Index position_coordinates() const override { return 6; }

  void accept_tracks() override {}

  void start_tracks() override {
    fill_tracks();
    track_.set_start(VecX(track_.x), VecX::Zero(6));
  }

  void start_tracks_moving() override { start_tracks(); }

  Unknowns unknowns() const override {
    Unknowns u;
    u.values = z_;
    return u;
  }

  void set_unknowns(const Unknowns& u) override { z_ = u.values; }

  void predict(const std::vector<const Unknowns*>& past,
               const std::vector<double>& weights) override {
    z_.setZero();
    for (std::size_t i = 0; i < past.size(); ++i)
      z_ += weights[i] * past[i]->values;
  }

  void visit(Archive& archive) override {
    archive(z_);
    archive(X_WA_);
    archive(X_WB_);
    track_.visit(archive);
  }

  RodSample observe() const override {
    RodSample sample;
    sample.length = L_;
    sample.radius = 1e-3;
    for (double s : {0., 1.}) {
      RodPoint point;
      point.s = s;
      point.position = X_WA_.p + s * L_ * X_WA_.R.col(2);
      point.rotation = X_WA_.R;
      if (track_.x_t.size() == 6) point.velocity = track_.x_t.segment<3>(s == 0 ? 0 : 3);
      // the far part on the near part: the tip's body on the link
      point.force = -force();
      point.moment = -moment() - (1 - s) * L_ * X_WA_.R.col(2).cross(force());
      sample.points.push_back(point);
    }
    return sample;
  }

  RodField field() const override {
    throw std::invalid_argument("'" + name_ + "': a rigid link has no strain to vary");
  }

  RodEnergy energy() const override {
    RodEnergy energy;
    energy.feed_power = X_WA_.R.col(2).dot(force());
    return energy;
  }

  std::string row_name(int row) const override {
    return "'" + name_ + "', " + (row < 3 ? "angle" : "distance") + " of its ends";
  }

  RodResolution resolution() const override { return {Method::kAuto, "rigid", 1, 0}; }

  int cells() const override { return 1; }

  int segments() const override { return 1; }

  int unknown_count() const override { return 6; }

  long section_evaluations() const override { return 0; }

  double growth_exponent() const override { return 0; }

 private:
  Vec6 closure(const Port& base, const Port& tip) const {
    Vec6 rows;
    rows << log_so3(base.R.transpose() * tip.R),
        base.R.transpose() * (tip.p - base.p) / L_ - Vec3::UnitZ();
    return rows;
  }

  Vec3 moment() const { return units_.head<3>().cwiseProduct(z_.head<3>()); }

  Vec3 force() const { return units_.tail<3>().cwiseProduct(z_.tail<3>()); }

  std::string name_;
  double L_;
  Pose X_WA_, X_WB_;
  Vec6 units_;
  Vec6 z_ = Vec6::Zero(), kept_ = Vec6::Zero(), direction_ = Vec6::Zero();
  Vec6 closure_ = Vec6::Zero(), gap_ = Vec6::Zero(), held_gap_ = Vec6::Zero();
  Track track_;
};

}  // namespace cprsim
