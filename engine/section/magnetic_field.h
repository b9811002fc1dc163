// SPDX-License-Identifier: BSD-3-Clause
// The magnetic field around a rod as the inner kernels read it, world axes; they own nothing.
#pragma once

namespace cprsim {

struct MagneticDipole {
  double position[3], moment[3];  ///< m, A m²
};

struct MagneticField {
  double uniform[3] = {};  ///< T
  const MagneticDipole* dipoles = nullptr;
  int count = 0;
};

}  // namespace cprsim
