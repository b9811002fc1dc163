// SPDX-License-Identifier: BSD-3-Clause
// What a mesh file must be before assimp sees it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace cprsim {

constexpr std::size_t kLargestMeshFile = 256U << 20U;  ///< bytes, of all files of a mesh together

/// Why the file is not even shown to assimp; empty if it may be. @param kind its extension
std::string refusal(const std::filesystem::path& path, const std::string& kind);

}  // namespace cprsim
