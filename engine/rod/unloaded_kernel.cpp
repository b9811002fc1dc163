// SPDX-License-Identifier: BSD-3-Clause
// A cell at rest along which nothing acts: only poses are integrated. Equations in
// engine/rod/cell.h, numbered there; compiled once per vector width, as engine/rod/cell_kernel.cpp.
//
// With k = b = t = 0 equations (3), (4) have the integrals n = n_a, m = m_a + n_a × (p - p_a), and
// any table finds them exactly, so that the solution is that of the other laws. What is left, (1)
// and (2), does not know where in space the cell is: carried along by its start's increment (phi_a,
// dp_a), the cell answers only to the wrench's increment that is left,
//   dn_r = dn_a - phi_a × n_a,  dm_r = dm_a - phi_a × m_a                              (7)
// The stage rates' linear system has these six and the residual (5) as its right-hand sides,
// however many columns Y has; dn passes through, and dm_b follows from dp_b.
#include "engine/rod/cell.h"
#include "engine/rod/cell_rows.h"

namespace cprsim {
namespace {

template <int S, bool extensible>
void evaluate_unloaded(const CellModel& M, CellStage* st, const NodeState& start, NodeState& end) {
  const ArcTableau& T = *M.table;
  const M3 R0 = load_matrix(start.R);
  const V3 p0 = load(start.p), n = load(start.n), m0 = load(start.m);
  V3 tau[S], Omega_end = {0, 0, 0}, x_end = {0, 0, 0};
  // (2), (6), (1)
  for (int j = 0; j < S; ++j) {
    V3 Omega = {0, 0, 0};
    for (int k = 0; k < S; ++k)
      Omega = Omega + (M.h * T.a[j][k]) * load(st[k].w);
    const RotationCoefficients k = rotation_coefficients(dot(Omega, Omega));
    const V3 w = load(st[j].w), Ow = cross(Omega, w);
    const M3 R = R0 * rotation_exp(Omega, k);
    V3 v = load(st[j].v0);
    if constexpr (extensible) v = v + scaled(M.sections[j].C_se, transposed_times(R, n));
    tau[j] = R * v;
    store(st[j].Omega, Omega);
    store(st[j].u, w + (-k.A) * Ow + k.B * cross(Omega, Ow));
    store_matrix(st[j].R, R);
    store(st[j].v, v);
    store(st[j].tau, tau[j]);
    Omega_end = Omega_end + (M.h * T.b[j]) * w;
  }
  for (int j = 0; j < S; ++j)
    x_end = x_end + (M.h * T.b[j]) * tau[j];
  // (4), (5)
  for (int j = 0; j < S; ++j) {
    V3 x = {0, 0, 0};
    for (int k = 0; k < S; ++k)
      x = x + (M.h * T.a[j][k]) * tau[k];
    const V3 m = m0 + cross(n, x);
    store(st[j].p, p0 + x);
    store(st[j].n, n);
    store(st[j].m, m);
    store(st[j].residual_u,
          load(st[j].u) - load(st[j].u0) -
              scaled(M.sections[j].C_bt, transposed_times(load_matrix(st[j].R), m)));
  }
  store_matrix(end.R,
               R0 * rotation_exp(Omega_end, rotation_coefficients(dot(Omega_end, Omega_end))));
  store(end.p, p0 + x_end);
  store(end.n, n);
  store(end.m, m0 + cross(n, x_end));
}

// v × each column
inline M3 cross_columns(V3 v, const M3& A) {
  M3 B;
  for (int c = 0; c < 3; ++c) {
    const V3 b = cross(v, {A.a[c], A.a[3 + c], A.a[6 + c]});
    B.a[c] = b.x;
    B.a[3 + c] = b.y;
    B.a[6 + c] = b.z;
  }
  return B;
}

// Columns as wide as the machine's vectors, whose elements are read as the numbers that they are:
// g++ unrolls loops as short as these before it could vectorise them.
#if defined(__AVX512F__)
constexpr int kWidth = 8;
#elif defined(__AVX__)
constexpr int kWidth = 4;
#else
constexpr int kWidth = 2;
#endif
using Pack [[gnu::vector_size(8 * kWidth)]] = double;

/// Three rows of N packs of columns.
template <int N>
struct Columns {
  Pack r[3][N];
};

template <int N>
[[gnu::always_inline]] inline void add_cross(Columns<N>& A, V3 a, const Columns<N>& B) {
  for (int c = 0; c < N; ++c) {
    A.r[0][c] += a.y * B.r[2][c] - a.z * B.r[1][c];
    A.r[1][c] += a.z * B.r[0][c] - a.x * B.r[2][c];
    A.r[2][c] += a.x * B.r[1][c] - a.y * B.r[0][c];
  }
}

// A += M B
template <int N>
[[gnu::always_inline]] inline void add_product(Columns<N>& A, const M3& M, const Columns<N>& B) {
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < N; ++c)
      A.r[i][c] += M.a[3 * i] * B.r[0][c] + M.a[3 * i + 1] * B.r[1][c] + M.a[3 * i + 2] * B.r[2][c];
}

template <int N>
[[gnu::always_inline]] inline void add_scaled(Columns<N>& A, double s, const Columns<N>& B) {
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < N; ++c)
      A.r[i][c] += s * B.r[i][c];
}

