// SPDX-License-Identifier: BSD-3-Clause
// Which bodies fly freely, held by no rod and no joint, and whose they are: the Newton system's
// where rods, or what rods and joints hold, may touch them, otherwise those of whoever integrates
// rigid bodies.
#pragma once

#include <vector>

#include "engine/model/scene.h"

namespace cprsim {

/// By their bitmasks.
bool may_touch(const SurfaceSpec& a, const SurfaceSpec& b);

/// By Scene::bodies: neither static nor held.
std::vector<char> flying_bodies(const Scene& scene);

/// Of these, the ones that are unknowns of the Newton system: in dynamic scenes with contact and
/// rods, those that some rod or held body may touch, and those that may touch one of them. Not what
/// a velocity_decay slows.
std::vector<char> bodies_among_rods(const Scene& scene);

}  // namespace cprsim
