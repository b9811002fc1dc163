// SPDX-License-Identifier: BSD-3-Clause
// The laws of engine/model/place_law.h, and what they add at a section.
#pragma once

#include <iterator>

#include "engine/section/conducting_plane.h"
#include "engine/section/fluid_section.h"
#include "engine/section/foundation.h"
#include "engine/section/outer_field.h"

namespace {  // NOLINT: as small_vector.h

constexpr PlaceForce (*kPlaceForces[])(const double* values, V3 p) = {foundation, conducting_plane};

static_assert(std::size(kPlaceForces) == std::size(cprsim::kPlaceLaws));

/// The sum of those that act on the part of the rod around `inside`.
inline PlaceForce placed_forces(const cprsim::PlacedForce* forces, int count, double inside, V3 p) {
  PlaceForce sum{{0, 0, 0}, 0.0 * identity()};
  for (int i = 0; i < count; ++i) {
    const cprsim::PlacedForce& one = forces[i];
    if (inside < one.from || inside > one.to) continue;
    const PlaceForce at = kPlaceForces[one.law](one.values, p);
    sum.f = sum.f + one.strength * at.f;
    sum.f_p = sum.f_p + one.strength * at.f_p;
  }
  return sum;
}

/// Adds them to what else lies around a section, which has been evaluated.
inline void add_placed_forces(const cprsim::PlacedForce* forces, int count, V3 p,
                              cprsim::FluidSection& f) {
  const PlaceForce at = placed_forces(forces, count, f.inside, p);
  store(f.applied, load(f.applied) + at.f);
  store(f.force, load(f.force) - at.f);
  store_matrix(f.force_p, load_matrix(f.force_p) + (-1.0) * at.f_p);
}

}  // namespace
