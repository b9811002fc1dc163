// SPDX-License-Identifier: BSD-3-Clause
// <inertial auto="true">: mass and inertia of a link from its shapes (SDFormat 1.11).
#pragma once

#include "scenes/loader/reading.h"

namespace cprsim {

bool computes_inertia(const Node& inertial);

/// The body's shapes have been read. Collisions count, or visuals where there are none, each with
/// its own <density>, or that of <inertial>, or that of water; a <mass> scales the whole.
void weigh(Reading& reading, const Node& link, const Node& inertial, BodySpec& body);

}  // namespace cprsim
