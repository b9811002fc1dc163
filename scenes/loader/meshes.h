// SPDX-License-Identifier: BSD-3-Clause
// Triangle meshes from files.
#pragma once

#include <cstddef>
#include <string>

#include "engine/model/geometry.h"

namespace cprsim {

/// Reads an STL, OBJ, COLLADA or glTF file. Normals are made where the file has none.
/// @param asset_root  nothing outside this folder is opened; empty: the file's own folder
/// @param submesh     only the part (mesh or node) of this name; empty: all
/// @param center      move the middle of its box to the origin
/// @param error       non-empty on failure
/// @param dropped     if given: how many triangles without area were left out
MeshSpec load_mesh(const std::string& path, const std::string& asset_root, const Vec3& scale,
                   const std::string& submesh, bool center, std::string& error,
                   std::size_t* dropped = nullptr);

}  // namespace cprsim
