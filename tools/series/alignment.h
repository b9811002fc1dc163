// SPDX-License-Identifier: BSD-3-Clause
// Frames of measurements: a known transform, or the one that fits best.
//   sum over k of |x_k - (R r_k + p)|²  least over the freedoms of the alignment            (1)
// Source: Horn, "Closed-form solution of absolute orientation using unit quaternions", J. Opt. Soc.
// Am. A 4 (1987), section 4: R belongs to the largest eigenvalue of a symmetric 4 x 4 matrix.
#pragma once

#include <vector>

#include "tools/series/series.h"

namespace cprsim {

enum class Alignment {
  kNone,
  kTranslation,
  kYaw,  ///< translation and a turn about z
  kFull  ///< translation and any turn
};

/// (1). @param x, r 3×N positions, column k at instant k
Pose fit_frame(Alignment alignment, const MatX& x, const MatX& r);

/// The reference seen from a frame in which its own world frame has pose X: positions are turned
/// and moved, other vectors in world axes turned, attitudes turned.
void change_frame(Series& reference, const Pose& X);

/// Attitudes whose x axis is a rod's tangent become ones whose z axis is: new x, y, z = old y, z,
/// x.
void put_tangent_on_z(Series& reference);

}  // namespace cprsim
