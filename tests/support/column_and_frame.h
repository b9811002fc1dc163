// SPDX-License-Identifier: BSD-3-Clause
// Lee's frame, and rods that a motor twists.
#pragma once

#include <utility>

#include "tests/support/robots.h"

namespace cprsim {

/// Two legs of 120 at a right angle between hinges, pressed on the horizontal one 24 from the
/// corner (Lee, Manuel & Rossow, J. Eng. Mech. Div. 94, 1968). The load, of unit 0, is the scene's
/// first.
Scene lees_frame();

/// Puts the base of rod 0 on a motor about the world's z axis. @return its drive, without a profile
DriveSpec& turn_base(Scene& scene);

}  // namespace cprsim
