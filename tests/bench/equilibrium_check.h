// SPDX-License-Identifier: BSD-3-Clause
// Is what a solver calls an equilibrium one? Asked of observed numbers alone: rods' end forces and
// places, joint reactions, loads and weights, summed up here once more.
#pragma once

#include "engine/study/static_study.h"

namespace cprsim {

struct EquilibriumCheck {
  double imbalance = 0;  ///< worst resultant on a body, joint or rod over the robot's force scale
  double gap = 0;  ///< worst distance (over the robot's length) or angle of parts held together
};

EquilibriumCheck check_equilibrium(const StaticStudy& study);

}  // namespace cprsim
