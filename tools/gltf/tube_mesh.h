// SPDX-License-Identifier: BSD-3-Clause
// Tubes as meshes whose rings follow the joints of a skin.
#pragma once

#include <vector>

#include "render/outline.h"
#include "tools/gltf/glb.h"

namespace cprsim {

/// A ring of the outline about each pose, with flat caps at both ends; ring k follows joint k.
/// @param offsets  of the ring's centre, in the axes of its pose; one per ring
GlbMesh make_tube_mesh(const std::vector<OutlinePoint>& outline, const std::vector<Pose>& poses,
                       const std::vector<Vec2>& offsets);

}  // namespace cprsim
