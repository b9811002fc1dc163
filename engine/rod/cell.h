// SPDX-License-Identifier: BSD-3-Clause
// One cell of a rod: the Cosserat balance over a short piece of arc length, by a Runge-Kutta table.
//
// Balance at a section (Antman; Till, Aloi, Rucker 2019, eqs. 1-4), time already turned into
// algebra by the scheme, rho A p_tt = k p + (history):
//   p_s = R v                                     (1)      R_s = R u^ (2) n_s = k p + b (3) m_s =
//   -p_s × n + t(R)                     (4) u = u0 + C_bt R^T m                           (5) v =
//   v0 + C_se R^T n                       (6)
// k, b carry inertia and distributed force; u0, v0 rest shape and damping history; C_bt, C_se are
// compliances (a zero is a rigid mode); t is the rate of the section's angular momentum.
//
// The table acts on the rotation vector Omega of R = R_a exp(Omega^), Omega_s = w, u = J_r(Omega) w
// (Runge-Kutta-Munthe-Kaas). The stage rates w, and v when (6) cannot be resolved explicitly, stay
// unknowns of the outer Newton ("lifted", Albersmeyer & Diehl, SIAM J. Optim. 20, 2010): a sweep
// evaluates (1)-(4) explicitly, has (5), (6) as residuals, and eliminates their linearisation cell
// by cell. Nothing is iterated inside a cell.
//
// With tendons n and m are those of rod and tendons together, so that (3), (4) stay as they are; in
// (5), (6) the rod's own part is R^T m - Lambda_m(u, v), R^T n - Lambda_n(u, v), with the tendons'
// part of engine/section/tendon_law.h.
#pragma once

#include "engine/rod/tableau.h"
#include "engine/section/fluid_section.h"
#include "engine/section/outer_field.h"
#include "engine/section/tendon_section.h"

namespace cprsim {

/// Which of (6) is an unknown. Picked once per rod and mode.
enum class CellLaw {
  kKirchhoff,          ///< v = v0: no shear, no extension
  kExtensibleStatic,   ///< (6) explicit, valid while k = 0
  kExtensible,         ///< stage v lifted
  kKirchhoffGeneral,   ///< kKirchhoff; sections may vary and have rotary inertia, t of (4)
  kExtensibleGeneral,  ///< kExtensible, likewise
  kKirchhoffFluid,     ///< v = v0; a fluid's force in (3), loads along the rod and a magnetic
                       ///< field's in (3), (4)
  kExtensibleFluid,    ///< stage v lifted, likewise
  kTendons,            ///< stage v lifted, and tendons are part of the law
  kTendonsFluid,       ///< likewise, with what lies around a rod as in kKirchhoffFluid
  kUnloaded,           ///< v = v0, at rest, nothing acts along the rod; sections may vary
  kUnloadedExtensible  ///< (6) explicit, likewise
};

/// Whether n and the moment about a fixed point are constant: engine/rod/unloaded_kernel.cpp.
constexpr bool is_unloaded(CellLaw law) {
  return law == CellLaw::kUnloaded || law == CellLaw::kUnloadedExtensible;
}

/// One or four stages are for comparisons; they have no such copy.
constexpr bool has_unloaded_kernel(int stages) {
  return stages == 2 || stages == 3;
}

constexpr bool has_tendons(CellLaw law) {
  return law == CellLaw::kTendons || law == CellLaw::kTendonsFluid;
}

/// Whether stage rates v are unknowns.
constexpr bool lifts_stretch(CellLaw law) {
  return law == CellLaw::kExtensible || law == CellLaw::kExtensibleFluid || has_tendons(law) ||
         law == CellLaw::kExtensibleGeneral;
}

constexpr bool immersed(CellLaw law) {
  return law == CellLaw::kKirchhoffFluid || law == CellLaw::kExtensibleFluid ||
         law == CellLaw::kTendonsFluid;
}

/// Whether all sections of a cell have the model's own coefficients and no rotary inertia.
constexpr bool is_plain(CellLaw law) {
  return law == CellLaw::kKirchhoff || law == CellLaw::kExtensible ||
         law == CellLaw::kExtensibleStatic;
}

/// The law of sections that vary or have rotary inertia, if that is all there is to add.
constexpr CellLaw generalized(CellLaw law) {
  return !is_plain(law)               ? law
         : law == CellLaw::kKirchhoff ? CellLaw::kKirchhoffGeneral
                                      : CellLaw::kExtensibleGeneral;
}

/// Pose and internal wrench at a section, world axes; R row-major.
struct NodeState {
  double R[9], p[3], n[3], m[3];
};

/// Coefficients of a section during one solve.
struct CellSection {
  double C_bt[3] = {}, C_se[3] = {};
  double k = 0;         ///< N/m²
  double rhoJ[3] = {};  ///< section inertia, kg m
};

/// What all cells of a rod share during one solve. Its own coefficients are those of all sections
/// for plain laws; the others read `sections` and `rotary`.
struct CellModel : CellSection {
  const ArcTableau* table = nullptr;
  double h = 0;                           ///< cell length, m
  const CellSection* sections = nullptr;  ///< of the cell's stages
  bool rotary = false;
  double c_v = 0, c_w = 0;  ///< engine/time/scheme.h, for the rotary term and a fluid
  bool body_rates = false;  ///< rotation vector rates pass through J_r (all but generalised-alpha)
  FluidSection* fluid = nullptr;      ///< of the cell's stages, for the laws of a fluid
  bool loaded = false;                ///< whether these have moments per length, too
  const OuterField* field = nullptr;  ///< what magnetised ones of these are in, if any
  TendonSection* tendons =
      nullptr;  ///< of the cell's stages; only read where tendons are part of the law
  /// Likewise, and by linearize_wide() alone: what the columns of Y add to the residuals (5), (6),
  /// lifted × kWide; null: nothing.
  const double* sources = nullptr;
};

/// One stage: inputs of the balance, unknowns, and what the last evaluation found.
struct CellStage {
  double u0[3], v0[3], b[3];
  double R_start[9], theta_h[3],
      omega_h[3];  ///< rotary history: reference rotation and affine parts

