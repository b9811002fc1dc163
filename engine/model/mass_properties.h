// SPDX-License-Identifier: BSD-3-Clause
// Mass, centre of mass and inertia of homogeneous solids.
#pragma once

#include <vector>

#include "engine/model/geometry.h"

namespace cprsim {

struct MassProperties {
  double mass = 0;              ///< kg
  Vec3 com = Vec3::Zero();      ///< centre of mass, m
  Mat3 inertia = Mat3::Zero();  ///< about the centre of mass, axes of the frame, kg m²
};

/// In the shape's own frame; nothing for planes and empty shapes. A mesh is taken as the solid
/// inside its surface, which has to be closed; which way its triangles are turned does not matter.
/// @param density kg/m³
MassProperties mass_properties(const ShapeSpec& shape, const std::vector<MeshSpec>& meshes,
                               double density);

/// Whether every edge of the mesh joins two triangles.
bool encloses_solid(const MeshSpec& mesh);

/// As seen from a frame in which the body's stands at X.
MassProperties seen_from(const Pose& X, const MassProperties& body);

/// Of two bodies joined to one.
MassProperties joined(const MassProperties& a, const MassProperties& b);

}  // namespace cprsim
