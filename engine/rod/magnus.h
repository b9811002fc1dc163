// SPDX-License-Identifier: BSD-3-Clause
// Sections turned along a piece of a rod whose curvature u(s) is known: R_s = R u^ has the solution
// R_end = R_start exp(Omega^), and Omega follows to sixth order from u at the piece's three Gauss
// points (Blanes, Casas, Oteo, Ros, Phys. Rep. 470, 2009, eqs. 253-256; [a, b] = b × a here,
// because u^ stands on the right):
//   a1 = h u2,  a2 = sqrt(15)/3 h (u3 - u1),  a3 = 10/3 h (u3 - 2 u2 + u1)
//   C1 = [a1, a2],  C2 = -[a1, 2 a3 + C1] / 60
//   Omega = a1 + a3/12 + [-20 a1 - a3 + C1, a2 + C2] / 240 (1)
#pragma once

#include "engine/math/types.h"

namespace cprsim {

/// (1). @param u 3 × 3, one Gauss point a column.
Vec3 magnus_step(double h, const Mat3& u);

/// Derivatives of (1) by u at each of the three points, side by side.
Eigen::Matrix<double, 3, 9> magnus_tangent(double h, const Mat3& u);

}  // namespace cprsim
