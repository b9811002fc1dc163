// SPDX-License-Identifier: BSD-3-Clause
// What a joint asks of a rod's end: six rows, as many on the pose as the joint holds and on the
// wrench as it frees. With joint frame J (on the body) and end frame E (on the rod), Q = R_J^T R_E:
//   position held always       R_J^T (p_E - p_J) = 0
//   fixed                      log Q = 0
//   revolute about a           Q a = a (two rows),                m · R_E a = 0
//   universal about a, then b  a · Q b = 0,     m · R_J a = 0,    m · R_E b = 0
//   ball                       m = 0
//   free                       n = 0, m = 0
// spin="free" frees the rod's tangent besides: fixed becomes revolute about z, revolute about a
// universal (a, z).
#pragma once

#include "engine/math/types.h"
#include "engine/model/rod_spec.h"
#include "engine/rod/cell.h"

namespace cprsim {

/// A body's joint frame as a rod sees it. The body's motion is a world-axes increment (phi, dp) of
/// its reference point.
struct Port {
  Mat3 R = Mat3::Identity();
  Vec3 p = Vec3::Zero();
  Vec3 arm = Vec3::Zero();  ///< p minus the body's reference point
  bool moves = false;       ///< the body's motion is unknown
};

using Mat6x12 = Eigen::Matrix<double, 6, 12>;

/// Six dimensionless rows, linearised: value + by_state (phi, dp, dn, dm) + by_body (phi, dp of the
/// reference point).
struct EndRows {
  Vec6 value;
  Mat6x12 by_state;
  Mat6 by_body;
};

/// Units that make rows dimensionless.
struct RodScale {
  double length = 1, force = 1, moment = 1;
};

class RodEnd {
 public:
  explicit RodEnd(const RodEndSpec& spec);

  bool held() const { return kind_ != Kind::kFree; }

  bool fixed() const { return kind_ == Kind::kFixed; }

  Vec6 value(const NodeState& end, const Port& port, const RodScale& scale) const;
  EndRows rows(const NodeState& end, const Port& port, const RodScale& scale) const;

  /// For a universal joint: the axis on the body and that on the rod, world axes, about which it
  /// turns in this order. @return false for other joints.
  bool turns_about(const NodeState& end, const Port& port, Vec3& a, Vec3& b) const;

  /// e.g. "moment about z": what row i (0..5) says.
  const char* row_name(int i) const;

 private:
  enum class Kind { kFree, kFixed, kRevolute, kUniversal, kBall };
  Kind kind_ = Kind::kFree;
  Vec3 a_ = Vec3::UnitX();                      ///< axis on the body
  Vec3 b_ = Vec3::UnitZ();                      ///< axis on the rod
  Vec3 e1_ = Vec3::Zero(), e2_ = Vec3::Zero();  ///< complete a to a basis
};

Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation_of(const NodeState& node);
Eigen::Map<const Vec3> position_of(const NodeState& node);
Eigen::Map<const Vec3> force_of(const NodeState& node);
Eigen::Map<const Vec3> moment_of(const NodeState& node);

}  // namespace cprsim
