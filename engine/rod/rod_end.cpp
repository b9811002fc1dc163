// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/rod_end.h"

#include "engine/math/so3.h"

namespace cprsim {
namespace {

Vec3 perpendicular(const Vec3& a) {
  int smallest = 0;
  a.cwiseAbs().minCoeff(&smallest);
  return a.cross(Vec3::Unit(smallest)).normalized();
}

}  // namespace

Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation_of(const NodeState& node) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(node.R);
}

Eigen::Map<const Vec3> position_of(const NodeState& node) {
  return Eigen::Map<const Vec3>(node.p);
}

Eigen::Map<const Vec3> force_of(const NodeState& node) {
  return Eigen::Map<const Vec3>(node.n);
}

Eigen::Map<const Vec3> moment_of(const NodeState& node) {
  return Eigen::Map<const Vec3>(node.m);
}

RodEnd::RodEnd(const RodEndSpec& spec) {
  a_ = spec.axis.normalized();
  switch (spec.joint) {
    case EndJoint::kFree:
      kind_ = Kind::kFree;
      break;
    case EndJoint::kFixed:
      kind_ = spec.spin_free ? Kind::kRevolute : Kind::kFixed;
      if (spec.spin_free) a_ = Vec3::UnitZ();
      break;
    case EndJoint::kRevolute:
      // an axis along the tangent frees nothing more by spin
      kind_ = spec.spin_free && a_.cross(Vec3::UnitZ()).norm() > 1e-9 ? Kind::kUniversal
                                                                      : Kind::kRevolute;
      b_ = Vec3::UnitZ();
      break;
    case EndJoint::kUniversal:
      kind_ = spec.spin_free ? Kind::kBall : Kind::kUniversal;
      b_ = Vec3::UnitZ().cross(a_).norm() > 1e-9 ? Vec3(Vec3::UnitZ().cross(a_).normalized())
                                                 : perpendicular(a_);
      break;
    case EndJoint::kBall:
      kind_ = Kind::kBall;
      break;
  }
  e1_ = perpendicular(a_);
  e2_ = a_.cross(e1_);
}

Vec6 RodEnd::value(const NodeState& end, const Port& port, const RodScale& scale) const {
  const Mat3 R = rotation_of(end);
  const Vec3 n = force_of(end), m = moment_of(end) / scale.moment;
  Vec6 r;
  if (kind_ == Kind::kFree) {
    r << n / scale.force, m;
    return r;
  }
  r.head<3>() = port.R.transpose() * (position_of(end) - port.p) / scale.length;
  const Mat3 Q = port.R.transpose() * R;
  switch (kind_) {
    case Kind::kFixed:
      r.tail<3>() = log_so3(Q);
      break;
    case Kind::kRevolute:
      // about the axis that the rod carries: a rod that spins freely at both ends then says 0 = 0
      // on the way to its shape as well, not only there
      r.tail<3>() << e1_.dot(Q * a_), e2_.dot(Q * a_), m.dot(R * a_);
      break;
    case Kind::kUniversal:
      r.tail<3>() << a_.dot(Q * b_), m.dot(port.R * a_), m.dot(R * b_);
      break;
    default:
      r.tail<3>() = m;
      break;
  }
  return r;
}

EndRows RodEnd::rows(const NodeState& end, const Port& port, const RodScale& scale) const {
  EndRows rows;
  rows.value = value(end, port, scale);
  rows.by_state.setZero();
  rows.by_body.setZero();
  const Mat3 R = rotation_of(end), Jt = port.R.transpose();
  const Vec3 m = moment_of(end) / scale.moment;
  if (kind_ == Kind::kFree) {
    rows.by_state.block<3, 3>(0, 6) = Mat3::Identity() / scale.force;
    rows.by_state.block<3, 3>(3, 9) = Mat3::Identity() / scale.moment;
    return rows;
  }
  // d(R_J^T (p - p_J)) = R_J^T (dp - dp_J + (p - p_J) × phi_J),  dp_J = dp_B + phi_J × arm
  const Vec3 gap = position_of(end) - port.p;
  rows.by_state.block<3, 3>(0, 3) = Jt / scale.length;
  rows.by_body.block<3, 3>(0, 0) = Jt * (hat(gap) + hat(port.arm)) / scale.length;
  rows.by_body.block<3, 3>(0, 3) = -Jt / scale.length;
  // psi = R_J^T (phi - phi_J) is the increment of Q
  auto angle_row = [&](int i, const Eigen::RowVector3d& by_psi) {
    rows.by_state.block<1, 3>(i, 0) = by_psi * Jt;
    rows.by_body.block<1, 3>(i, 0) = -by_psi * Jt;
  };
  const Mat3 Q = Jt * R;
  const Vec3 a_W = port.R * a_, b_W = R * b_;
  switch (kind_) {
    case Kind::kFixed: {
      const Mat3 by_psi = right_jacobian_inverse(-log_so3(Q));
      for (int i = 0; i < 3; ++i)
        angle_row(3 + i, by_psi.row(i));
      break;
    }
    case Kind::kRevolute: {
      const Vec3 Qa = Q * a_;
      angle_row(3, Qa.cross(e1_).transpose());
      angle_row(4, Qa.cross(e2_).transpose());
      const Vec3 carried = R * a_;
      rows.by_state.block<1, 3>(5, 9) = carried.transpose() / scale.moment;
      rows.by_state.block<1, 3>(5, 0) = carried.cross(m).transpose();
      break;
    }
    case Kind::kUniversal:
      angle_row(3, (Q * b_).cross(a_).transpose());
      rows.by_state.block<1, 3>(4, 9) = a_W.transpose() / scale.moment;
      rows.by_body.block<1, 3>(4, 0) = a_W.cross(m).transpose();
      rows.by_state.block<1, 3>(5, 9) = b_W.transpose() / scale.moment;
      rows.by_state.block<1, 3>(5, 0) = b_W.cross(m).transpose();
      break;
    default:
      rows.by_state.block<3, 3>(3, 9) = Mat3::Identity() / scale.moment;
      break;
  }
  return rows;
}

bool RodEnd::turns_about(const NodeState& end, const Port& port, Vec3& a, Vec3& b) const {
  if (kind_ != Kind::kUniversal) return false;
  a = port.R * a_;
  b = rotation_of(end) * b_;
  return true;
}

const char* RodEnd::row_name(int i) const {
  static const char* const kPosition[] = {"position x", "position y", "position z"};
  static const char* const kFree[] = {"force x",  "force y",  "force z",
                                      "moment x", "moment y", "moment z"};
  static const char* const kFixed[] = {"rotation x", "rotation y", "rotation z"};
  static const char* const kRevolute[] = {"alignment 1", "alignment 2", "moment about the axis"};
  static const char* const kUniversal[] = {"axes perpendicular", "moment about axis 1",
                                           "moment about axis 2"};
  if (kind_ == Kind::kFree) return kFree[i];
  if (i < 3) return kPosition[i];
  switch (kind_) {
    case Kind::kFixed:
      return kFixed[i - 3];
    case Kind::kRevolute:
      return kRevolute[i - 3];
    case Kind::kUniversal:
      return kUniversal[i - 3];
    default:
      return kFree[i];
  }
}

}  // namespace cprsim
