// SPDX-License-Identifier: BSD-3-Clause
// An elastic foundation: springs of the stiffness k per length from every section to the plane
// through o with the normal n, which slide along it (Winkler 1867):
//   f = -k n (n·(p - o)),    df = -k n n^T dp                                                (1)
#pragma once

#include "engine/section/place_force.h"

namespace {  // NOLINT: as small_vector.h

/// @param x k, o, n
inline PlaceForce foundation(const double* x, V3 p) {
  const V3 n = load(x + 4);
  return {(-x[0] * dot(n, p - load(x + 1))) * n, (-x[0]) * outer(n, n)};
}

}  // namespace
