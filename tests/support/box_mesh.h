// SPDX-License-Identifier: BSD-3-Clause
// A box as a mesh.
#pragma once

#include "engine/model/geometry.h"

namespace cprsim {

/// Twelve triangles, each side with corners of its own, as files have them.
/// @param at the middle, m
MeshSpec box_mesh(const Vec3& size, const Vec3& at = Vec3::Zero());

}  // namespace cprsim
