// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/joint.h"

#include <numbers>

#include "engine/math/so3.h"

namespace cprsim {
namespace {

Vec3 force_axis(const Mat63& twists, Eigen::Index i) {
  return twists.col(i).tail<3>();
}

Vec3 moment_axis(const Mat63& twists, Eigen::Index i) {
  return twists.col(i).head<3>();
}

}  // namespace

Joint::Joint(const JointSpec& joint, int parent_body, int child_body, const Pose& X_parent_J,
             const Pose& X_child_J)
    : spec(&joint), parent(parent_body), child(child_body), X_PJ_(X_parent_J), X_CJ_(X_child_J) {
  for (int i = 0; i < freedom_count(joint.kind); ++i) {
    Freedom freedom;
    freedom.spec = &axis_of(joint, i);
    freedom.axis = freedom.spec->axis;
    const bool slide = slides(joint.kind, i);
    freedom.turn = slide ? 0 : 1;
    freedom.slide = slide ? 1 : 0;
    if (joint.kind == JointKind::kScrew) freedom.slide = joint.screw_pitch / (2 * std::numbers::pi);
    freedom.law.set_scale(*freedom.spec, 1, 1);
    freedoms.push_back(freedom);
  }
  // the turn of a cylindrical joint is about the direction of its slide, that of a planar one about
  // the normal of its plane
  if (joint.kind == JointKind::kCylindrical) freedoms[1].axis = joint.axis;
  if (joint.kind == JointKind::kPlanar)
    freedoms[2].axis = joint.axis.cross(joint.second.axis).normalized();
  track.resize(static_cast<Eigen::Index>(freedoms.size()));
  spin.resize(3);
  count_unknowns();
}

void Joint::count_unknowns() {
  unknown_coordinates_ = 0;
  for (Freedom& freedom : freedoms)
    freedom.unknown = freedom.motion == Motion::kFree ? unknown_coordinates_++ : -1;
}

void Joint::set_scale(double length, double moment, double force) {
  for (Freedom& freedom : freedoms) {
    const bool slide = freedom.measured_as_length();
    freedom.law.set_scale(*freedom.spec, slide ? length : 1, slide ? force : moment);
  }
}

Pose Joint::parent_frame(const Pose& X_W_parent) const {
  Pose J = X_W_parent * X_PJ_;
  for (std::size_t i = 0; i < freedoms.size(); ++i) {
    const Freedom& freedom = freedoms[i];
    const double x = q[static_cast<Eigen::Index>(i)];
    if (freedom.slide != 0) J.p += J.R * freedom.axis * (freedom.slide * x);
    if (freedom.turn != 0) J.R = J.R * exp_so3(freedom.axis * (freedom.turn * x));
  }
  return J;
}

// (angular, linear) of J_P by each q. No slide follows a turn about another axis, so every axis
// passes through the origin of J_P.
Mat63 Joint::twists(const Pose& X_W_parent) const {
  Mat63 A = Mat63::Zero();
  Mat3 R = X_W_parent.R * X_PJ_.R;
  for (std::size_t i = 0; i < freedoms.size(); ++i) {
    const Freedom& freedom = freedoms[i];
    const auto k = static_cast<Eigen::Index>(i);
    const Vec3 a = R * freedom.axis;
    A.col(k) << freedom.turn * a, freedom.slide * a;
    if (freedom.turn != 0) R = R * exp_so3(freedom.axis * (freedom.turn * q[k]));
  }
  return A;
}

Mat3 Joint::relative_attitude(const Pose& X_W_parent, const Pose& X_W_child) const {
  return (X_W_parent.R * X_PJ_.R).transpose() * X_W_child.R * X_CJ_.R;
}

Pose Joint::displacement(const Pose& X_W_parent) const {
  return parent_frame(X_W_parent) * (X_W_parent * X_PJ_).inverse();
}

Joint::Rows Joint::rows(const Pose& X_W_parent, const Pose& X_W_child, const StageRates& rates,
                        double length, double moment, double force) const {
  Rows rows;
  const Pose J_P = parent_frame(X_W_parent), J_C = X_W_child * X_CJ_;
  const Mat3 Jt = J_P.R.transpose();
  const Vec3 e = log_so3(Jt * J_C.R), d = J_C.p - J_P.p;
  rows.closure << e, Jt * d / length;
  rows.axes = J_P.R;
  // d log Q = J_l^-1(e) R_JP^T (phi_C - phi_JP)
  const Mat3 by_turn = right_jacobian_inverse(-e) * Jt;
  const Vec3 arm_P = J_P.p - X_W_parent.p, arm_C = J_C.p - X_W_child.p;
  rows.by_parent.setZero();
  rows.by_child.setZero();
  rows.by_lambda.setZero();
  rows.by_q.setZero();
  rows.by_child.topLeftCorner<3, 3>() = by_turn;
  rows.by_parent.topLeftCorner<3, 3>() = -by_turn;
  rows.by_child.bottomLeftCorner<3, 3>() = -Jt * hat(arm_C) / length;
  rows.by_child.bottomRightCorner<3, 3>() = Jt / length;
  rows.by_parent.bottomLeftCorner<3, 3>() = Jt * (hat(d) + hat(arm_P)) / length;
  rows.by_parent.bottomRightCorner<3, 3>() = -Jt / length;
  const Mat63 A = twists(X_W_parent);
  rows.by_q.topRows<3>() = -by_turn * A.topRows<3>();
  rows.by_q.bottomRows<3>() = Jt * (hat(d) * A.topRows<3>() - A.bottomRows<3>()) / length;
  if (is_ball()) make_ball(rows, J_P, J_C, rates, moment);
  add_efforts(rows, X_W_parent, rates, moment, force);
  return rows;
}

// (2)
void Joint::add_efforts(Rows& rows, const Pose& X_W_parent, const StageRates& rates, double moment,
                        double force) const {
  rows.effort.setZero();
  rows.effort_by_lambda.setZero();
  rows.effort_by_parent.setZero();
  rows.effort_by_q.setZero();
  const Mat63 A = twists(X_W_parent);
  const Vec3 m = lambda.head<3>(), f = lambda.tail<3>();
  for (std::size_t k = 0; k < freedoms.size(); ++k) {
    const Freedom& freedom = freedoms[k];
    const auto i = static_cast<Eigen::Index>(k);
    const double unit = freedom.measured_as_length() ? force : moment;
    const double rate = rates.dynamic() ? rates.c_v * q[i] + track.x_h[i] : 0;
    const AxisEffort tau = freedom.law.total(*freedom.spec, q[i], rate);
    const Vec3 w = moment_axis(A, i), v = force_axis(A, i);
    rows.effort[i] = (w.dot(m) + v.dot(f) - tau.value - freedom.effort) / unit;
    rows.effort_by_lambda.row(i) = A.col(i).transpose() / unit;
    // axes turn with the parent and with the turns before them
    const Vec3 by_turn = w.cross(m) + v.cross(f);
    rows.effort_by_parent.row(i).head<3>() = by_turn.transpose() / unit;
    for (Eigen::Index j = 0; j < i; ++j)
      rows.effort_by_q(i, j) = by_turn.dot(moment_axis(A, j)) / unit;
    rows.effort_by_q(i, i) = -(tau.by_q + rates.c_v * tau.by_rate) / unit;
  }
}

// (3)
void Joint::make_ball(Rows& rows, const Pose& J_P, const Pose& J_C, const StageRates& rates,
                      double moment) const {
  const Mat3 Ct = J_C.R.transpose(), Q = J_P.R.transpose() * J_C.R;
  const Vec3 e = log_so3(Q), m = lambda.head<3>();
  Vec3 row = Ct * m + spec->spring_stiffness * e;
  Mat3 by_turn = spec->spring_stiffness * right_jacobian_inverse(e);
  if (rates.dynamic()) {
    const Vec3 theta = log_so3(Q_start_.transpose() * Q), theta_t = rates.c_v * theta + spin.x_h;
    Vec3 omega = theta_t;
    Mat3 omega_by_theta = rates.c_v * Mat3::Identity();
    if (rates.body_rates) {
      const Mat3 J_r = right_jacobian(theta);
      omega = J_r * theta_t;
      omega_by_theta = rates.c_v * J_r + right_jacobian_derivative(theta, theta_t);
    }
    row += spec->damping * omega;
    by_turn += spec->damping * omega_by_theta * right_jacobian_inverse(theta);
  }
  by_turn = (by_turn * Ct).eval();
  rows.closure.head<3>() = row / moment;
  rows.by_parent.topRows<3>().setZero();
  rows.by_child.topRows<3>().setZero();
  rows.by_parent.topLeftCorner<3, 3>() = -by_turn / moment;
  rows.by_child.topLeftCorner<3, 3>() = (Ct * hat(m) + by_turn) / moment;
  rows.by_lambda.topLeftCorner<3, 3>() = Ct / moment;
}

Joint::Wrenches Joint::wrenches(const Pose& X_W_parent, const Pose& X_W_child) const {
  Wrenches w;
  const Vec3 at = place(X_W_child);
  const Vec3 r_C = at - X_W_child.p, r_P = at - X_W_parent.p;
  const Vec3 m = lambda.head<3>(), f = lambda.tail<3>();
  w.on_child << m + r_C.cross(f), f;
  w.on_parent << -(m + r_P.cross(f)), -f;
  w.child_by_lambda.setIdentity();
  w.child_by_lambda.topRightCorner<3, 3>() = hat(r_C);
  w.parent_by_lambda = -Mat6::Identity();
  w.parent_by_lambda.topRightCorner<3, 3>() = -hat(r_P);
  // d r_C = phi_C × r_C,  d r_P = dp_C + phi_C × r_C - dp_P
  w.child_by_child.setZero();
  w.child_by_child.topLeftCorner<3, 3>() = hat(f) * hat(r_C);
  w.parent_by_child.setZero();
  w.parent_by_child.topLeftCorner<3, 3>() = -hat(f) * hat(r_C);
  w.parent_by_child.topRightCorner<3, 3>() = hat(f);
  w.parent_by_parent.setZero();
  w.parent_by_parent.topRightCorner<3, 3>() = -hat(f);
  return w;
}

Joint::Observed Joint::observe(const Pose& X_W_parent, const Pose& X_W_child) const {
  Observed o;
  if (is_ball()) {
    const Mat3 Q = relative_attitude(X_W_parent, X_W_child);
    o.position = log_so3(Q);
    o.velocity = Q * Vec3(spin.v);
    o.effort = (X_W_parent.R * X_PJ_.R).transpose() * lambda.head<3>();
    return o;
  }
  const Mat63 A = twists(X_W_parent);
  for (std::size_t k = 0; k < freedoms.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    o.position[i] = q[i];
    o.velocity[i] = track.v[i];
    o.effort[i] = A.col(i).dot(lambda);
    o.stop[i] = freedoms[k].law.stop(*freedoms[k].spec, q[i], track.v[i]).value;
  }
  return o;
}

double Joint::stored_energy() const {
  double energy = 0;
  for (std::size_t k = 0; k < freedoms.size(); ++k)
    energy += freedoms[k].law.stored(*freedoms[k].spec, q[static_cast<Eigen::Index>(k)]);
  if (is_ball()) energy += 0.5 * spec->spring_stiffness * ball_position_.squaredNorm();
  return energy;
}

double Joint::friction_energy() const {
  double energy = 0;
  for (std::size_t k = 0; k < freedoms.size(); ++k)
    energy +=
        freedoms[k].law.stored_in_friction(*freedoms[k].spec, q[static_cast<Eigen::Index>(k)]);
  return energy;
}

double Joint::loss() const {
  double power = is_ball() ? spec->damping * spin.v.squaredNorm() : 0;
  for (std::size_t k = 0; k < freedoms.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    power += freedoms[k].law.loss(*freedoms[k].spec, q[i], track.v[i]);
  }
  return power;
}

Vec3 Joint::friction_effort() const {
  Vec3 effort = Vec3::Zero();
  for (std::size_t k = 0; k < freedoms.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    effort[i] = freedoms[k].law.friction(*freedoms[k].spec, q[i], track.v[i]).value;
  }
  return effort;
}

void Joint::start_tracks(const Pose& X_W_parent, const Pose& X_W_child, const Vec6& twist) {
  const auto n = static_cast<Eigen::Index>(freedoms.size());
  // q_t from A q_t = twist, in the least-squares sense
  const Mat63 A = twists(X_W_parent);
  Mat3 N = A.transpose() * A;
  for (Eigen::Index i = n; i < 3; ++i)
    N(i, i) = 1;
  const Vec3 q_t = N.inverse() * (A.transpose() * twist);
  track.set_start(q.head(n), q_t.head(n));
  accepted_q_ = q;
  if (!is_ball()) return;
  Q_start_ = relative_attitude(X_W_parent, X_W_child);
  ball_position_ = log_so3(Q_start_);
  const Mat3 R_JC = X_W_child.R * X_CJ_.R;
  spin.set_start(Vec3::Zero(), R_JC.transpose() * twist.head<3>());
}

void Joint::engage_friction() {
  for (std::size_t k = 0; k < freedoms.size(); ++k)
    freedoms[k].law.engage_friction(q[static_cast<Eigen::Index>(k)]);
}

void Joint::fill_tracks(const Pose& X_W_parent, const Pose& X_W_child, const StageRates& rates) {
  track.x = q.head(track.x.size());
  if (!is_ball()) return;
  const Mat3 Q = relative_attitude(X_W_parent, X_W_child);
  const Vec3 theta = log_so3(Q_start_.transpose() * Q), theta_t = rates.c_v * theta + spin.x_h;
  spin.x = theta;
  spin.v = rates.body_rates ? Vec3(right_jacobian(theta) * theta_t) : theta_t;
  ball_position_ = log_so3(Q);
}

void Joint::accept(const Pose& X_W_parent, const Pose& X_W_child) {
  accepted_q_ = q;
  for (std::size_t k = 0; k < freedoms.size(); ++k)
    freedoms[k].law.accept(*freedoms[k].spec, q[static_cast<Eigen::Index>(k)]);
  if (is_ball()) Q_start_ = relative_attitude(X_W_parent, X_W_child);
}

void Joint::visit(Archive& archive) {
  archive(q);
  archive(lambda);
  archive(accepted_q_);
  archive(Q_start_);
  archive(ball_position_);
  for (Freedom& freedom : freedoms) {
    archive(freedom.effort);
    freedom.law.visit(archive);
  }
  track.visit(archive);
  spin.visit(archive);
}

}  // namespace cprsim
