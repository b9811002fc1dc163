// SPDX-License-Identifier: BSD-3-Clause
#include "render/outline.h"

#include <cmath>
#include <numbers>

namespace cprsim {

namespace {

std::vector<OutlinePoint> ellipse(double a, double b, int sides) {
  std::vector<OutlinePoint> outline;
  for (int k = 0; k <= sides; ++k) {
    const double t = 2 * std::numbers::pi * k / sides, c = std::cos(t), s = std::sin(t);
    outline.push_back({{a * c, b * s}, Vec2(b * c, a * s).normalized()});
  }
  return outline;
}

std::vector<OutlinePoint> rectangle(double width, double height) {
  const double x = 0.5 * width, y = 0.5 * height;
  return {{{x, -y}, {1, 0}},   {{x, y}, {1, 0}},   {{x, y}, {0, 1}},
          {{-x, y}, {0, 1}},   {{-x, y}, {-1, 0}}, {{-x, -y}, {-1, 0}},
          {{-x, -y}, {0, -1}}, {{x, -y}, {0, -1}}, {{x, -y}, {1, 0}}};
}

}  // namespace

std::vector<OutlinePoint> section_outline(const SectionSpec& section, double radius, int sides) {
  const Vec2& size = section.size;
  const bool has_size = size.minCoeff() > 0;
  if (section.shape == SectionShape::kRectangle && has_size) return rectangle(size.x(), size.y());
  if (section.shape == SectionShape::kEllipse && has_size)
    return ellipse(size.x(), size.y(), sides);
  return ellipse(radius, radius, sides);
}

}  // namespace cprsim
