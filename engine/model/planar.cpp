// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/planar.h"

#include <cmath>

namespace cprsim {
namespace {

/// 1 along the normal, 0 in the plane, nothing in between.
std::optional<bool> along(const Vec3& axis, const Vec3& normal) {
  if (axis.cross(normal).norm() < kPlanarAngle) return true;
  if (std::abs(axis.dot(normal)) < kPlanarAngle) return false;
  return std::nullopt;
}

}  // namespace

Mat3 plane_axes(const Vec3& normal) {
  const Vec3 n = normal.normalized();
  // x, y for normal z and their cyclic permutations
  int largest = 0;
  n.cwiseAbs().maxCoeff(&largest);
  const Vec3 start = Vec3::Unit((largest + 1) % 3);
  Mat3 axes;
  axes.col(0) = (start - n * n.dot(start)).normalized();
  axes.col(1) = n.cross(axes.col(0));
  axes.col(2) = n;
  return axes;
}

// A universal joint of a rod turns about x, then y of its frame (engine/rod/rod_end.h), and one
// with free spin is a ball.
std::optional<PlanarHold> planar_hold(const RodEndSpec& end, const Vec3& normal) {
  switch (end.joint) {
    case EndJoint::kFree:
      return PlanarHold::kFree;
    case EndJoint::kFixed:
      return PlanarHold::kFixed;
    case EndJoint::kBall:
      return PlanarHold::kPinned;
    case EndJoint::kRevolute: {
      const std::optional<bool> turns = along(end.axis.normalized(), normal);
      if (!turns) return std::nullopt;
      return *turns ? PlanarHold::kPinned : PlanarHold::kFixed;
    }
    case EndJoint::kUniversal:
      break;
  }
  if (end.spin_free) return PlanarHold::kPinned;
  const std::optional<bool> x = along(Vec3::UnitX(), normal), y = along(Vec3::UnitY(), normal);
  if (!x || !y || *x == *y) return std::nullopt;
  return PlanarHold::kPinned;
}

bool holds_spin(const RodEndSpec& end) {
  switch (end.joint) {
    case EndJoint::kFixed:
    case EndJoint::kUniversal:
      return !end.spin_free;
    case EndJoint::kRevolute:
      return !end.spin_free && end.axis.normalized().cross(Vec3::UnitZ()).norm() > kPlanarAngle;
    default:
      return false;
  }
}

}  // namespace cprsim
