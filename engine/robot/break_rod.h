// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "engine/model/scene.h"
#include "engine/robot/robot.h"

namespace cprsim {

/// Tendons, loads, magnets, disks and ties along a rod, Scene::rods[index]: where its sections are
/// not smooth for them it has breaks. Before its model is made.
/// @throws std::invalid_argument for what a rod whose length is driven cannot have
void break_rod(const Scene& scene, std::size_t index, RobotRod& rod);

}  // namespace cprsim
