// SPDX-License-Identifier: BSD-3-Clause
// The scene as the command line wants it: the file, then what flags change in it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/loader/load.h"
#include "tools/cprsim/command_line.h"
#include "tools/cprsim/console.h"

namespace cprsim {

struct SceneOptions {
  std::vector<std::pair<std::string, std::string>> set;  ///< path and value
  std::vector<std::string> with, without;
  std::vector<std::string> resource_paths;
  std::optional<double> duration, step, accuracy;
  std::optional<std::string> method;
  std::optional<unsigned> seed;
  bool strict = false;  ///< warnings are errors
  bool lax = false;     ///< parts that would change the motion and are not supported are warnings
};

/// A scene that may be simulated, or none; either way what there was to say about it.
struct LoadedScene {
  std::unique_ptr<Scene> scene;
  std::vector<Diagnostic> diagnostics;
  std::string expected_failure;  ///< code with which the scene says it is to be rejected

  /// It was to be rejected, and is, with that code.
  bool rejected_as_expected() const;
};

void add_scene_options(CommandLine& line, SceneOptions& options);

/// What the options ask of the loader, with the folders that the environment names.
LoadOptions load_options(const SceneOptions& options);

/// --strict: warnings become errors.
void make_strict(std::vector<Diagnostic>& diagnostics, const SceneOptions& options);

/// Reads the file (standard input for "-"), applies the options and shows what there is to say.
LoadedScene load_and_show(const std::string& path, const SceneOptions& options,
                          const Console& console);

/// What was given, as name and value, for run.json.
std::vector<std::pair<std::string, std::string>> given(const SceneOptions& options);

/// What a scene is called where it needs a short name: the file's stem, or the world's name for
/// "-".
std::string label_of(const std::string& path, const Scene& scene);

}  // namespace cprsim
