// SPDX-License-Identifier: BSD-3-Clause
// What tendons contribute to the internal wrench of a section, with its exact tangent. A tendon at
// the offset r(s) from the centreline is longer than the rod's arc length by |g|,
//   g = v + u × r + r_s,    t = g / |g|                                                        (1)
// (section axes) and pulls the far part towards the near one along t with its tension tau:
//   Lambda_n = sum tau t,   Lambda_m = sum tau r × t                                           (2)
// which is the gradient of sum tau |g| by (v, u), so that the tangent is symmetric:
//   dLambda_n = tau P (dv - r^ du),   dLambda_m = tau r^ P (dv - r^ du),   P = (1 - t t^T) / |g|
// (3)
// Source: Rucker & Webster, IEEE Trans. Robotics 27 (2011) 1033-1044, who put the same forces as a
// distributed load on the rod (n, m there are the rod's own). Here n, m are those of
// rod and tendons together, for which tendons are internal: the loads along the tendon and at its
// end need not be written, and no second derivatives of the strains arise.
#pragma once

#include "engine/section/small_vector.h"
#include "engine/section/tendon_section.h"

namespace {  // NOLINT: as small_vector.h

/// (1) to (3). force_u is the transpose of moment_v.
inline void evaluate_tendons(cprsim::TendonSection& section, V3 u, V3 v) {
  V3 moment = {0, 0, 0}, force = {0, 0, 0};
  M3 moment_u{}, moment_v{}, force_v{};
  for (int i = 0; i < section.count; ++i) {
    const cprsim::TendonPlace& place = section.places[i];
    section.stretch[i] = 0;
    store(section.directions + 3 * i, {0, 0, 0});
    if (!place.there) continue;
    const V3 r = load(place.r);
    const V3 g = v + cross(u, r) + load(place.r_s);
    const double length = sqrt(dot(g, g)), tension = section.tensions[i];
    const V3 t = (1 / length) * g;
    section.stretch[i] = length;
    store(section.directions + 3 * i, t);
    force = force + tension * t;
    moment = moment + tension * cross(r, t);
    const M3 P = (tension / length) * (identity() + (-1.0) * outer(t, t)), R = hat(r);
    const M3 RP = R * P;
    force_v = force_v + P;
    moment_v = moment_v + RP;
    moment_u = moment_u + (-1.0) * (RP * R);
  }
  store(section.moment, moment);
  store(section.force, force);
  store_matrix(section.moment_u, moment_u);
  store_matrix(section.moment_v, moment_v);
  store_matrix(section.force_v, force_v);
}

}  // namespace
