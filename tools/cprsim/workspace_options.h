// SPDX-License-Identifier: BSD-3-Clause
// What `cprsim workspace` may be told, and what that means for a scene.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "engine/study/workspace.h"
#include "tools/cprsim/scene_options.h"

namespace cprsim {

/// NAME[=LOW:HIGH[:COUNT]]
struct VaryOption {
  std::string name;
  std::optional<double> low, high;
  std::optional<int> count;
};

/// [NAME=]NUMBER
struct NumberOption {
  std::string name;  ///< empty: of all
  std::optional<double> value;
};

struct WorkspaceOptions {
  ConsoleOptions console;
  SceneOptions scene;
  std::string path;
  std::string output;
  std::vector<VaryOption> vary;
  std::vector<std::string> drives;  ///< undriven rods whose lengths are drives, too
  std::string pose;                 ///< frame to be brought to poses
  std::string frame;                ///< frame whose pose is told
  std::vector<NumberOption> hold;   ///< freedoms; "none"
  std::vector<NumberOption> max_effort;
  std::string view;  ///< xy, xz, yz; empty: the widest
  int random = 0;    ///< 0: a grid
  int jobs = 0;      ///< 0: all cores
  bool resume = false;

  /// What changes the result, as name and value.
  std::vector<std::pair<std::string, std::string>> given() const;
};

/// The options, or the exit code with which parsing ended.
std::variant<WorkspaceOptions, int> parse_workspace_options(const Words& words);

/// A question that can be answered.
struct WorkspaceTask {
  Scene scene;  ///< with the drives that were added
  WorkspaceQuestion question;
  std::vector<Parameter> drives;  ///< of the scene
  std::string frame_name;
  std::vector<std::vector<double>> points;
};

/// Names looked up, limits of joints put in where no range was given. @throws UsageError
WorkspaceTask make_task(const Scene& scene, const WorkspaceOptions& options);

}  // namespace cprsim
