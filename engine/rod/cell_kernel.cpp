// SPDX-License-Identifier: BSD-3-Clause
// Evaluation and exact linearisation of a cell; equations in engine/rod/cell.h, numbered there.
// This file is compiled once per vector width (CPRSIM_KERNEL names the copy). Columns are
// independent and contraction is off, so all copies give the same bits.
#include "engine/rod/cell.h"
#include "engine/rod/cell_rows.h"
#include "engine/section/line_load.h"
#include "engine/section/rotary.h"
#include "engine/section/small_vector.h"
#include "engine/section/tendon_law.h"

namespace cprsim {
namespace {

constexpr int round_up(int n) {
  return (n + 7) / 8 * 8;
}

/// Coefficients by stage.
template <CellLaw law>
struct Sections {
  const CellSection* first;

  explicit Sections(const CellModel& M) : first(is_plain(law) ? &M : M.sections) {}

  const CellSection& operator[](int stage) const { return first[is_plain(law) ? 0 : stage]; }
};

/// What evaluate_rotary() reads.
struct RotaryModel {
  const double* rhoJ;
  double c_v, c_w;
  bool body_rates;
};

// Nonlinear evaluation: (1)-(4) explicitly in the order the law allows, then the residuals (5),
// (6).
template <int S, CellLaw law>
void evaluate(const CellModel& M, CellStage* st, const NodeState& start, NodeState& end) {
  const ArcTableau& T = *M.table;
  const Sections<law> at(M);
  const double h = M.h;
  const M3 R0 = load_matrix(start.R);
  const V3 p0 = load(start.p), n0 = load(start.n), m0 = load(start.m);
  V3 tau[S], n_s[S], m_s[S];
  V3 Omega_end = {0, 0, 0};

  // rotations of the stages
  for (int j = 0; j < S; ++j) {
    V3 Omega = {0, 0, 0};
    for (int k = 0; k < S; ++k)
      Omega = Omega + (h * T.a[j][k]) * load(st[k].w);
    const RotationCoefficients k = rotation_coefficients(dot(Omega, Omega));
    const V3 w = load(st[j].w);
    const V3 Ow = cross(Omega, w);
    store(st[j].Omega, Omega);
    store(st[j].u, w + (-k.A) * Ow + k.B * cross(Omega, Ow));
    store_matrix(st[j].R, R0 * rotation_exp(Omega, k));
    Omega_end = Omega_end + (h * T.b[j]) * w;
  }

  // (6) explicit in statics: forces do not depend on positions
  if constexpr (law == CellLaw::kExtensibleStatic) {
    for (int j = 0; j < S; ++j) {
      V3 n = n0;
      for (int k = 0; k < S; ++k)
        n = n + (h * T.a[j][k]) * load(st[k].b);
      store(st[j].v,
            load(st[j].v0) + scaled(at[j].C_se, transposed_times(load_matrix(st[j].R), n)));
    }
  } else if constexpr (!lifts_stretch(law)) {
    for (int j = 0; j < S; ++j)
      store(st[j].v, load(st[j].v0));
  }

  // (1)
  for (int j = 0; j < S; ++j) {
    tau[j] = load_matrix(st[j].R) * load(st[j].v);
    store(st[j].tau, tau[j]);
  }
  // (3)
  for (int j = 0; j < S; ++j) {
    V3 p = p0;
    for (int k = 0; k < S; ++k)
      p = p + (h * T.a[j][k]) * tau[k];
    store(st[j].p, p);
    n_s[j] = at[j].k * p + load(st[j].b);
    if constexpr (immersed(law)) {
      evaluate_surroundings(M.c_v, M.c_w, p, load_matrix(st[j].R), M.field, M.fluid[j]);
      n_s[j] = n_s[j] + load(M.fluid[j].force);
    }
  }
  // (4)
  for (int j = 0; j < S; ++j) {
    V3 n = n0;
    for (int k = 0; k < S; ++k)
      n = n + (h * T.a[j][k]) * n_s[k];
    store(st[j].n, n);
    m_s[j] = cross(n, tau[j]);
    if constexpr (immersed(law))
      if (M.loaded) m_s[j] = m_s[j] + load(M.fluid[j].moment);
    if constexpr (!is_plain(law))
      if (M.rotary) {
        evaluate_rotary(RotaryModel{at[j].rhoJ, M.c_v, M.c_w, M.body_rates}, st[j]);
        m_s[j] = m_s[j] + load(st[j].torque);
      }
  }
  // (5), (6)
  for (int j = 0; j < S; ++j) {
    V3 m = m0;
    for (int k = 0; k < S; ++k)
      m = m + (h * T.a[j][k]) * m_s[k];
    store(st[j].m, m);
    const M3 R = load_matrix(st[j].R);
    V3 own_m = transposed_times(R, m), own_n = transposed_times(R, load(st[j].n));
    if constexpr (has_tendons(law)) {
      TendonSection& tendons = M.tendons[j];
      evaluate_tendons(tendons, load(st[j].u), load(st[j].v));
      own_m = own_m - load(tendons.moment);
      own_n = own_n - load(tendons.force);
    }
    store(st[j].residual_u, load(st[j].u) - load(st[j].u0) - scaled(at[j].C_bt, own_m));
    if constexpr (lifts_stretch(law))
      store(st[j].residual_v, load(st[j].v) - load(st[j].v0) - scaled(at[j].C_se, own_n));
  }

  V3 p = p0, n = n0, m = m0;
  for (int j = 0; j < S; ++j) {
    p = p + (h * T.b[j]) * tau[j];
    n = n + (h * T.b[j]) * n_s[j];
    m = m + (h * T.b[j]) * m_s[j];
  }
  store_matrix(end.R,
               R0 * rotation_exp(Omega_end, rotation_coefficients(dot(Omega_end, Omega_end))));
  store(end.p, p);
  store(end.n, n);
  store(end.m, m);
}

// All sensitivities of one cell, columns: lifted unknowns first, then the columns of Y.
template <int S, CellLaw law, int NC>
struct Linearization {
  static constexpr int kLifted = lifts_stretch(law) ? 6 * S : 3 * S;
  static constexpr int W = round_up(kLifted + NC);
  Rows<W> phi0, p0, n0, m0, phi[S], tau[S], p[S], n[S], m_s[S];
  M3 turn[S];  // R_j J_r(Omega_j)
  M3 J_r[S];
  Rows<W> fluid[immersed(law) ? S : 1];
  alignas(64) double law_rows[kLifted][W];

