// SPDX-License-Identifier: BSD-3-Clause
// Second variation of a rod's energy about an equilibrium, and its kinetic energy, as quadratic
// forms.
//
// With R -> exp(phi^) R and r -> r + d, phi' = psi and d' = phi × tau + R e (e: change of shear and
// stretch), the strains change by
//   u: R^T psi - R^T (phi × psi)/2,     v: e + R^T (phi × (phi × tau) - 2 phi × d')/2      (to 2nd
//   order)
// and twice the second-order part of energy (with the internal force as multiplier of a rigid v) is
//   ∫ psi·R K_bt R^T psi - m·(phi × psi) + e·K_se e + n·(phi × (phi × tau)) - 2 n·(phi × d') ds (1)
// In a magnetic field the second derivative of its energy by (phi, d) is added. Rates psi and e at
// the collocation points are the coordinates, phi and d follow by the table: the same discrete rod
// that was solved. Source of (1): Simo & Vu-Quoc, CMAME 58 (1986), geometric stiffness; here in
// exponential coordinates, in which it is symmetric.
#pragma once

#include "engine/rod/field.h"

namespace cprsim {

struct RodVariation {
  MatX K;      ///< twice (1)'s half: x^T K x is (1)
  MatX M;      ///< x_t^T M x_t is twice the kinetic energy
  MatX base;   ///< 6 × n: (phi, d) at the base
  MatX tip;    ///< 6 × n
  MatX held;   ///< rows that must vanish: changes of length of tendons whose length is given, m
  MatX nodes;  ///< 6 (cells + 1) × n: (phi, d) at the cells' ends, for shapes of modes

  Eigen::Index size() const { return K.rows(); }
};

/// Coordinates of motions that stay in the plane across `normal`, as columns over all coordinates.
MatX planar_motions(const RodField& field, const Vec3& normal);

/// @param rotary whether sections have rotary inertia
RodVariation rod_variation(const RodField& field, bool rotary);

}  // namespace cprsim
