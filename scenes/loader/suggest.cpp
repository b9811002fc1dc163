// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/suggest.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace cprsim {

namespace {

constexpr std::size_t kLongest = 256;  ///< longer words are nobody's typing mistake

using Pair = std::pair<std::string_view, std::string_view>;

constexpr Pair kSynonyms[] = {
    {"timestep", "max_step_size"},
    {"time_step", "max_step_size"},
    {"dt", "max_step_size"},
    {"E", "youngs_modulus"},
    {"young", "youngs_modulus"},
    {"young_modulus", "youngs_modulus"},
    {"elastic_modulus", "youngs_modulus"},
    {"G", "shear_modulus"},
    {"nu", "poisson_ratio"},
    {"poisson", "poisson_ratio"},
    {"poissons_ratio", "poisson_ratio"},
    {"rho", "density"},
    {"origin", "pose"},
    {"transform", "pose"},
    {"pos", "pose"},
    {"xform", "pose"},
    {"geom", "collision"},
    {"body", "link"},
    {"site", "frame"},
    {"rpy", "pose"},
    {"L", "length"},
    {"r", "radius"},
    {"color", "diffuse"},
    {"rgba", "diffuse"},
    {"motor", "cprsim:drive"},
    {"actuator", "cprsim:drive"},
    {"force", "cprsim:load"},
    {"section", "cross_section"},
    {"crosssection", "cross_section"},
    {"from", "base"},
    {"proximal", "base"},
    {"distal", "tip"},
    {"end", "tip"},
    {"time", "duration"},
    {"integrator", "time"},
    {"fov", "horizontal_fov"},
    {"target", "look_at"},
    {"position", "eye"},
    {"lookat", "look_at"},
    {"frequency", "rate"},
    {"stretch", "extension"},
    {"inertia", "rotary_inertia"},
    {"viscosity", "damping"},
    {"moment", "torque"},
};

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  if (a.size() > kLongest || b.size() > kLongest) return static_cast<int>(kLongest);
  const std::size_t width = b.size() + 1;
  std::vector<int> before(width), previous(width), current(width);
  for (std::size_t j = 0; j < width; ++j)
    previous[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < width; ++j) {
      const int cost = a[i - 1] == b[j - 1] ? 0 : 1;
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, previous[j - 1] + cost});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        current[j] = std::min(current[j], before[j - 2] + 1);
    }
    std::swap(before, previous);
    std::swap(previous, current);
  }
  return previous[width - 1];
}

std::string_view synonym(std::string_view word) {
  for (const auto& [typed, meant] : kSynonyms)
    if (typed == word) return meant;
  return {};
}

std::string nearest_name(std::string_view word, const std::vector<std::string>& names) {
  const auto contains = [&](std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  // a prefix forgotten, or one too many
  const std::string prefixed = "cprsim:" + std::string(word);
  if (contains(prefixed)) return prefixed;
  if (word.substr(0, 7) == "cprsim:" && contains(word.substr(7)))
    return std::string(word.substr(7));
  if (const std::string_view meant = synonym(word); !meant.empty() && contains(meant))
    return std::string(meant);

  std::string best;
  int best_distance = word.size() <= 3 ? 2 : 3;
  for (const std::string& name : names) {
    const int distance = edit_distance(word, name);
    if (distance < best_distance) {
      best = name;
      best_distance = distance;
    }
  }
  return best;
}

}  // namespace cprsim