  [[gnu::always_inline]] void take_columns(const double* Y) {
    Rows<W>* const target[4] = {&phi0, &p0, &n0, &m0};
    for (int b = 0; b < 4; ++b) {
      set_zero(*target[b]);
      for (int i = 0; i < 3; ++i)
        for (int c = 0; c < NC; ++c)
          target[b]->r[i][kLifted + c] = Y[(3 * b + i) * NC + c];
    }
  }

  void rotations(const CellModel& M, const CellStage* st) {
    for (int j = 0; j < S; ++j) {
      const V3 Omega = load(st[j].Omega);
      const RotationCoefficients k = rotation_coefficients(dot(Omega, Omega));
      J_r[j] = right_jacobian(Omega, k);
      turn[j] = load_matrix(st[j].R) * J_r[j];
      phi[j] = phi0;
      for (int l = 0; l < S; ++l)
        if (M.table->a[j][l] != 0) add_block(phi[j], 3 * l, M.h * M.table->a[j][l], turn[j]);
    }
  }

  // d tau = phi × tau + R dv
  void tangents(const CellModel& M, const CellStage* st) {
    const Sections<law> at(M);
    for (int j = 0; j < S; ++j) {
      set_zero(tau[j]);
      const M3 R = load_matrix(st[j].R);
      add_cross(tau[j], -1.0 * load(st[j].tau), phi[j]);
      if constexpr (lifts_stretch(law)) add_block(tau[j], 3 * S + 3 * j, 1.0, R);
      if constexpr (law == CellLaw::kExtensibleStatic) {
        // dv = C R^T (dn - phi × n), dn that of the start
        Rows<W> moved = n0;
        add_cross(moved, load(st[j].n), phi[j]);
        add_product(tau[j], 1.0, R * compliance_of_axes(R, at[j].C_se), moved);
      }
    }
  }

