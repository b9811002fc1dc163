// SPDX-License-Identifier: BSD-3-Clause
// From a scene file to a Scene, or to all the reasons why not.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/loader/diagnostic.h"

namespace cprsim {

struct LoadOptions {
  std::vector<std::string> resource_paths;  ///< folders for model://, package:// and relative names
  std::vector<std::pair<std::string, std::string>> set;  ///< --set PATH=VALUE
  std::vector<std::string> get;  ///< paths whose values are asked for, see LoadResult::got
  std::vector<std::string> with, without;  ///< effects switched on and off
  bool lax = false;  ///< SDF elements that cannot be carried out: warning instead of error
  std::optional<double> duration, step, accuracy;
  std::optional<std::string> method;
};

struct LoadResult {
  std::unique_ptr<Scene> scene;  ///< null if there is any error
  std::vector<Diagnostic> diagnostics;
  std::vector<std::string> got;  ///< texts at LoadOptions::get, after all changes
  std::string
      expected_failure;  ///< code of <fails with="E..."/>: the scene is meant to be rejected
};

/// @param path a file, or "-" for standard input, which is then called <stdin>.
LoadResult load_scene(const std::string& path, const LoadOptions& options = {});

/// The same from memory; `name` stands for the file in messages, its folder is where includes are
/// looked for.
LoadResult load_scene_text(std::string_view text, const std::string& name,
                           const LoadOptions& options = {});

/// Folders named by CPRSIM_RESOURCE_PATH, GZ_SIM_RESOURCE_PATH and SDF_PATH.
std::vector<std::string> environment_resource_paths();

}  // namespace cprsim
