// SPDX-License-Identifier: BSD-3-Clause
// <include> replaced by the model of the file it names, with the name, pose and flags given here.
#pragma once

#include <string>
#include <vector>

#include "scenes/loader/document.h"

namespace cprsim {

class Reporter;

struct IncludeContext {
  Reporter& report;
  std::vector<std::string> roots;
  std::vector<std::string> folders;  ///< of each file of the reporter
  std::vector<std::string> paths;    ///< canonical path of each file, empty for text in memory
};

/// Expands all includes below `node`. `open` lists the files being read, outermost first.
void expand_includes(Node& node, IncludeContext& context, std::vector<std::string> open);

/// The root element checked: an <sdf> of a known version. Reports otherwise.
bool check_root(const Node& root, Reporter& report);

}  // namespace cprsim
