// SPDX-License-Identifier: BSD-3-Clause
// What acts on a rod's sections by where they are, as the inner kernels read it; it owns nothing.
#pragma once

#include "engine/model/place_law.h"
#include "engine/section/magnetic_field.h"

namespace cprsim {

/// One of kPlaceLaws on a part of a rod, fractions of its length.
struct PlacedForce {
  int law = -1;
  double from = 0, to = 1;
  double strength = 1;  ///< multiplies the force
  double values[kLawNumbers] = {};
};

struct OuterField {
  MagneticField magnetic;
  const PlacedForce* forces = nullptr;
  int force_count = 0;
};

}  // namespace cprsim
