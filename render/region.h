// SPDX-License-Identifier: BSD-3-Clause
// The part of the picture that changes from frame to frame.
#pragma once

#include "render/camera.h"
#include "render/drawing.h"
#include "render/scenery.h"

namespace cprsim {

/// Pixels x0 <= x < x1, y0 <= y < y1, origin at the lower left corner.
struct Region {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return x1 - x0; }

  int height() const { return y1 - y0; }

  bool empty() const { return x1 <= x0 || y1 <= y0; }
};

/// Where moving things and their shadows on the ground, and all between, may be seen.
/// @param softness  metres by which a shadow is wider than what throws it
Region moving_region(const std::vector<Part>& parts, const Drawing& drawing, const View& view,
                     const Lighting& light, const Backdrop& backdrop, double softness);

}  // namespace cprsim
