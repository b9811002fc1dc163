// SPDX-License-Identifier: BSD-3-Clause
// Rods and traces as triangles, as fine as the view needs them.
#pragma once

#include "render/camera.h"
#include "render/drawing.h"

namespace cprsim {

/// Appends the swept section of a rod with flat caps. Rods thinner than 1.2 pixels are drawn 1.2
/// pixels wide, so that they never vanish.
void sweep_tube(const Tube& tube, const View& view, TriMesh& mesh);

/// Appends what throws the rod's shadow: a flat ribbon that faces the light.
void sweep_shadow(const Tube& tube, const Vec3& to_light, TriMesh& mesh);

/// Appends a trace as a flat ribbon that faces the camera.
void sweep_ribbon(const Ribbon& ribbon, const View& view, TriMesh& mesh);

}  // namespace cprsim
