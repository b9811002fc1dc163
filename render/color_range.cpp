// SPDX-License-Identifier: BSD-3-Clause
#include "render/color_range.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/drawing.h"

namespace cprsim {

namespace {

constexpr double kGlide = 0.4;  // s; shorter looks like a jump, longer leaves values out of range

double bending_stiffness(const RodSpec& rod) {
  if (rod.stiffness.bending_x) return *rod.stiffness.bending_x;
  const double r = rod.section.size.x();
  return rod.material ? rod.material->youngs_modulus * 0.25 * std::numbers::pi * r * r * r * r : 0;
}

}  // namespace

double typical_value(ColorBy by, const Scene& scene) {
  double largest = 0;
  for (const RodSpec& rod : scene.rods) {
    if (!(rod.length > 0)) continue;
    const double u = 1 / rod.length, EI = bending_stiffness(rod);
    const double value = by == ColorBy::kCurvature       ? u
                         : by == ColorBy::kBendingMoment ? EI * u
                         : by == ColorBy::kTension       ? EI * u * u
                                                         : 0.5 * EI * u * u;
    largest = std::max(largest, value);
  }
  return largest > 0 && std::isfinite(largest) ? largest : 1;
}

Vec2 SteadyRange::next(const Snapshot& now, double film_time) {
  const double largest = largest_value(by_, now);
  if (to_ == 0) {
    const double typical = typical_value(by_, scene_);
    from_ = to_ = nice_ceiling(largest > 0.01 * typical ? 1.5 * largest : 0.5 * typical);
  }
  const double t = std::clamp((film_time - since_) / kGlide, 0.0, 1.0);
  const double shown = from_ + (to_ - from_) * t * t * (3 - 2 * t);
  if (largest > to_) {
    from_ = shown;
    to_ = nice_ceiling(1.02 * largest);
    since_ = film_time;
  }
  return {is_signed(by_) ? -shown : 0, shown};
}

}  // namespace cprsim
