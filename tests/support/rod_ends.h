// SPDX-License-Identifier: BSD-3-Clause
// The two ends of a rod as its bodies hold them, for tests that move them.
#pragma once

#include "engine/math/so3.h"
#include "engine/math/types.h"
#include "engine/rod/rod_end.h"

namespace cprsim {

struct RodEnds {
  Port base, tip;
};

/// The bodies moved: rotation and reference point, world axes.
/// @param zeta (phi, dp) of the base's body, then of the tip's
inline RodEnds moved(RodEnds ends, const VecX& zeta) {
  const auto move = [](Port& port, const Vec3& phi, const Vec3& dp) {
    const Vec3 reference = port.p - port.arm;
    port.R = exp_so3(phi) * port.R;
    port.arm = exp_so3(phi) * port.arm;
    port.p = reference + dp + port.arm;
  };
  move(ends.base, zeta.segment<3>(0), zeta.segment<3>(3));
  move(ends.tip, zeta.segment<3>(6), zeta.segment<3>(9));
  return ends;
}

}  // namespace cprsim
