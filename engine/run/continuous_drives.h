// SPDX-License-Identifier: BSD-3-Clause
// A driven position that jumps would ask for an infinite force. In a dynamic run such a jump takes
// one max_step_size instead: steps become ramps, stepped keyframes short slopes.
#pragma once

#include "engine/model/scene.h"

namespace cprsim {

/// The scene with every drive of joint position and rod length continuous, if it is dynamic.
Scene with_continuous_drives(Scene scene);

}  // namespace cprsim
