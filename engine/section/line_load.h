// SPDX-License-Identifier: BSD-3-Clause
// Forces and moments spread along a rod, per length of the unloaded rod, constant in world axes (d)
// or in those of the section, which they follow (o):
//   f = f_d + R f_o,   l = l_d + R l_o                                                       (1)
//   n_s = ... - f,     m_s = ... - l,     d(R x) = phi × R x                                 (2)
#pragma once

#include "engine/section/fluid.h"
#include "engine/section/magnetic_load.h"
#include "engine/section/outer_field.h"
#include "engine/section/place_laws.h"

namespace {  // NOLINT: as small_vector.h

/// Adds (1) to what a fluid does at a section, which has been evaluated; fills moment, moment_phi.
inline void add_line_load(const M3& R, cprsim::FluidSection& f) {
  const V3 turned = R * load(f.own_force), bent = R * load(f.own_moment);
  const V3 applied = load(f.dead_force) + turned;
  store(f.applied, applied);
  store(f.force, load(f.force) - applied);
  store_matrix(f.force_phi, load_matrix(f.force_phi) + hat(turned));
  store(f.moment, (-1.0) * (load(f.dead_moment) + bent));
  store_matrix(f.moment_phi, hat(bent));
}

/// All that lies around a section. @param field null without any
inline void evaluate_surroundings(double c_v, double c_w, V3 p, const M3& R,
                                  const cprsim::OuterField* field, cprsim::FluidSection& f) {
  evaluate_fluid(c_v, c_w, p, {R.a[2], R.a[5], R.a[8]}, f);
  if (f.loaded != 0) add_line_load(R, f);
  if (!field) return;
  if (f.magnetic != 0) add_magnetic_load(field->magnetic, p, R, f);
  if (field->force_count > 0) add_placed_forces(field->forces, field->force_count, p, f);
}

}  // namespace
