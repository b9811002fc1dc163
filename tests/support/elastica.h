// SPDX-License-Identifier: BSD-3-Clause
// The cantilever under a dead transverse tip force, without extension, shear or weight, in closed
// form. Clamped at the origin along z, force P along x, θ measured from z towards x, α² = P / EI:
//   (1) θ'' = -α² cos θ,  θ(0) = 0,  θ'(L) = 0
//   (2) k² = (1 + sin θ_L)/2,  sin φ_0 = 1/(k √2),  α L = K(k) - F(φ_0, k)
//   (3) x_L = L - (2/α) (E(k) - E(φ_0, k)),   z_L = √(2 sin θ_L) / α
// Bisshopp and Drucker, Large deflection of cantilever beams, Q. Appl. Math. 3 (1945) 272-275.
// Differences of complete and incomplete integrals come from the addition theorem, uncancelled:
//   (4) tan ψ = cot φ_0 / k':  K - F(φ_0) = F(ψ),  E - E(φ_0) = E(ψ) - k² sin φ_0 sin ψ
#pragma once

namespace cprsim {

/// Tip of the cantilever for L = 1, and the moment at the clamp over EI (= α² z_L, with L = 1).
struct Elastica {
  double x = 0, z = 0;      ///< tip position / L
  double angle = 0;         ///< θ_L
  double clamp_moment = 0;  ///< EI θ'(0), times L / EI; about +y
};

/// @param load P L² / EI > 0. Absolute errors below 1e-14 for 1e-6 <= load <= 1e3.
Elastica solve_elastica(double load);

/// Incomplete integrals from s = sin ψ, c = cos ψ and the complementary modulus kc² = 1 - k², by
/// Carlson's R_F and R_D; 0 <= ψ <= π/2.
double elliptic_F(double s, double c, double kc2);
double elliptic_E(double s, double c, double kc2);

}  // namespace cprsim
