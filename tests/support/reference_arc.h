// SPDX-License-Identifier: BSD-3-Clause
// Reference solution of the static Cosserat rod from base to tip, without a line of the engine:
//   (1) p' = R v,  h' = ½ h ⊗ (0, u),  n' = -f,  m' = -p' × n - l
//   (2) u = u_ref + C_bt Rᵀ m,  v = (0, 0, 1) + C_se Rᵀ n
// with R = R(h / |h|), h a quaternion, integrated by SUNDIALS CVODE (Adams, variable order and
// step).
#pragma once

#include <functional>

#include "engine/math/types.h"

namespace cprsim {

/// Compliances may be zero (rigid in that mode); loads per metre of s, world axes.
struct ReferenceRod {
  double length = 1;
  Mat3 C_bt = Mat3::Identity();  ///< inverse of K_bt, section axes
  Mat3 C_se = Mat3::Zero();      ///< inverse of K_se
  Vec3 u_ref = Vec3::Zero();
  Vec3 f = Vec3::Zero();  ///< force
  Vec3 l = Vec3::Zero();  ///< moment
  /// Changes `here` to what holds at s with the section turned by R.
  std::function<void(double s, const Mat3& R, ReferenceRod& here)> vary;
  /// Likewise, to what holds where the section is.
  std::function<void(const Pose& X_WS, ReferenceRod& here)> vary_at;
};

/// A section: pose, and the wrench that the part beyond it exerts on the part before it, world
/// axes.
struct ReferenceSection {
  Pose X_WS;
  Vec3 n = Vec3::Zero(), m = Vec3::Zero();
};

/// The section at s = fraction · length, given that at s = 0.
/// @param tolerance relative, of each step; at 1e-15 the error at the tip is about 1e-14.
/// @throws std::runtime_error if CVODE gives up.
ReferenceSection integrate_reference_arc(const ReferenceRod& rod, const ReferenceSection& base,
                                         double fraction = 1, double tolerance = 1e-15);

}  // namespace cprsim
