// SPDX-License-Identifier: BSD-3-Clause
// Where a frame stands as the scene draws it.
#pragma once

#include "engine/model/scene.h"

namespace cprsim {

/// In the world, at t = 0.
inline Pose start_pose(const Scene& scene, const FrameRef& frame) {
  if (frame.body == kWorld) return frame.X_BF;
  return scene.bodies[static_cast<std::size_t>(frame.body)].X_WB * frame.X_BF;
}

}  // namespace cprsim
