// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/channel_list.h"

#include <algorithm>

namespace cprsim {

bool glob_fits(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, mark = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      mark = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++mark;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*')
    ++p;
  return p == pattern.size();
}

bool selects_channel(std::string_view rest, std::string_view name) {
  if (glob_fits(rest, name)) return true;
  for (std::size_t dot = name.find('.'); dot != std::string_view::npos;
       dot = name.find('.', dot + 1))
    if (glob_fits(rest, name.substr(0, dot))) return true;
  return false;
}

int letters_apart(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

const char* unit_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::kPosition:
    case Quantity::kLength:
    case Quantity::kDisplacement:
    case Quantity::kContactPenetration:
    case Quantity::kContactGap:
      return "m";
    case Quantity::kLinearVelocity:
    case Quantity::kContactSlip:
      return "m/s";
    case Quantity::kAngularVelocity:
      return "rad/s";
    case Quantity::kForce:
    case Quantity::kTension:
    case Quantity::kContactForce:
    case Quantity::kContactFriction:
      return "N";
    case Quantity::kMoment:
      return "N m";
    case Quantity::kCurvature:
      return "1/m";
    case Quantity::kEnergyKinetic:
    case Quantity::kEnergyElastic:
    case Quantity::kEnergyGravity:
    case Quantity::kEnergyMagnetic:
    case Quantity::kEnergyDissipated:
    case Quantity::kEnergyWork:
    case Quantity::kEnergyTotal:
    case Quantity::kEnergyBalance:
      return "J";
    case Quantity::kSolverStep:
    case Quantity::kSolverWallTime:
      return "s";
    default:
      return "1";
  }
}

}  // namespace cprsim
