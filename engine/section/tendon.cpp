// SPDX-License-Identifier: BSD-3-Clause
#include "engine/section/tendon.h"

#include <algorithm>

namespace cprsim {

TendonPlace Tendon::at(double s, double inside, double length) const {
  const TendonOffset offset = tendon_offset(spec_, s, inside);
  const Vec2 r_s = offset.r_s / length;
  TendonPlace place;
  place.there = inside < spec_.termination;
  std::copy_n(offset.r.data(), 2, place.r);
  std::copy_n(r_s.data(), 2, place.r_s);
  return place;
}

std::vector<double> Tendon::breaks() const {
  std::vector<double> s;
  for (const Vec3& point : spec_.points)
    if (point.x() > 0 && point.x() < spec_.termination) s.push_back(point.x());
  if (spec_.termination < 1) s.push_back(spec_.termination);
  return s;
}

}  // namespace cprsim
