// SPDX-License-Identifier: BSD-3-Clause
// Force of a fluid on a section, per length of the unloaded rod: quadratic drag along and across
// the section's axis t = R e_3, and the inertia of the fluid that a motion across it takes along
// (Morison, O'Brien, Johnson, Schaaf, Petroleum Trans. AIME 189, 1950). Time is already algebra
// (engine/time/scheme.h), V is the current:
//   v = p_t - V = c_v p + v_h,    a = p_tt = c_v c_w p + a_h                              (1)
//   g = c_n |v_n| v_n + c_t |v_t| v_t + m_a a_n,    n_s = k p + b + g                     (2)
// with x_t = (x·t) t, x_n = x - x_t. The current is steady and uniform, so that it has no
// acceleration. Its pressure is buoyancy, a part of b.
#pragma once

#include "engine/section/fluid_section.h"
#include "engine/section/small_vector.h"

namespace {  // NOLINT: as small_vector.h

/// Reads the inputs, fills force and its derivatives. @param t unit axis of the section.
inline void evaluate_fluid(double c_v, double c_w, V3 p, V3 t, cprsim::FluidSection& f) {
  const V3 v = c_v * p + load(f.velocity_h), a = (c_v * c_w) * p + load(f.acceleration_h);
  const double along = dot(v, t), a_along = dot(a, t);
  const V3 v_n = v - along * t;
  const double speed = sqrt(dot(v_n, v_n)), per_speed = speed > 1e-300 ? 1 / speed : 0,
               slide = fabs(along);
  store(f.force, (f.normal * speed) * v_n + (f.tangential * slide * along) * t +
                     f.added_mass * (a - a_along * t));
  // d(|v_n| v_n) = |v_n| dv_n + v_n (v_n·dv_n) / |v_n|, dv_n = P dv - (t v^T + (v·t) I) dt
  const M3 tt = outer(t, t), P = identity() + (-1.0) * tt, nn = per_speed * outer(v_n, v_n);
  const M3 by_v = f.normal * (speed * P + nn) + (2 * f.tangential * slide) * tt;
  store_matrix(f.force_p, c_v * by_v + (c_v * c_w * f.added_mass) * P);
  const M3 by_t = (-f.normal) * (speed * (outer(t, v) + along * identity()) + along * nn) +
                  f.tangential * (2 * slide * outer(t, v) + (slide * along) * identity()) +
                  (-f.added_mass) * (outer(t, a) + a_along * identity());
  store_matrix(f.force_phi, (-1.0) * (by_t * hat(t)));  // dt = phi × t
}

}  // namespace
