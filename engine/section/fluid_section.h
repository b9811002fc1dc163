// SPDX-License-Identifier: BSD-3-Clause
// A section in a fluid; equations in engine/section/fluid.h.
#pragma once

namespace cprsim {

/// What a rod's section meets during one solve.
struct FluidSection {
  double normal, tangential;                ///< c_n, c_t, kg/m²
  double added_mass;                        ///< m_a, kg/m
  double velocity_h[3], acceleration_h[3];  ///< v_h, a_h of (1)
  double force[3];                          ///< g; by position and by the world rotation increment:
  double force_p[9], force_phi[9];
};

}  // namespace cprsim
