// SPDX-License-Identifier: BSD-3-Clause
// Normalised Legendre polynomials on [0, 1] and the quadrature on their roots:
//   phi_k(x) = sqrt(2k + 1) P_k(2x - 1),     ∫ phi_k phi_l dx = delta_kl (1)
//   ∫_0^x phi_k = sqrt(2k + 1) (P_k+1 - P_k-1)(2x - 1) / (2 (2k + 1)),   k > 0 (2)
// A function known at the n roots of P_n is the polynomial sum_k phi_k(x) sum_j b_j phi_k(c_j) f_j,
// k < n, because the rule integrates (1) exactly. (3)
#pragma once

#include "engine/math/types.h"

namespace cprsim {

/// phi_0 .. phi_degree at x.
VecX legendre(double x, int degree);

/// Their integrals from 0 to x.
VecX legendre_integrals(double x, int degree);

/// Gauss's rule on [0, 1], exact for polynomials of degree 2n - 1.
struct GaussRule {
  VecX points, weights;
};

GaussRule gauss_rule(int n);

/// a_ij: integral from 0 to point i of the polynomial that is 1 at point j, 0 at the others.
MatX integration_matrix(const GaussRule& rule);

/// Weights with which values at the points give the value of (3) at x.
VecX interpolation_weights(const GaussRule& rule, double x);

}  // namespace cprsim
