// SPDX-License-Identifier: BSD-3-Clause
// Reading files without surprises, and finding the files that a scene names. Only what lies below
// the folder of the scene or one of the resource paths is ever opened.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace cprsim {

struct FileContent {
  std::string text;
  std::string code, message;  ///< code is empty on success
};

/// A regular file of at most 16 MiB. Never blocks on pipes or devices.
FileContent read_file(const std::string& path);

/// Standard input, with the same limit.
FileContent read_standard_input();

struct FoundFile {
  std::string path;  ///< canonical; empty if not found
  std::string root;  ///< the folder that allowed it
  std::string code, message;
  std::vector<std::string> tried;
};

/// Resolves `uri` as named in a file of folder `folder`: relative to it, then model://, package://
/// and file:// below each of `roots`. `folder` itself need not be a root; what is found must lie
/// below one.
/// @param wanted file inside a folder when the uri names a folder, e.g. model.sdf
FoundFile find_resource(const std::string& uri, const std::string& folder,
                        const std::vector<std::string>& roots, std::string_view wanted = {});

/// Folder of a path, "." if it has none.
std::string folder_of(const std::string& path);

}  // namespace cprsim
