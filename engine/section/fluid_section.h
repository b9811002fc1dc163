// SPDX-License-Identifier: BSD-3-Clause
// What lies around a section of a rod: a fluid (equations in engine/section/fluid.h), loads that
// are spread along the rod (engine/section/line_load.h), a magnetic field
// (engine/section/magnetic_load.h), forces by where it is
// (engine/section/place_laws.h).
#pragma once

namespace cprsim {

/// What a rod's section meets during one solve.
struct FluidSection {
  double normal, tangential;                ///< c_n, c_t, kg/m²
  double added_mass;                        ///< m_a, kg/m
  double velocity_h[3], acceleration_h[3];  ///< v_h, a_h of (1)
  double force[3];                          ///< g; by position and by the world rotation increment:
  double force_p[9], force_phi[9];

  /// Loads per length: constant in world axes, and in those of the section.
  double loaded;  ///< 0 without any
  double dead_force[3], dead_moment[3], own_force[3], own_moment[3];
  double applied[3];                ///< their force, world axes; a part of -g
  double moment[3], moment_phi[9];  ///< what they add to m_s, and by the world rotation increment

  double magnetic;          ///< 0 without a moment of its own
  double magnetization[3];  ///< per length, section axes, A m
  double moment_p[9];       ///< of moment, by position; only read in a field that varies

  double inside;  ///< where on the rod, a fraction of its length: which placed forces act
};

}  // namespace cprsim
