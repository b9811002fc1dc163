// SPDX-License-Identifier: BSD-3-Clause
// The outline of a rod's cross-section, for whoever sweeps it along the centreline.
#pragma once

#include <vector>

#include "engine/model/rod_spec.h"

namespace cprsim {

/// A point of the outline and its outward normal, in section axes.
struct OutlinePoint {
  Vec2 p, n;
};

/// Counter-clockwise seen from the tip, closed: the last point is the first. A section without size
/// is a circle of `radius`. @param sides of round outlines
std::vector<OutlinePoint> section_outline(const SectionSpec& section, double radius, int sides);

}  // namespace cprsim
