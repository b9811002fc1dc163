// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/tendon_spec.h"

#include <cmath>
#include <numbers>

namespace cprsim {

TendonOffset tendon_offset(const TendonSpec& tendon, double s, double inside) {
  if (tendon.route == TendonRoute::kPoints) {
    const std::vector<Vec3>& points = tendon.points;
    std::size_t k = 0;
    while (k + 2 < points.size() && points[k + 1].x() <= inside)
      ++k;
    const Vec3 step = points[k + 1] - points[k];
    const Vec2 slope = step.tail<2>() / step.x();
    return {points[k].tail<2>() + (s - points[k].x()) * slope, slope};
  }
  const double winding =
      tendon.route == TendonRoute::kHelical ? 2 * std::numbers::pi * tendon.turns : 0;
  const double angle = tendon.angle + winding * s;
  const Vec2 out(std::cos(angle), std::sin(angle)), around(-out.y(), out.x());
  return {tendon.radius * out, tendon.radius * winding * around};
}

}  // namespace cprsim