  void forces(const CellModel& M, const CellStage* st) {
    const Sections<law> at(M);
    for (int j = 0; j < S; ++j) {
      p[j] = p0;
      for (int k = 0; k < S; ++k)
        if (M.table->a[j][k] != 0) add_scaled(p[j], M.h * M.table->a[j][k], tau[k]);
    }
    if constexpr (immersed(law))
      for (int j = 0; j < S; ++j) {
        set_zero(fluid[j]);
        add_product(fluid[j], 1.0, load_matrix(M.fluid[j].force_p), p[j]);
        add_product(fluid[j], 1.0, load_matrix(M.fluid[j].force_phi), phi[j]);
      }
    for (int j = 0; j < S; ++j) {
      n[j] = n0;
      if (at[j].k != 0)
        for (int k = 0; k < S; ++k)
          if (M.table->a[j][k] != 0) add_scaled(n[j], M.h * M.table->a[j][k] * at[k].k, p[k]);
      if constexpr (immersed(law))
        for (int k = 0; k < S; ++k)
          if (M.table->a[j][k] != 0) add_scaled(n[j], M.h * M.table->a[j][k], fluid[k]);
      set_zero(m_s[j]);
      add_cross(m_s[j], load(st[j].n), tau[j]);
      add_cross(m_s[j], -1.0 * load(st[j].tau), n[j]);
      if constexpr (immersed(law))
        if (M.loaded) {
          add_product(m_s[j], 1.0, load_matrix(M.fluid[j].moment_phi), phi[j]);
          if (M.field && M.field->magnetic.count > 0)
            add_product(m_s[j], 1.0, load_matrix(M.fluid[j].moment_p), p[j]);
        }
      if constexpr (!is_plain(law))
        if (M.rotary) add_product(m_s[j], 1.0, load_matrix(st[j].torque_phi), phi[j]);
    }
  }

  // rows += A du with du = J_r dw_j + D dOmega
  void add_curvature(Rows<W>& rows, const CellModel& M, int j, const M3& A, const M3& D) const {
    add_block(rows, 3 * j, 1.0, A * J_r[j]);
    const M3 AD = A * D;
    for (int k = 0; k < S; ++k)
      if (M.table->a[j][k] != 0) add_block(rows, 3 * k, M.h * M.table->a[j][k], AD);
  }

  void laws(const CellModel& M, const CellStage* st) {
    const Sections<law> at(M);
    for (int j = 0; j < S; ++j) {
      const M3 R = load_matrix(st[j].R);
      // (5)
      Rows<W> rows;
      set_zero(rows);
      const V3 Omega = load(st[j].Omega);
      const M3 D =
          right_jacobian_derivative(Omega, load(st[j].w), rotation_coefficients(dot(Omega, Omega)));
      if constexpr (has_tendons(law)) {
        const TendonSection& tendons = M.tendons[j];
        add_curvature(rows, M, j, softened(at[j].C_bt, load_matrix(tendons.moment_u), 1), D);
        add_block(rows, 3 * S + 3 * j, 1.0, softened(at[j].C_bt, load_matrix(tendons.moment_v), 0));
      } else {
        add_block(rows, 3 * j, 1.0, J_r[j]);
        for (int k = 0; k < S; ++k)
          if (M.table->a[j][k] != 0) add_block(rows, 3 * k, M.h * M.table->a[j][k], D);
      }
      Rows<W> moved = m0;
      for (int k = 0; k < S; ++k)
        if (M.table->a[j][k] != 0) add_scaled(moved, M.h * M.table->a[j][k], m_s[k]);
      add_cross(moved, load(st[j].m), phi[j]);
      add_product(rows, -1.0, compliance_of_axes(R, at[j].C_bt), moved);
      put_rows(rows, 3 * j, st[j].residual_u);
      // (6)
      if constexpr (lifts_stretch(law)) {
        set_zero(rows);
        if constexpr (has_tendons(law)) {
          const TendonSection& tendons = M.tendons[j];
          add_curvature(rows, M, j,
                        softened(at[j].C_se, transpose(load_matrix(tendons.moment_v)), 0), D);
          add_block(rows, 3 * S + 3 * j, 1.0,
                    softened(at[j].C_se, load_matrix(tendons.force_v), 1));
        } else {
          add_block(rows, 3 * S + 3 * j, 1.0, identity());
        }
        moved = n[j];
        add_cross(moved, load(st[j].n), phi[j]);
        add_product(rows, -1.0, compliance_of_axes(R, at[j].C_se), moved);
        put_rows(rows, 3 * S + 3 * j, st[j].residual_v);
      }
    }
    if constexpr (has_tendons(law) && NC == kWide)
      if (M.sources)
        for (int i = 0; i < kLifted; ++i)
          for (int c = 0; c < NC; ++c)
            law_rows[i][kLifted + c] += M.sources[i * NC + c];
  }

