// SPDX-License-Identifier: BSD-3-Clause
// What a law of engine/section/place_laws.h gives.
#pragma once

#include "engine/section/small_vector.h"

namespace {  // NOLINT: as small_vector.h

/// Force per length and its derivative by the position, symmetric where it has a potential.
struct PlaceForce {
  V3 f;
  M3 f_p;
};

}  // namespace
