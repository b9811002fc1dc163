// SPDX-License-Identifier: BSD-3-Clause
// Motion in a plane: its axes, and what a rod's end joint is within it.
#pragma once

#include <optional>

#include "engine/math/types.h"
#include "engine/model/rod_spec.h"

namespace cprsim {

/// Columns e1, e2 and the normal e3 = e1 × e2; where the normal is a coordinate axis so are e1, e2.
Mat3 plane_axes(const Vec3& normal);

enum class PlanarHold {
  kFree,    ///< n = 0, m = 0
  kPinned,  ///< position held, m = 0 about the normal
  kFixed    ///< position and angle held
};

/// Directions count as along the normal or in the plane up to this angle (rad): above the digits
/// people write, and what it turns a result by is below 1e-9 (its square).
constexpr double kPlanarAngle = 1e-5;

/// What `end` holds if its motion stays in the plane, nothing if its axes lie askew to it.
/// @param normal unit, in the end's frame.
std::optional<PlanarHold> planar_hold(const RodEndSpec& end, const Vec3& normal);

/// Whether the end keeps the rod from turning about its tangent.
bool holds_spin(const RodEndSpec& end);

}  // namespace cprsim
