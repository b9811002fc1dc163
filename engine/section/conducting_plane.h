// SPDX-License-Identifier: BSD-3-Clause
// A charged rod and a grounded conducting plane through o with the normal n. The charge q per
// length and its image at the same distance h behind the plane attract each other like two long
// parallel lines, 2 h apart:
//   f = -q² / (4 pi epsilon_0 h) n,    h = n·(p - o),    df = q² / (4 pi epsilon_0 h²) n n^T dp (1)
// Source: the method of images, Jackson, Classical Electrodynamics, ch. 2. Deviation: each section
// sees the image of a straight rod that is parallel to the plane; what others add because the rod
// is tilted, bent or ends is left out, which is right for h far below the length and the radius of
// curvature, and far above the rod's own radius. Without bound towards the plane.
#pragma once

#include <numbers>

#include "engine/section/place_force.h"

namespace {  // NOLINT: as small_vector.h

constexpr double kEpsilon0 = 8.8541878128e-12;  // F/m (CODATA 2018)

/// @param x q, o, n
inline PlaceForce conducting_plane(const double* x, V3 p) {
  const V3 n = load(x + 4);
  const double h = dot(n, p - load(x + 1)),
               pull = x[0] * x[0] / (4 * std::numbers::pi * kEpsilon0 * h);
  return {(-pull) * n, (pull / h) * outer(n, n)};
}

}  // namespace
