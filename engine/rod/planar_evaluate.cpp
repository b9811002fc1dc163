// SPDX-License-Identifier: BSD-3-Clause
// Evaluation of a planar cell; equations in engine/rod/planar_cell.h. Compiled once for all
// machines: wider vectors do not make it faster, and where a machine has fused multiply-add GCC 12
// takes it for sums like c x - s y beside s x + c y even with contraction off, so that copies would
// differ.
#include <cmath>

#include "engine/rod/planar_cell.h"
#include "engine/rod/planar_immersion.h"
#include "engine/rod/planar_steps.h"
#include "engine/rod/planar_tendons.h"

namespace cprsim {
namespace {

// Cosine and sine of a small turn by their Taylor series; beyond half a radian those of libm.
inline void cosine_sine(double x, double& c, double& s) {
  const double q = x * x;
  if (q > 0.25) {
    c = std::cos(x);
    s = std::sin(x);
    return;
  }
  c = 1 -
      q * (1. / 2 -
           q * (1. / 24 - q * (1. / 720 - q * (1. / 40320 - q * (1. / 3628800 - q / 479001600.)))));
  s = x *
      (1 - q * (1. / 6 -
                q * (1. / 120 -
                     q * (1. / 5040 - q * (1. / 362880 - q * (1. / 39916800 - q / 6227020800.))))));
}

template <int S, CellLaw law>
void evaluate(const PlanarModel& M, PlanarStage* st, const PlanarNode& start, PlanarNode& end) {
  const Steps<S> H(M);
  double tau[S][2], n_s[S][2], m_s[S];
  double turn_end = 0;
  for (int j = 0; j < S; ++j) {
    double turn = 0, c, s;
    for (int k = 0; k < S; ++k)
      turn += H.a[j][k] * st[k].kappa;
    cosine_sine(turn, c, s);
    st[j].theta = start.theta + turn;
    st[j].c = start.c * c - start.s * s;
    st[j].s = start.s * c + start.c * s;
    turn_end += H.b[j] * st[j].kappa;
  }
  // (5) explicit in statics, (1)
  for (int j = 0; j < S; ++j) {
    PlanarStage& at = st[j];
    if constexpr (!lifts_stretch(law)) {
      at.v[0] = at.v0[0];
      at.v[1] = at.v0[1];
    }
    if constexpr (law == CellLaw::kExtensibleStatic) {
      double n[2] = {start.n[0], start.n[1]};
      for (int k = 0; k < S; ++k)
        for (int i = 0; i < 2; ++i)
          n[i] += H.a[j][k] * st[k].b[i];
      at.v[0] += M.sections[j].C_v[0] * (at.c * n[0] + at.s * n[1]);
      at.v[1] += M.sections[j].C_v[1] * (at.c * n[1] - at.s * n[0]);
    }
    at.tau[0] = tau[j][0] = at.c * at.v[0] - at.s * at.v[1];
    at.tau[1] = tau[j][1] = at.s * at.v[0] + at.c * at.v[1];
  }
  // (2)
  for (int j = 0; j < S; ++j)
    for (int i = 0; i < 2; ++i) {
      double p = start.p[i];
      for (int k = 0; k < S; ++k)
        p += H.a[j][k] * tau[k][i];
      st[j].p[i] = p;
      n_s[j][i] = M.sections[j].k * p + st[j].b[i];
    }
  if constexpr (immersed(law))
    for (int j = 0; j < S; ++j) {
      M.immersion->evaluate(M.first + static_cast<std::size_t>(j), st[j]);
      for (int i = 0; i < 2; ++i)
        n_s[j][i] += M.around[j].n[i];
    }
  // (3)
  for (int j = 0; j < S; ++j) {
    for (int i = 0; i < 2; ++i) {
      double n = start.n[i];
      for (int k = 0; k < S; ++k)
        n += H.a[j][k] * n_s[k][i];
      st[j].n[i] = n;
    }
    m_s[j] = st[j].n[0] * tau[j][1] - st[j].n[1] * tau[j][0] + M.sections[j].k_J * st[j].theta +
             st[j].b_J;
    if constexpr (immersed(law)) m_s[j] += M.around[j].m;
  }
  // (4), (5)
  for (int j = 0; j < S; ++j) {
    PlanarStage& at = st[j];
    const PlanarSection& own = M.sections[j];
    double m = start.m;
    for (int k = 0; k < S; ++k)
      m += H.a[j][k] * m_s[k];
    at.m = m;
    at.residual_kappa = at.kappa - at.kappa0 - own.C_b * m;
    if constexpr (lifts_stretch(law)) {
      at.residual_v[0] = at.v[0] - at.v0[0] - own.C_v[0] * (at.c * at.n[0] + at.s * at.n[1]);
      at.residual_v[1] = at.v[1] - at.v0[1] - own.C_v[1] * (at.c * at.n[1] - at.s * at.n[0]);
    }
    if constexpr (has_tendons(law)) {
      M.tendons->evaluate(M.first + static_cast<std::size_t>(j), at);
      const double* pull = M.pulls[j].value;
      at.residual_kappa += own.C_b * pull[0];
      for (int i = 0; i < 2; ++i)
        at.residual_v[i] += own.C_v[i] * pull[1 + i];
    }
  }
  double c, s;
  cosine_sine(turn_end, c, s);
  PlanarNode out = start;
  out.theta += turn_end;
  out.c = start.c * c - start.s * s;
  out.s = start.s * c + start.c * s;
  for (int j = 0; j < S; ++j) {
    const double hb = H.b[j];
    for (int i = 0; i < 2; ++i) {
      out.p[i] += hb * tau[j][i];
      out.n[i] += hb * n_s[j][i];
    }
    out.m += hb * m_s[j];
  }
  end = out;
}

template <CellLaw law>
constexpr PlanarEvaluate kEvaluations[kMaxStages] = {evaluate<1, law>, evaluate<2, law>,
                                                     evaluate<3, law>, evaluate<4, law>};

}  // namespace

PlanarEvaluate planar_evaluate(int stages, CellLaw law) {
  switch (law) {
    case CellLaw::kKirchhoff:
      return kEvaluations<CellLaw::kKirchhoff>[stages - 1];
    case CellLaw::kExtensibleStatic:
      return kEvaluations<CellLaw::kExtensibleStatic>[stages - 1];
    case CellLaw::kKirchhoffFluid:
      return kEvaluations<CellLaw::kKirchhoffFluid>[stages - 1];
    case CellLaw::kExtensibleFluid:
      return kEvaluations<CellLaw::kExtensibleFluid>[stages - 1];
    case CellLaw::kTendons:
      return kEvaluations<CellLaw::kTendons>[stages - 1];
    case CellLaw::kTendonsFluid:
      return kEvaluations<CellLaw::kTendonsFluid>[stages - 1];
    case CellLaw::kExtensible:
    case CellLaw::kKirchhoffGeneral:  // rotary inertia is a part of planar laws
    case CellLaw::kExtensibleGeneral:
    case CellLaw::kUnloaded:  // of spatial rods only
    case CellLaw::kUnloadedExtensible:
      break;
  }
  return kEvaluations<CellLaw::kExtensible>[stages - 1];
}

}  // namespace cprsim
