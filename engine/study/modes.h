// SPDX-License-Identifier: BSD-3-Clause
// Natural frequencies and mode shapes of small vibration about an equilibrium: K x = omega² M x
// with the exact stiffness and inertia of the discrete robot (robot_variation.h).
#pragma once

#include <vector>

#include "engine/run/snapshot.h"
#include "engine/study/static_study.h"

namespace cprsim {

struct VibrationMode {
  double omega_squared = 0;  ///< rad²/s²; negative where the equilibrium is unstable
  /// Motion with unit kinetic inertia, x^T M x = 1 kg m² or kg: (rotation, translation) of the
  /// Newton bodies, and of the nodes of every rod.
  std::vector<Vec6> bodies;
  std::vector<std::vector<Vec6>> rods;

  /// Hz; 0 for a mode without vibration.
  double frequency() const;
};

/// The lowest modes, at most `count`, ascending in omega². Inertia is the robot's own: of rods
/// (rotary only if the scene lists it) and bodies. Damping is left out.
std::vector<VibrationMode> natural_modes(const StaticStudy& study, int count);

/// The equilibrium displaced along a mode so that the farthest moving node or body goes `amplitude`
/// (m).
Snapshot displaced(const StaticStudy& study, const VibrationMode& mode, double amplitude);

}  // namespace cprsim
