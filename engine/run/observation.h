// SPDX-License-Identifier: BSD-3-Clause
// From the robot's present state to a Snapshot.
#pragma once

#include "engine/robot/free_bodies.h"
#include "engine/robot/robot.h"
#include "engine/run/snapshot.h"

namespace cprsim {

/// Motions of all links of the scene; those of free bodies come from their owner.
std::vector<BodyMotion> link_motions(const Robot& robot, const FreeBodies* free_bodies);

/// Everything but energy and solver entries.
Snapshot take_snapshot(const Robot& robot, const FreeBodies* free_bodies, double time);

}  // namespace cprsim
