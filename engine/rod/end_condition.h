// SPDX-License-Identifier: BSD-3-Clause
// A rod's end as its equations see it, in space (engine/rod/rod_end.h) or in a plane: d = 6 or 3
// dimensionless rows on pose and wrench of the end. In a plane a state has 6 coordinates (turn,
// two translations, two forces, moment), a body's motion and a wrench 3, about the normal first.
#pragma once

#include <optional>

#include "engine/model/planar.h"
#include "engine/rod/rod_end.h"

namespace cprsim {

/// What of space a rod moves in. Orthonormal columns, world axes.
struct MotionSpace {
  MatX state;   ///< 12 × 2d: of (phi, dp, dn, dm)
  MatX motion;  ///< 6 × d: of (phi, dp), and of wrenches (moment, force)

  Eigen::Index freedoms() const { return motion.cols(); }

  static MotionSpace all();
  /// @param plane e1, e2 and the normal as columns, world.
  static MotionSpace in_plane(const Mat3& plane);
};

/// d rows: value + by_state (phi, dp, dn, dm) + by_body (phi, dp of the body's reference point).
struct ConditionRows {
  VecX value;
  MatX by_state;  ///< d × 12
  MatX by_body;   ///< d × 6
};

class EndCondition {
 public:
  explicit EndCondition(const RodEndSpec& spec) : end_(spec) {}

  /// @param plane e1, e2 and the normal as columns, world.
  EndCondition(PlanarHold hold, const Mat3& plane);

  bool held() const { return end_.held(); }

  bool fixed() const { return end_.fixed(); }

  VecX value(const NodeState& end, const Port& port, const RodScale& scale) const;
  ConditionRows rows(const NodeState& end, const Port& port, const RodScale& scale) const;

  const char* row_name(int i) const;

 private:
  RodEnd end_;
  std::optional<Mat3> plane_;
};

}  // namespace cprsim
