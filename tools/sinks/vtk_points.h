// SPDX-License-Identifier: BSD-3-Clause
// Points with numbers as VTK PolyData XML, for ParaView's Glyph filter and the like.
#pragma once

#include <string>
#include <vector>

#include "engine/math/types.h"

namespace cprsim {

struct PointArray {
  std::string name;
  std::vector<double> values;  ///< for each point as many as there are components
  int components = 1;
};

/// One vertex per point; numbers are text that reads back exactly.
std::string to_points_vtp(const std::vector<Vec3>& positions,
                          const std::vector<PointArray>& arrays);

}  // namespace cprsim