// The cell's own system. Columns: rates w of the stages, dn_r, dm_r, residual. With the stages'
// dOmega_k = sum over l of h a_kl dw_l, what poses bring is T_k dOmega_k.
template <int S, bool extensible>
struct UnloadedCell {
  static constexpr int kLifted = 3 * S, kForce = kLifted, kMoment = kLifted + 3,
                       kResidual = kLifted + 6;
  static constexpr int N = (kLifted + 7 + kWidth - 1) / kWidth;

  M3 T[S];  ///< dtau_k = T_k dOmega_k + Q_k dn_r, carried along
  M3 turn_end;
  M3 stretch_end;                        ///< of x_end by dn_r
  double weights[S][S], end_weights[S];  ///< h a_kl, h b_l
  Pack rows[kLifted][N];

  // the laws (5) of all stages
  [[gnu::always_inline]] void fill(const CellModel& M, const CellStage* st, const NodeState& start,
                                   const NodeState& end) {
    const V3 n = load(start.n), p0 = load(start.p);
    V3 Omega_end = {0, 0, 0};
    M3 Q[S], turn[S], J_r[S], by_turn[S];
    Columns<N> dOmega[S], nT[S];
    for (int k = 0; k < S; ++k) {
      for (int l = 0; l < S; ++l)
        weights[k][l] = M.h * M.table->a[k][l];
      end_weights[k] = M.h * M.table->b[k];
      alignas(64) double by_rates[3][kWidth * N] = {};
      for (int i = 0; i < 3; ++i)
        for (int l = 0; l < S; ++l)
          by_rates[i][3 * l + i] = weights[k][l];
      for (int i = 0; i < 3; ++i)
        for (int c = 0; c < N; ++c)
          dOmega[k].r[i][c] = *reinterpret_cast<const Pack*>(by_rates[i] + kWidth * c);
      const M3 R = load_matrix(st[k].R);
      const V3 Omega = load(st[k].Omega), w = load(st[k].w);
      const RotationCoefficients c = rotation_coefficients(dot(Omega, Omega));
      J_r[k] = right_jacobian(Omega, c);
      by_turn[k] = right_jacobian_derivative(Omega, w, c);
      turn[k] = R * J_r[k];
      // d tau = phi × tau + Q (dn_r - phi × n), Q = R C_se R^T
      T[k] = cross_columns(-1.0 * load(st[k].tau), turn[k]);
      if constexpr (extensible) {
        Q[k] = R * compliance_of_axes(R, M.sections[k].C_se);
        T[k] = T[k] + Q[k] * cross_columns(n, turn[k]);
      }
      nT[k] = {};
      add_product(nT[k], cross_columns(n, T[k]), dOmega[k]);
      Omega_end = Omega_end + end_weights[k] * w;
    }
    for (int j = 0; j < S; ++j) {
      // dm - phi × m = dm_r + dn_r × (p - p_a) + n × dx + m × phi
      const M3 C = compliance_of_axes(load_matrix(st[j].R), M.sections[j].C_bt);
      M3 by_force = cross_columns(load(st[j].p) - p0, identity());
      Columns<N> moved = {}, law = {};
      for (int k = 0; k < S; ++k) {
        add_scaled(moved, weights[j][k], nT[k]);
        if constexpr (extensible) by_force = by_force + (-weights[j][k]) * cross_columns(n, Q[k]);
      }
      add_product(law, -1.0 * C, moved);
      add_product(law, by_turn[j] + (-1.0) * (C * cross_columns(load(st[j].m), turn[j])),
                  dOmega[j]);
      by_force = C * by_force;
      for (int i = 0; i < 3; ++i) {
        for (int c = 0; c < N; ++c)
          rows[3 * j + i][c] = law.r[i][c];
        auto* row = reinterpret_cast<double*>(rows[3 * j + i]);
        for (int c = 0; c < 3; ++c) {
          row[3 * j + c] += J_r[j].a[3 * i + c];
          row[kForce + c] = by_force.a[3 * i + c];
          row[kMoment + c] = -C.a[3 * i + c];
        }
        row[kResidual] = st[j].residual_u[i];
      }
    }
    turn_end = load_matrix(end.R) *
               right_jacobian(Omega_end, rotation_coefficients(dot(Omega_end, Omega_end)));
    if constexpr (extensible) {
      stretch_end = 0.0 * identity();
      for (int k = 0; k < S; ++k)
        stretch_end = stretch_end + end_weights[k] * Q[k];
    }
  }

  double at(int row, int column) const {
    return reinterpret_cast<const double*>(rows[row])[column];
  }

