// SPDX-License-Identifier: BSD-3-Clause
// One cell of a rod that bends in a plane: engine/rod/cell.h with one angle instead of a rotation.
//
// Plane axes e1, e2 and the normal e3 = e1 × e2; tangent t = (cos theta, sin theta), d = e3 × t:
//   theta_s = kappa, p_s = v_t t + v_d d (1)  n_s = k p + b (2)
//   m_s = n_1 tau_2 - n_2 tau_1 + k_J theta + b_J,  tau = p_s (3)
//   kappa = kappa_0 + C_b m (4)  v_t = v_t0 + C_a n·t,  v_d = v_d0 + C_s n·d (5)
// Rotations about one axis commute, so that angles are integrated as they are, and the rate of the
// section's angular momentum, k_J theta + b_J, is linear: k_J = rho I c_v c_w, with the scheme's
// history in b_J. Stage curvatures, and stretches where (5) is not explicit, are lifted as there.
// With tendons m, n·t and n·d in (4), (5) are less what they pull with.
#pragma once

#include "engine/rod/cell.h"
#include "engine/rod/tableau.h"

namespace cprsim {

/// Pose and internal wrench at a section, plane axes; c, s the cosine and sine of theta.
struct PlanarNode {
  double theta, p[2], n[2], m, c, s;
};

/// What lies around a section (engine/rod/planar_immersion.h): force and moment that n_s and m_s
/// gain, and their derivatives by p and theta.
struct PlanarAround {
  double n[2], n_p[4], n_theta[2], m, m_p[2], m_theta;
};

/// What tendons pull with at a section (engine/rod/planar_tendons.h): moment, and force along t and
/// d; by kappa, v_t, v_d.
struct PlanarPull {
  double value[3], by[9];
};

class PlanarImmersion;
class PlanarTendons;

/// Coefficients of a section during one solve.
struct PlanarSection {
  double C_b = 0, C_v[2] = {};  ///< compliances of bending; of stretch C_a and shear C_s
  double k = 0, k_J = 0;        ///< N/m²; N
};

/// What all cells of a rod share during one solve; its own coefficients are those of the base.
struct PlanarModel : PlanarSection {
  const ArcTableau* table = nullptr;
  double h = 0;                             ///< cell length, m
  const PlanarSection* sections = nullptr;  ///< of the cell's stages

  PlanarImmersion* immersion = nullptr;  ///< for the laws of a fluid
  const PlanarAround* around = nullptr;  ///< of the cell's stages
  std::size_t first = 0;                 ///< the first of these
  PlanarTendons* tendons = nullptr;      ///< for the laws of tendons
  const PlanarPull* pulls = nullptr;     ///< of the cell's stages
  const double* sources = nullptr;       ///< as CellModel::sources, lifted × kPlanarWide
};

struct PlanarStage {
  double kappa0, v0[2], b[2], b_J;
  double kappa, v[2];  ///< unknowns (v: kExtensible only, otherwise a result)
  double theta, c, s, p[2], n[2], m, tau[2];
  double residual_kappa, residual_v[2];  ///< (4), (5)
};

/// Sensitivities: rows theta, p, n, m, row-major 6 × columns. Columns 0..2 belong to the unknowns
/// at the segment's start; 3..5 (only when 8) to the motion of the base body; then one affine
/// column, and padding.
constexpr int kPlanarNarrow = 4, kPlanarWide = 8;

using PlanarEvaluate = void (*)(const PlanarModel&, PlanarStage* stages, const PlanarNode& start,
                                PlanarNode& end);

struct PlanarKernel {
  int lifted;  ///< unknowns per cell: kappa of all stages, then v of all stages
  PlanarEvaluate evaluate;
  /// As CellKernel's: Y (6 × columns) from start to end, dU (lifted × columns).
  bool (*linearize_narrow)(const PlanarModel&, const PlanarStage* stages, double* Y, double* dU);
  bool (*linearize_wide)(const PlanarModel&, const PlanarStage* stages, double* Y, double* dU);
};

PlanarEvaluate planar_evaluate(int stages, CellLaw law);

/// The kernel for this machine. @param stages 1..4.
PlanarKernel planar_kernel(int stages, CellLaw law);

/// Copies for different vector widths that this machine can run, the last being the one it does;
/// all give the same bits.
int planar_kernel_copies();
PlanarKernel planar_kernel_copy(int copy, int stages, CellLaw law);

}  // namespace cprsim
