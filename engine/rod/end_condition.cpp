// SPDX-License-Identifier: BSD-3-Clause
// In a plane with axes e1, e2 and normal N, at a joint frame J, with z the tangent:
//   free     n · e1 = n · e2 = 0,                 m · N = 0
//   pinned   (p - p_J) · e1 = (p - p_J) · e2 = 0, m · N = 0
//   fixed    the same positions,                  angle from z_J to z about N = 0
#include "engine/rod/end_condition.h"

#include <cmath>

#include "engine/math/so3.h"

namespace cprsim {
namespace {

RodEndSpec spec_of(PlanarHold hold) {
  RodEndSpec spec;
  if (hold == PlanarHold::kFixed) spec.joint = EndJoint::kFixed;
  if (hold == PlanarHold::kPinned) spec.joint = EndJoint::kBall;
  return spec;
}

}  // namespace

MotionSpace MotionSpace::all() {
  return {MatX::Identity(12, 12), MatX::Identity(6, 6)};
}

MotionSpace MotionSpace::in_plane(const Mat3& plane) {
  MotionSpace space{MatX::Zero(12, 6), MatX::Zero(6, 3)};
  space.state.block<3, 1>(0, 0) = plane.col(2);
  space.state.block<3, 2>(3, 1) = plane.leftCols<2>();
  space.state.block<3, 2>(6, 3) = plane.leftCols<2>();
  space.state.block<3, 1>(9, 5) = plane.col(2);
  space.motion.block<3, 1>(0, 0) = plane.col(2);
  space.motion.block<3, 2>(3, 1) = plane.leftCols<2>();
  return space;
}

EndCondition::EndCondition(PlanarHold hold, const Mat3& plane)
    : end_(spec_of(hold)), plane_(plane) {}

VecX EndCondition::value(const NodeState& end, const Port& port, const RodScale& scale) const {
  if (!plane_) return end_.value(end, port, scale);
  const auto across = plane_->leftCols<2>();
  const Vec3 normal = plane_->col(2);
  Vec3 value;
  if (!held())
    value.head<2>() = across.transpose() * force_of(end) / scale.force;
  else
    value.head<2>() = across.transpose() * (position_of(end) - port.p) / scale.length;
  if (fixed()) {
    const Vec3 z_J = port.R.col(2), z = Mat3(rotation_of(end)).col(2);
    value[2] = std::atan2(normal.dot(z_J.cross(z)), z_J.dot(z));
  } else {
    value[2] = normal.dot(moment_of(end)) / scale.moment;
  }
  return value;
}

ConditionRows EndCondition::rows(const NodeState& end, const Port& port,
                                 const RodScale& scale) const {
  if (!plane_) {
    const EndRows rows = end_.rows(end, port, scale);
    return {rows.value, rows.by_state, rows.by_body};
  }
  const auto across = plane_->leftCols<2>();
  const Vec3 normal = plane_->col(2);
  ConditionRows rows{value(end, port, scale), MatX::Zero(3, 12), MatX::Zero(3, 6)};
  if (!held()) {
    rows.by_state.block<2, 3>(0, 6) = across.transpose() / scale.force;
  } else {
    // dp_J = dp + phi × arm
    rows.by_state.block<2, 3>(0, 3) = across.transpose() / scale.length;
    rows.by_body.block<2, 3>(0, 0) = across.transpose() * hat(port.arm) / scale.length;
    rows.by_body.block<2, 3>(0, 3) = -across.transpose() / scale.length;
  }
  if (fixed()) {
    rows.by_state.block<1, 3>(2, 0) = normal.transpose();
    rows.by_body.block<1, 3>(2, 0) = -normal.transpose();
  } else {
    rows.by_state.block<1, 3>(2, 9) = normal.transpose() / scale.moment;
  }
  return rows;
}

const char* EndCondition::row_name(int i) const {
  if (!plane_) return end_.row_name(i);
  if (i < 2)
    return held() ? (i == 0 ? "position 1" : "position 2") : (i == 0 ? "force 1" : "force 2");
  return fixed() ? "angle" : "moment about the normal";
}

}  // namespace cprsim
