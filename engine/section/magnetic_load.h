// SPDX-License-Identifier: BSD-3-Clause
// What a magnetic field does to a magnetised section, per length of the unloaded rod. With the
// moment per length m = R m_S, which turns with the section, the energy is -m·B(p), so that
//   l = m × B(p),    f = G m,    G = dB/dp = G^T                                           (1)
//   n_s = ... - f,   m_s = ... - l,   dm = phi × m                                         (2)
//   df = G (phi × m) + H dp,   dl = (phi × m) × B + m × G dp,   H = d(G m)/dp at fixed m   (3)
// A dipole a at distance r = p - p_a, x = r / |r| (Jackson, Classical Electrodynamics, 5.56):
//   B = c / |r|³ (3 (a·x) x - a),   c = mu_0 / 4 pi                                        (4)
//   G = 3 c / |r|⁴ (a x^T + x a^T + (a·x) I - 5 (a·x) x x^T)                               (5)
//   H = 3 c / |r|⁵ (m a^T + a m^T + (m·a) I - 5 [(a·x) (m x^T + x m^T) + (m·x) (a x^T + x a^T)
//                   + (m·a) x x^T + (m·x) (a·x) I] + 35 (m·x) (a·x) x x^T)                 (6)
// Source of (1): Lum et al., PNAS 113, 2016, for slender magnetic rods.
#pragma once

#include <cmath>

#include "engine/section/fluid_section.h"
#include "engine/section/magnetic_field.h"
#include "engine/section/small_vector.h"

namespace {  // NOLINT: as small_vector.h

constexpr double kMu0Over4Pi = 1e-7;  // T m/A, to ten digits (CODATA 2018)

/// B at a place, and G, H there for a moment m.
struct FieldAtPlace {
  V3 B;
  M3 G, H;
};

inline void add_dipole(const cprsim::MagneticDipole& dipole, V3 p, V3 m, FieldAtPlace& at) {
  const V3 r = p - load(dipole.position), a = load(dipole.moment);
  const double distance = sqrt(dot(r, r)), d2 = distance * distance;
  const V3 x = (1 / distance) * r;
  const double ax = dot(a, x), mx = dot(m, x), ma = dot(m, a), c = kMu0Over4Pi / (d2 * distance);
  const M3 xx = outer(x, x), ax_xa = outer(a, x) + outer(x, a);
  at.B = at.B + c * (3 * ax * x - a);
  at.G = at.G + (3 * c / distance) * (ax_xa + ax * identity() + (-5 * ax) * xx);
  at.H = at.H + (3 * c / d2) * (outer(m, a) + outer(a, m) + (ma - 5 * mx * ax) * identity() +
                                (-5 * ax) * (outer(m, x) + outer(x, m)) + (-5 * mx) * ax_xa +
                                (35 * mx * ax - 5 * ma) * xx);
}

inline FieldAtPlace magnetic_field(const cprsim::MagneticField& field, V3 p, V3 m) {
  FieldAtPlace at{load(field.uniform), 0.0 * identity(), 0.0 * identity()};
  for (int i = 0; i < field.count; ++i)
    add_dipole(field.dipoles[i], p, m, at);
  return at;
}

/// Adds (1) to what else lies around a section, which has been evaluated.
inline void add_magnetic_load(const cprsim::MagneticField& field, V3 p, const M3& R,
                              cprsim::FluidSection& f) {
  const V3 m = R * load(f.magnetization);
  const FieldAtPlace at = magnetic_field(field, p, m);
  store(f.moment, load(f.moment) - cross(m, at.B));
  store_matrix(f.moment_phi, load_matrix(f.moment_phi) + (-1.0) * (hat(at.B) * hat(m)));
  store_matrix(f.moment_p, (-1.0) * (hat(m) * at.G));
  if (field.count == 0) return;
  store(f.force, load(f.force) - at.G * m);
  store_matrix(f.force_p, load_matrix(f.force_p) + (-1.0) * at.H);
  store_matrix(f.force_phi, load_matrix(f.force_phi) + at.G * hat(m));
}

}  // namespace
