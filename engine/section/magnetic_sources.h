// SPDX-License-Identifier: BSD-3-Clause
// Sources of the magnetic field around rods at one instant, world axes. The field is given: what
// rods do to it and to its sources is not part of the model.
#pragma once

#include <vector>

#include "engine/math/types.h"
#include "engine/section/magnetic_field.h"

namespace cprsim {

struct MagneticSources {
  Vec3 uniform = Vec3::Zero();  ///< T
  std::vector<MagneticDipole> dipoles;

  bool none() const { return uniform.isZero(0) && dipoles.empty(); }
};

}  // namespace cprsim