  void put_rows(const Rows<W>& rows, int first, const double* residual) {
    constexpr int kAffine = kLifted + (NC == kNarrow ? 6 : 12);
    for (int i = 0; i < 3; ++i) {
      for (int c = 0; c < W; ++c)
        law_rows[first + i][c] = rows.r[i][c];
      law_rows[first + i][kAffine] += residual[i];
    }
  }

  void end(const CellModel& M, const CellStage* st, const NodeState& end_node, double* Y,
           double* dU) {
    const Sections<law> at(M);
    for (int i = 0; i < kLifted; ++i)
      for (int c = 0; c < NC; ++c)
        dU[i * NC + c] = -law_rows[i][kLifted + c];
    V3 Omega = {0, 0, 0};
    for (int j = 0; j < S; ++j)
      Omega = Omega + (M.h * M.table->b[j]) * load(st[j].w);
    const M3 turn_end =
        load_matrix(end_node.R) * right_jacobian(Omega, rotation_coefficients(dot(Omega, Omega)));
    for (int j = 0; j < S; ++j) {
      const double hb = M.h * M.table->b[j];
      add_block(phi0, 3 * j, hb, turn_end);
      add_scaled(p0, hb, tau[j]);
      if (at[j].k != 0) add_scaled(n0, hb * at[j].k, p[j]);
      if constexpr (immersed(law)) add_scaled(n0, hb, fluid[j]);
      add_scaled(m0, hb, m_s[j]);
    }
    const Rows<W>* const source[4] = {&phi0, &p0, &n0, &m0};
    for (int b = 0; b < 4; ++b)
      for (int i = 0; i < 3; ++i) {
        double* y = Y + (3 * b + i) * NC;
        const double* row = source[b]->r[i];
        for (int c = 0; c < NC; ++c)
          y[c] = row[kLifted + c];
        for (int l = 0; l < kLifted; ++l) {
          const double f = row[l];
          for (int c = 0; c < NC; ++c)
            y[c] += f * dU[l * NC + c];
        }
      }
  }
};

template <int S, CellLaw law, int NC>
bool linearize(const CellModel& M, const CellStage* st, const NodeState&, const NodeState& end,
               double* Y, double* dU) {
  using L = Linearization<S, law, NC>;
  L lin;
  lin.take_columns(Y);
  lin.rotations(M, st);
  lin.tangents(M, st);
  lin.forces(M, st);
  lin.laws(M, st);
  if (!eliminate<L::kLifted, L::W>(lin.law_rows)) return false;
  lin.end(M, st, end, Y, dU);
  return true;
}

template <int S, CellLaw law>
constexpr CellKernel make_kernel() {
  return {lifts_stretch(law) ? 6 * S : 3 * S, evaluate<S, law>, linearize<S, law, kNarrow>,
          linearize<S, law, kWide>};
}

template <CellLaw law>
constexpr CellKernel kKernels[kMaxStages] = {make_kernel<1, law>(), make_kernel<2, law>(),
                                             make_kernel<3, law>(), make_kernel<4, law>()};

}  // namespace

const CellKernel& CPRSIM_KERNEL(int stages, CellLaw law);

const CellKernel& CPRSIM_KERNEL(int stages, CellLaw law) {
  switch (law) {
    case CellLaw::kKirchhoff:
      return kKernels<CellLaw::kKirchhoff>[stages - 1];
    case CellLaw::kExtensibleStatic:
      return kKernels<CellLaw::kExtensibleStatic>[stages - 1];
    case CellLaw::kExtensible:
      return kKernels<CellLaw::kExtensible>[stages - 1];
#ifndef CPRSIM_BARE_KERNEL  // which tests/effects compares with
    case CellLaw::kKirchhoffGeneral:
      return kKernels<CellLaw::kKirchhoffGeneral>[stages - 1];
    case CellLaw::kExtensibleGeneral:
      return kKernels<CellLaw::kExtensibleGeneral>[stages - 1];
#endif
#ifdef CPRSIM_EVERY_LAW
    case CellLaw::kKirchhoffFluid:
      return kKernels<CellLaw::kKirchhoffFluid>[stages - 1];
    case CellLaw::kExtensibleFluid:
      return kKernels<CellLaw::kExtensibleFluid>[stages - 1];
    case CellLaw::kTendons:
      return kKernels<CellLaw::kTendons>[stages - 1];
    case CellLaw::kTendonsFluid:
      return kKernels<CellLaw::kTendonsFluid>[stages - 1];
#endif
    default:
      break;
  }
  return kKernels<CellLaw::kExtensible>[stages - 1];
}

}  // namespace cprsim
