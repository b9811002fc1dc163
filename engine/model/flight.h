// SPDX-License-Identifier: BSD-3-Clause
// Which bodies fly freely, held by no rod and no joint, and whose they are: the Newton system's
// where rods may touch them and nothing else may, otherwise those of whoever integrates rigid
// bodies.
#pragma once

#include <vector>

#include "engine/model/scene.h"

namespace cprsim {

/// By their bitmasks.
bool may_touch(const SurfaceSpec& a, const SurfaceSpec& b);

/// By Scene::bodies: neither static nor held.
std::vector<char> flying_bodies(const Scene& scene);

/// Of these, the ones that are unknowns of the Newton system: in dynamic scenes with contact, those
/// that some rod may touch and no other body.
std::vector<char> bodies_among_rods(const Scene& scene);

}  // namespace cprsim
