// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/scene_options.h"

#include <algorithm>
#include <filesystem>

#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

bool positive(double value) {
  return value > 0;
}

}  // namespace

void add_scene_options(CommandLine& line, SceneOptions& options) {
  line.each("--set", "PATH=VALUE", "Change a value, e.g. robot::leg_1/length=0.42",
            [&options](const std::string& text) {
              const std::size_t equals = text.find('=');
              if (equals == std::string::npos || equals == 0)
                throw UsageError("'" + text + "' is not of the form PATH=VALUE");
              options.set.emplace_back(text.substr(0, equals), text.substr(equals + 1));
            });
  line.list("--with", options.with, "EFFECTS", "Effects to add, separated by commas");
  line.list("--without", options.without, "EFFECTS", "Effects to leave out");
  line.number("--duration", options.duration, "Simulate this many seconds", "greater than 0",
              positive);
  line.number("--step", options.step, "Fixed time step in seconds", "greater than 0", positive);
  line.number("--accuracy", options.accuracy, "Error of links and rods asked for, in metres",
              "greater than 0", positive);
  line.one("--method", "WHICH", "How rods are solved, as in <cprsim:solver method>",
           [&options](const std::string& word) { options.method = word; });
  line.one("--seed", "N", "Seed of everything random", [&options](const std::string& text) {
    options.seed = whole_number(text);
    if (!options.seed) throw UsageError("'" + text + "' is not a whole number");
  });
  line.texts("--resource-path", options.resource_paths, "DIR",
             "Where model:// and meshes are found");
  line.flag("--strict", options.strict, "Warnings are errors");
  line.flag("--lax", options.lax, "Unsupported parts of SDF are warnings");
  line.exclude("--lax", "--strict");
}

bool LoadedScene::rejected_as_expected() const {
  return scene == nullptr && !expected_failure.empty() &&
         std::any_of(diagnostics.begin(), diagnostics.end(), [&](const Diagnostic& d) {
           return d.severity == Severity::kError && d.code == expected_failure;
         });
}

LoadOptions load_options(const SceneOptions& options) {
  LoadOptions load;
  load.resource_paths = options.resource_paths;
  for (std::string& folder : environment_resource_paths()) {
    load.resource_paths.push_back(std::move(folder));
  }
  load.set = options.set;
  load.with = options.with;
  load.without = options.without;
  load.lax = options.lax;
  load.duration = options.duration;
  load.step = options.step;
  load.accuracy = options.accuracy;
  load.method = options.method;
  return load;
}

void make_strict(std::vector<Diagnostic>& diagnostics, const SceneOptions& options) {
  if (!options.strict) return;
  for (Diagnostic& d : diagnostics) {
    if (d.severity == Severity::kWarning) d.severity = Severity::kError;
  }
}

LoadedScene load_and_show(const std::string& path, const SceneOptions& options,
                          const Console& console) {
  LoadResult result = load_scene(path, load_options(options));
  make_strict(result.diagnostics, options);
  if (has_errors(result.diagnostics)) result.scene.reset();
  if (result.scene && options.seed) result.scene->simulation.seed = *options.seed;
  console.show(result.diagnostics);
  return {std::move(result.scene), std::move(result.diagnostics),
          std::move(result.expected_failure)};
}

std::vector<std::pair<std::string, std::string>> given(const SceneOptions& options) {
  std::vector<std::pair<std::string, std::string>> list;
  for (const auto& [path, value] : options.set)
    list.emplace_back("--set", path + "=" + value);
  for (const std::string& effect : options.with)
    list.emplace_back("--with", effect);
  for (const std::string& effect : options.without)
    list.emplace_back("--without", effect);
  if (options.duration) list.emplace_back("--duration", shortest(*options.duration));
  if (options.step) list.emplace_back("--step", shortest(*options.step));
  if (options.accuracy) list.emplace_back("--accuracy", shortest(*options.accuracy));
  if (options.method) list.emplace_back("--method", *options.method);
  if (options.seed) list.emplace_back("--seed", std::to_string(*options.seed));
  if (options.strict) list.emplace_back("--strict", "");
  if (options.lax) list.emplace_back("--lax", "");
  return list;
}

std::string label_of(const std::string& path, const Scene& scene) {
  return path == "-" ? scene.name : std::filesystem::path(path).stem().string();
}

}  // namespace cprsim
