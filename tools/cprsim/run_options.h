// SPDX-License-Identifier: BSD-3-Clause
// What `cprsim run` may be told.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "tools/cprsim/scene_options.h"

namespace cprsim {

/// --still FILE[@time]
struct StillOption {
  std::string file;
  std::optional<double> time;
};

/// "shot.png@0.5" in two; an @ that no number follows belongs to the name.
StillOption to_still(const std::string& text);

struct RunOptions {
  ConsoleOptions console;
  SceneOptions scene;
  std::string path;
  std::string output;
  std::string video;  ///< empty: as the scene says
  bool no_video = false, no_record = false;
  std::vector<StillOption> stills;
  std::optional<double> max_wall;
  std::optional<double> real_time_factor;
  std::string from;  ///< a state file; empty: from the start
  std::optional<double> checkpoint_every;
  bool hash = false;
  bool profile = false;
  std::string trace;  ///< a file; empty: none
  int jobs = 0;       ///< 0: no limit

  /// What changes the result, for run.json.
  std::vector<std::pair<std::string, std::string>> given() const;
};

/// The options, or the exit code with which parsing ended.
std::variant<RunOptions, int> parse_run_options(const Words& words);

}  // namespace cprsim
