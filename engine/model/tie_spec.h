// SPDX-License-Identifier: BSD-3-Clause
// Rods side by side that are tied together at points: bundles, sleeves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/place.h"

namespace cprsim {

/// The k-th point holds the centreline of the second rod at other_s[k] where an arm ends that is
/// fastened to the first rod's section at s[k]. Both turn freely about that point.
struct TieSpec {
  std::string name;  ///< scoped
  Place place;
  int rod = -1, other = -1;        ///< indices into Scene::rods
  std::vector<double> s, other_s;  ///< fractions of the lengths, above 0
  std::optional<Vec3> offset;      ///< the arm, m, section axes; as the unloaded rods lie if absent
};

}  // namespace cprsim
