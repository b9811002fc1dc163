// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/names.h"

#include <algorithm>

namespace cprsim {

const char* mode_name(Mode mode) {
  switch (mode) {
    case Mode::kStatic:
      return "static";
    case Mode::kQuasistatic:
      return "quasistatic";
    case Mode::kDynamic:
      return "dynamic";
  }
  return "";
}

std::string pieces_text(const RodFacts& rod) {
  std::string text = std::string(method_name(rod.method)) + ", ";
  if (rod.method == Method::kShooting)
    return text + std::to_string(rod.elements) + " points of " + rod.rule;
  text += std::to_string(rod.elements) + (rod.elements == 1 ? " element of " : " elements of ");
  return text + rod.rule + " degree " + std::to_string(rod.order);
}

std::string pieces_text(const ProblemFacts& facts) {
  std::vector<std::string> kinds;
  std::string text;
  for (const RodFacts& rod : facts.rods) {
    const std::string kind = pieces_text(rod);
    if (std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) continue;
    text += (kinds.empty() ? "" : "; ") + kind;
    kinds.push_back(kind);
  }
  return kinds.empty() ? "no rods" : text;
}

std::string place_name(const Scene& scene, const Place& place) {
  if (!place.known() || place.file < 0) return {};
  return scene.files.at(static_cast<std::size_t>(place.file)) + ":" + std::to_string(place.line);
}

}  // namespace cprsim
