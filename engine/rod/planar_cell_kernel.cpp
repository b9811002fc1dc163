// SPDX-License-Identifier: BSD-3-Clause
// Exact linearisation of a planar cell; equations in engine/rod/planar_cell.h. Compiled once per
// vector width like cell_kernel.cpp (CPRSIM_PLANAR_KERNEL names the copy).
#include <cmath>

#include "engine/rod/planar_cell.h"
#include "engine/rod/planar_steps.h"

namespace cprsim {
namespace {

// A row of sensitivities.
template <int W>
struct alignas(32) Row {
  double r[W];
};

template <int W>
inline void add(Row<W>& A, double s, const Row<W>& B) {
  for (int c = 0; c < W; ++c)
    A.r[c] += s * B.r[c];
}

template <int W>
inline Row<W> sum(double a, const Row<W>& A, double b, const Row<W>& B) {
  Row<W> C{};
  for (int c = 0; c < W; ++c)
    C.r[c] = a * A.r[c] + b * B.r[c];
  return C;
}

// Gauss-Jordan with row pivoting on an L × W array whose first L columns are the matrix.
template <int L, int W>
bool eliminate(Row<W>* A) {
  for (int k = 0; k < L; ++k) {
    int pivot = k;
    for (int i = k + 1; i < L; ++i)
      if (std::fabs(A[i].r[k]) > std::fabs(A[pivot].r[k])) pivot = i;
    if (!(std::fabs(A[pivot].r[k]) > 1e-300)) return false;
    if (pivot != k) {
      const Row<W> swapped = A[k];
      A[k] = A[pivot];
      A[pivot] = swapped;
    }
    const double s = 1 / A[k].r[k];
    for (int c = 0; c < W; ++c)
      A[k].r[c] *= s;
    for (int i = 0; i < L; ++i) {
      if (i == k) continue;
      const double f = A[i].r[k];
      for (int c = 0; c < W; ++c)
        A[i].r[c] -= f * A[k].r[c];
    }
  }
  return true;
}

// Columns: lifted unknowns first, then the columns of Y.
template <int S, CellLaw law, int NC>
bool linearize(const PlanarModel& M, const PlanarStage* st, double* Y, double* dU) {
  constexpr int L = lifts_stretch(law) ? 3 * S : S;
  constexpr int W = (L + NC + 3) / 4 * 4;
  constexpr int kAffine = L + (NC == kPlanarNarrow ? 3 : 6);
  using R = Row<W>;
  const Steps<S> H(M);

  R y[6];  // theta, p, n, m
  for (int i = 0; i < 6; ++i) {
    y[i] = R{};
    for (int c = 0; c < NC; ++c)
      y[i].r[L + c] = Y[i * NC + c];
  }
  // d tau = (d theta) e3 × tau + dv_t t + dv_d d
  R theta[S], tau[S][2];
  for (int j = 0; j < S; ++j) {
    const PlanarStage& at = st[j];
    [[maybe_unused]] const PlanarSection& own = M.sections[j];
    theta[j] = y[0];
    for (int k = 0; k < S; ++k)
      theta[j].r[k] += H.a[j][k];
    double by_theta[2] = {-at.tau[1], at.tau[0]};
    if constexpr (law == CellLaw::kExtensibleStatic) {
      // dv_t = C_a (t·dn + d·n dtheta), dv_d = C_s (d·dn - t·n dtheta), dn that of the start
      const double n_t = at.c * at.n[0] + at.s * at.n[1], n_d = at.c * at.n[1] - at.s * at.n[0];
      by_theta[0] += own.C_v[0] * n_d * at.c + own.C_v[1] * n_t * at.s;
      by_theta[1] += own.C_v[0] * n_d * at.s - own.C_v[1] * n_t * at.c;
      const double tt = own.C_v[0] * at.c * at.c + own.C_v[1] * at.s * at.s,
                   td = (own.C_v[0] - own.C_v[1]) * at.c * at.s,
                   dd = own.C_v[0] * at.s * at.s + own.C_v[1] * at.c * at.c;
      tau[j][0] = sum(tt, y[3], td, y[4]);
      tau[j][1] = sum(td, y[3], dd, y[4]);
      add(tau[j][0], by_theta[0], theta[j]);
      add(tau[j][1], by_theta[1], theta[j]);
    } else {
      for (int i = 0; i < 2; ++i)
        for (int c = 0; c < W; ++c)
          tau[j][i].r[c] = by_theta[i] * theta[j].r[c];
    }
    if constexpr (lifts_stretch(law)) {
      tau[j][0].r[S + 2 * j] += at.c;
      tau[j][1].r[S + 2 * j] += at.s;
      tau[j][0].r[S + 2 * j + 1] -= at.s;
      tau[j][1].r[S + 2 * j + 1] += at.c;
    }
  }
  R p[S][2] = {}, n[S][2], m_s[S] = {};
  const bool inertia = M.k != 0 || immersed(law);
  if (inertia)
    for (int j = 0; j < S; ++j)
      for (int i = 0; i < 2; ++i) {
        p[j][i] = y[1 + i];
        for (int k = 0; k < S; ++k)
          add(p[j][i], H.a[j][k], tau[k][i]);
      }
  [[maybe_unused]] R around[S][2];
  if constexpr (immersed(law))
    for (int j = 0; j < S; ++j)
      for (int i = 0; i < 2; ++i) {
        const PlanarAround& at = M.around[j];
        around[j][i] = sum(at.n_p[2 * i], p[j][0], at.n_p[2 * i + 1], p[j][1]);
        add(around[j][i], at.n_theta[i], theta[j]);
      }
  for (int j = 0; j < S; ++j) {
    const PlanarStage& at = st[j];
    for (int i = 0; i < 2; ++i) {
      n[j][i] = y[3 + i];
      if (inertia)
        for (int k = 0; k < S; ++k)
          add(n[j][i], H.a[j][k] * M.sections[k].k, p[k][i]);
      if constexpr (immersed(law))
        for (int k = 0; k < S; ++k)
          add(n[j][i], H.a[j][k], around[k][i]);
    }
    m_s[j] = sum(at.n[0], tau[j][1], -at.n[1], tau[j][0]);
    add(m_s[j], at.tau[1], n[j][0]);
    add(m_s[j], -at.tau[0], n[j][1]);
    if (M.sections[j].k_J != 0) add(m_s[j], M.sections[j].k_J, theta[j]);
    if constexpr (immersed(law)) {
      add(m_s[j], M.around[j].m_theta, theta[j]);
      for (int i = 0; i < 2; ++i)
        add(m_s[j], M.around[j].m_p[i], p[j][i]);
    }
  }
  R rows[L];
  for (int j = 0; j < S; ++j) {
    const PlanarStage& at = st[j];
    const PlanarSection& own = M.sections[j];
    R m = y[5];
    for (int k = 0; k < S; ++k)
      add(m, H.a[j][k], m_s[k]);
    for (int c = 0; c < W; ++c)
      rows[j].r[c] = -own.C_b * m.r[c];
    rows[j].r[j] += 1;
    rows[j].r[kAffine] += at.residual_kappa;
    if constexpr (lifts_stretch(law)) {
      const double n_t = at.c * at.n[0] + at.s * at.n[1], n_d = at.c * at.n[1] - at.s * at.n[0];
      R& stretch = rows[S + 2 * j];
      R& shear = rows[S + 2 * j + 1];
      stretch = sum(-own.C_v[0] * at.c, n[j][0], -own.C_v[0] * at.s, n[j][1]);
      add(stretch, -own.C_v[0] * n_d, theta[j]);
      shear = sum(own.C_v[1] * at.s, n[j][0], -own.C_v[1] * at.c, n[j][1]);
      add(shear, own.C_v[1] * n_t, theta[j]);
      stretch.r[S + 2 * j] += 1;
      shear.r[S + 2 * j + 1] += 1;
      stretch.r[kAffine] += at.residual_v[0];
      shear.r[kAffine] += at.residual_v[1];
    }
    if constexpr (has_tendons(law)) {
      const double* by = M.pulls[j].by;
      const int lifted[3] = {j, S + 2 * j, S + 2 * j + 1};
      const double C[3] = {own.C_b, own.C_v[0], own.C_v[1]};
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          rows[lifted[i]].r[lifted[k]] += C[i] * by[3 * i + k];
    }
  }
  if constexpr (has_tendons(law) && NC == kPlanarWide)
    if (M.sources)
      for (int i = 0; i < L; ++i)
        for (int c = 0; c < NC; ++c)
          rows[i].r[L + c] += M.sources[i * NC + c];
  if (!eliminate<L, W>(rows)) return false;
  for (int i = 0; i < L; ++i)
    for (int c = 0; c < NC; ++c)
      dU[i * NC + c] = -rows[i].r[L + c];
  for (int j = 0; j < S; ++j) {
    const double hb = H.b[j];
    y[0].r[j] += hb;
    for (int i = 0; i < 2; ++i) {
      add(y[1 + i], hb, tau[j][i]);
      if (inertia) add(y[3 + i], hb * M.sections[j].k, p[j][i]);
      if constexpr (immersed(law)) add(y[3 + i], hb, around[j][i]);
    }
    add(y[5], hb, m_s[j]);
  }
  for (int i = 0; i < 6; ++i) {
    double out[NC];
    for (int c = 0; c < NC; ++c)
      out[c] = y[i].r[L + c];
    for (int l = 0; l < L; ++l) {
      const double f = y[i].r[l];
      for (int c = 0; c < NC; ++c)
        out[c] += f * dU[l * NC + c];
    }
    for (int c = 0; c < NC; ++c)
      Y[i * NC + c] = out[c];
  }
  return true;
}

template <int S, CellLaw law>
constexpr PlanarKernel make_kernel() {
  return {lifts_stretch(law) ? 3 * S : S, nullptr, linearize<S, law, kPlanarNarrow>,
          linearize<S, law, kPlanarWide>};
}

template <CellLaw law>
constexpr PlanarKernel kKernels[kMaxStages] = {make_kernel<1, law>(), make_kernel<2, law>(),
                                               make_kernel<3, law>(), make_kernel<4, law>()};

}  // namespace

const PlanarKernel& CPRSIM_PLANAR_KERNEL(int stages, CellLaw law);

const PlanarKernel& CPRSIM_PLANAR_KERNEL(int stages, CellLaw law) {
  switch (law) {
    case CellLaw::kKirchhoff:
      return kKernels<CellLaw::kKirchhoff>[stages - 1];
    case CellLaw::kExtensibleStatic:
      return kKernels<CellLaw::kExtensibleStatic>[stages - 1];
    case CellLaw::kKirchhoffFluid:
      return kKernels<CellLaw::kKirchhoffFluid>[stages - 1];
    case CellLaw::kExtensibleFluid:
      return kKernels<CellLaw::kExtensibleFluid>[stages - 1];
    case CellLaw::kTendons:
      return kKernels<CellLaw::kTendons>[stages - 1];
    case CellLaw::kTendonsFluid:
      return kKernels<CellLaw::kTendonsFluid>[stages - 1];
    case CellLaw::kExtensible:
    case CellLaw::kKirchhoffGeneral:  // rotary inertia is a part of planar laws
    case CellLaw::kExtensibleGeneral:
    case CellLaw::kUnloaded:  // of spatial rods only
    case CellLaw::kUnloadedExtensible:
      break;
  }
  return kKernels<CellLaw::kExtensible>[stages - 1];
}

}  // namespace cprsim
