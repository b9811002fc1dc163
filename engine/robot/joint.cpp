// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/joint.h"

#include "engine/math/so3.h"

namespace cprsim {

Joint::Joint(const JointSpec& joint, int parent_body, int child_body, const Pose& X_parent_J,
             const Pose& X_child_J)
    : spec(&joint),
      parent(parent_body),
      child(child_body),
      X_PJ_(X_parent_J),
      X_CJ_(X_child_J),
      axis_(joint.axis) {
  switch (joint.kind) {
    case JointKind::kRevolute:
    case JointKind::kContinuous:
      freedom = Freedom::kRevolute;
      break;
    case JointKind::kPrismatic:
      freedom = Freedom::kPrismatic;
      break;
    default:
      freedom = Freedom::kNone;
      break;
  }
  track.resize(1);
}

Pose Joint::parent_frame(const Pose& X_W_parent) const {
  Pose J = X_W_parent * X_PJ_;
  if (freedom == Freedom::kRevolute) J.R = J.R * exp_so3(axis_ * q);
  if (freedom == Freedom::kPrismatic) J.p += J.R * axis_ * q;
  return J;
}

Pose Joint::displacement(const Pose& X_W_parent) const {
  return parent_frame(X_W_parent) * (X_W_parent * X_PJ_).inverse();
}

double Joint::axial_effort(const Pose& X_W_parent) const {
  const Vec3 a = parent_frame(X_W_parent).R * axis_;
  return freedom == Freedom::kPrismatic ? a.dot(lambda.tail<3>()) : a.dot(lambda.head<3>());
}

Joint::Rows Joint::rows(const Pose& X_W_parent, const Pose& X_W_child, const StageRates& rates,
                        double length, double moment, double force) const {
  Rows rows;
  const Pose J_P = parent_frame(X_W_parent), J_C = X_W_child * X_CJ_;
  const Mat3 Jt = J_P.R.transpose();
  const Vec3 e = log_so3(Jt * J_C.R), d = J_C.p - J_P.p, a = J_P.R * axis_;
  rows.closure << e, Jt * d / length;
  rows.axes = J_P.R;
  // d log Q = J_l^-1(e) R_JP^T (phi_C - phi_JP)
  const Mat3 by_turn = right_jacobian_inverse(-e) * Jt;
  const Vec3 arm_P = J_P.p - X_W_parent.p, arm_C = J_C.p - X_W_child.p;
  rows.by_parent.setZero();
  rows.by_child.setZero();
  rows.by_q.setZero();
  rows.by_child.topLeftCorner<3, 3>() = by_turn;
  rows.by_parent.topLeftCorner<3, 3>() = -by_turn;
  rows.by_child.bottomLeftCorner<3, 3>() = -Jt * hat(arm_C) / length;
  rows.by_child.bottomRightCorner<3, 3>() = Jt / length;
  rows.by_parent.bottomLeftCorner<3, 3>() = Jt * (hat(d) + hat(arm_P)) / length;
  rows.by_parent.bottomRightCorner<3, 3>() = -Jt / length;
  if (freedom == Freedom::kRevolute) rows.by_q << -by_turn * a, Jt * d.cross(a) / length;
  if (freedom == Freedom::kPrismatic) rows.by_q.tail<3>() = -axis_ / length;

  // (2)
  rows.effort_by_lambda.setZero();
  rows.effort_by_parent.setZero();
  if (freedom == Freedom::kNone) return rows;
  const bool slides = freedom == Freedom::kPrismatic;
  const double unit = slides ? force : moment;
  const Vec3 part = slides ? lambda.tail<3>() : lambda.head<3>();
  double tau = effort - spec->spring_stiffness * (q - spec->spring_reference);
  double tau_by_q = -spec->spring_stiffness;
  if (rates.dynamic()) {
    tau -= spec->damping * (rates.c_v * q + track.x_h[0]);
    tau_by_q -= spec->damping * rates.c_v;
  }
  rows.effort = (a.dot(part) - tau) / unit;
  rows.effort_by_lambda.segment<3>(slides ? 3 : 0) = a.transpose() / unit;
  rows.effort_by_parent.head<3>() = a.cross(part).transpose() / unit;
  rows.effort_by_q = -tau_by_q / unit;
  return rows;
}

Joint::Wrenches Joint::wrenches(const Pose& X_W_parent, const Pose& X_W_child) const {
  Wrenches w;
  const Vec3 at = (X_W_child * X_CJ_).p;
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

}  // namespace cprsim
