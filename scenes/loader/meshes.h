// SPDX-License-Identifier: BSD-3-Clause
// Triangle meshes from files.
#pragma once

#include <string>

#include "engine/model/geometry.h"

namespace cprsim {

/// @param asset_root nothing outside this folder is opened. @param error non-empty on failure.
MeshSpec load_mesh(const std::string& path, const std::string& asset_root, const Vec3& scale,
                   const std::string& submesh, bool center, std::string& error);

}  // namespace cprsim