  // Gauss with row pivoting; then the right-hand sides hold the rates by what moves them
  [[gnu::always_inline]] bool solve() {
    constexpr int kRight = kLifted / kWidth;  // whole vectors, from before the first of them
    Pack top[N];
    for (int k = 0; k < kLifted; ++k) {
      int pivot = k;
      for (int i = k + 1; i < kLifted; ++i)
        if (fabs(at(i, k)) > fabs(at(pivot, k))) pivot = i;
      if (!(fabs(at(pivot, k)) > 1e-300)) return false;
      const double s = 1 / at(pivot, k);
      for (int c = 0; c < N; ++c) {
        top[c] = s * rows[pivot][c];
        rows[pivot][c] = rows[k][c];
        rows[k][c] = top[c];
      }
      for (int i = k + 1; i < kLifted; ++i) {
        const double f = at(i, k);
        for (int c = 0; c < N; ++c)
          rows[i][c] -= f * top[c];
      }
    }
    for (int k = kLifted - 1; k > 0; --k)
      for (int i = 0; i < k; ++i) {
        const double f = at(i, k);
        for (int c = kRight; c < N; ++c)
          rows[i][c] -= f * rows[k][c];
      }
    return true;
  }

  // Y from start to end, and the rates' increments
  template <int NC>
  [[gnu::always_inline]] void carry(const NodeState& start, const NodeState& end, double* Y,
                                    double* dU) const {
    constexpr int kAffine = NC == kNarrow ? 6 : 12, V = NC / kWidth;
    const V3 n = load(start.n), X = load(end.p) - load(start.p);
    Columns<V> phi, force, moment, dp, Omega[S] = {}, turned = {};
    for (int i = 0; i < 3; ++i)
      for (int c = 0; c < V; ++c) {
        __builtin_memcpy(&phi.r[i][c], Y + i * NC + kWidth * c, sizeof(Pack));
        __builtin_memcpy(&dp.r[i][c], Y + (3 + i) * NC + kWidth * c, sizeof(Pack));
        __builtin_memcpy(&force.r[i][c], Y + (6 + i) * NC + kWidth * c, sizeof(Pack));
        __builtin_memcpy(&moment.r[i][c], Y + (9 + i) * NC + kWidth * c, sizeof(Pack));
      }
    // dm_b = dm_a + dn × X + n × (dp_b - dp_a)
    Columns<V> moment_end = moment;
    add_cross(moment_end, -1.0 * X, force);
    // (7)
    add_cross(force, n, phi);
    add_cross(moment, load(start.m), phi);
    for (int l = 0; l < S; ++l) {
      Columns<V> rates;
      for (int i = 0; i < 3; ++i) {
        const double* by = reinterpret_cast<const double*>(rows[3 * l + i]) + kForce;
        for (int c = 0; c < V; ++c) {
          rates.r[i][c] =
              -(by[0] * force.r[0][c] + by[1] * force.r[1][c] + by[2] * force.r[2][c] +
                by[3] * moment.r[0][c] + by[4] * moment.r[1][c] + by[5] * moment.r[2][c]);
          if (c == kAffine / kWidth) rates.r[i][c][kAffine % kWidth] -= by[6];
          __builtin_memcpy(dU + (3 * l + i) * NC + kWidth * c, &rates.r[i][c], sizeof(Pack));
        }
      }
      for (int k = 0; k < S; ++k)
        add_scaled(Omega[k], weights[k][l], rates);
      add_scaled(turned, end_weights[l], rates);
    }
    Columns<V> moved = {};
    add_cross(moved, -1.0 * X, phi);
    add_product(phi, turn_end, turned);
    for (int k = 0; k < S; ++k)
      add_product(moved, end_weights[k] * T[k], Omega[k]);
    if constexpr (extensible) add_product(moved, stretch_end, force);
    add_cross(moment_end, n, moved);
    for (int i = 0; i < 3; ++i)
      for (int c = 0; c < V; ++c) {
        dp.r[i][c] += moved.r[i][c];
        __builtin_memcpy(Y + i * NC + kWidth * c, &phi.r[i][c], sizeof(Pack));
        __builtin_memcpy(Y + (3 + i) * NC + kWidth * c, &dp.r[i][c], sizeof(Pack));
        __builtin_memcpy(Y + (9 + i) * NC + kWidth * c, &moment_end.r[i][c], sizeof(Pack));
      }
  }
};

template <int S, bool extensible, int NC>
bool linearize_unloaded(const CellModel& M, const CellStage* st, const NodeState& start,
                        const NodeState& end, double* Y, double* dU) {
  UnloadedCell<S, extensible> cell;
  cell.fill(M, st, start, end);
  if (!cell.solve()) return false;
  cell.template carry<NC>(start, end, Y, dU);
  return true;
}

template <int S, bool extensible>
constexpr CellKernel make_kernel() {
  return {3 * S, evaluate_unloaded<S, extensible>, linearize_unloaded<S, extensible, kNarrow>,
          linearize_unloaded<S, extensible, kWide>};
}

template <bool extensible>
constexpr CellKernel kKernels[] = {make_kernel<2, extensible>(), make_kernel<3, extensible>()};

}  // namespace

const CellKernel& CPRSIM_UNLOADED_KERNEL(int stages, bool extensible);

const CellKernel& CPRSIM_UNLOADED_KERNEL(int stages, bool extensible) {
  return extensible ? kKernels<true>[stages - 2] : kKernels<false>[stages - 2];
}

}  // namespace cprsim