  double w[3], v[3];  ///< unknowns (v: if lifted, otherwise a result)

  double Omega[3], R[9], p[3], n[3], m[3], u[3], tau[3];  ///< tau = R v
  double torque[3], torque_phi[9];  ///< t of (4) and its derivative by the world rotation increment
  double theta[3], theta_t[3], omega[3], omega_t[3];
  double residual_u[3], residual_v[3];  ///< (5), (6)
};

/// Sensitivities travel in blocks of columns: rows phi, p, n, m (world axes; phi the rotation
/// increment), row-major 12 × columns. Columns 0..5 belong to the unknowns at the segment's
/// start; 6..11 (only when 16) to the motion of the base body; then one affine column; the rest is
/// padding, or a contact's force.
constexpr int kNarrow = 8, kWide = 16;
constexpr int kContactColumn = 13;  ///< of wide blocks: the force of a contact in the cell
constexpr int kMaxLifted = 24;      ///< 6 per stage

struct CellKernel {
  int lifted;  ///< unknowns per cell
  void (*evaluate)(const CellModel&, CellStage* stages, const NodeState& start, NodeState& end);
  /// Y (12 × columns): start → end. dU (lifted × columns): increments of the lifted unknowns, w of
  /// all stages then v. The affine column takes the residuals (5), (6) along. Requires a preceding
  /// evaluate with the same arguments.
  /// @return false if the local system is singular.
  bool (*linearize_narrow)(const CellModel&, const CellStage* stages, const NodeState& start,
                           const NodeState& end, double* Y, double* dU);
  bool (*linearize_wide)(const CellModel&, const CellStage* stages, const NodeState& start,
                         const NodeState& end, double* Y, double* dU);
};

/// What it is called in `cprsim info` and run.json.
const char* law_name(CellLaw law);

/// The kernel for this machine. @param stages 1..4.
const CellKernel& cell_kernel(int stages, CellLaw law);

}  // namespace cprsim
