// SPDX-License-Identifier: BSD-3-Clause
// Points in a plane as an SVG picture: groups of one colour each, equal scales, axes with units,
// legend.
#pragma once

#include <string>
#include <vector>

#include "engine/math/types.h"

namespace cprsim {

struct ScatterGroup {
  std::string name;   ///< in the legend, with the number of points
  std::string color;  ///< as SVG writes it, e.g. #0072b2
  std::vector<Vec2> points;
};

struct Scatter {
  std::string title;
  std::string x_label, y_label;      ///< with units
  std::vector<ScatterGroup> groups;  ///< later ones are drawn over earlier ones
  std::vector<std::string> notes;    ///< lines under the legend
};

/// The whole picture. The same text for the same numbers on every machine.
std::string to_svg(const Scatter& scatter);

}  // namespace cprsim
