// SPDX-License-Identifier: BSD-3-Clause
// Ties between rods (engine/model/tie_spec.h). To the equations they are contacts between rods that
// neither come nor go: (8) of engine/rod/contact.h.
#pragma once

#include "engine/robot/robot.h"

namespace cprsim {

/// Ties the rods: once all have models.
/// @throws std::invalid_argument for a rod whose method cannot be tied.
void tie_rods(Robot& robot);

}  // namespace cprsim
