// SPDX-License-Identifier: BSD-3-Clause
// What `cprsim identify` may be told.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tools/cprsim/scene_options.h"

namespace cprsim {

/// --fit PATH[,PATH...][=START[:LOW:HIGH]]
struct FitOption {
  std::vector<std::string> paths;  ///< all get the same value
  std::optional<double> start;     ///< none: what the scene says at the first path
  std::optional<double> low, high;

  std::string name() const;
};

struct IdentifyOptions {
  ConsoleOptions console;
  SceneOptions scene;
  std::string path, data, output;
  std::vector<FitOption> fit;
  std::vector<std::string> input, match, sigma;  ///< COLUMN=...; where to split, the table decides
  double level = 0.95;
  int max_iterations = 100;
  bool no_plot = false;
};

/// The options, or the exit code with which parsing ended.
std::variant<IdentifyOptions, int> parse_identify_options(const Words& words);

/// "a/length,b/length=0.35:0.2:0.6" or the reason why not.
std::variant<FitOption, std::string> parse_fit_option(const std::string& text);

}  // namespace cprsim
