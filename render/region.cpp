// SPDX-License-Identifier: BSD-3-Clause
#include "render/region.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cprsim {

namespace {

/// Collects the rectangle of what is seen of points with a margin about them.
class Outline {
 public:
  Outline(const View& view, const Lighting& light, const Backdrop& backdrop, double softness)
      : view_(view), light_(light), backdrop_(backdrop), softness_(softness) {}

  void add(const Vec3& p, double margin) {
    add_seen(p, margin);
    // a shadow falls along the key light onto the ground; everything between lies between in the
    // picture
    const double above = p.z() - backdrop_.ground_z, down = light_.to_key.z();
    if (!light_.shadows || above <= 0) return;
    if (down < 0.02) {
      everything_ = true;
    } else {
      add_seen(p - light_.to_key * (above / down), margin / down + softness_);
    }
  }

  Region region() const {
    if (everything_) return {0, 0, view_.width, view_.height};
    const auto clamped = [](double v, int top) {
      return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(top)));
    };
    return {clamped(std::floor(low_.x()) - 4, view_.width),
            clamped(std::floor(low_.y()) - 4, view_.height),
            clamped(std::ceil(high_.x()) + 4, view_.width),
            clamped(std::ceil(high_.y()) + 4, view_.height)};
  }

 private:
  void add_seen(const Vec3& p, double margin) {
    if (-view_.to_camera(p).z() < view_.near + margin || !p.allFinite()) {
      everything_ = true;
      return;
    }
    const Vec2 at = view_.to_pixel(p);
    // near the edge of a wide picture a ball is seen wider than in the middle: hence the factor
    const Vec2 reach = Vec2::Constant(1.5 * margin / view_.pixel_size(p) + 1);
    low_ = low_.cwiseMin(at - reach);
    high_ = high_.cwiseMax(at + reach);
  }

  const View& view_;
  const Lighting& light_;
  const Backdrop& backdrop_;
  double softness_;
  bool everything_ = false;
  Vec2 low_ = Vec2::Constant(std::numeric_limits<double>::max());
  Vec2 high_ = Vec2::Constant(std::numeric_limits<double>::lowest());
};

}  // namespace

Region moving_region(const std::vector<Part>& parts, const Drawing& drawing, const View& view,
                     const Lighting& light, const Backdrop& backdrop, double softness) {
  Outline outline(view, light, backdrop, softness);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!parts[i].moves && parts[i].look.opacity >= 1) continue;
    for (const Vec3& corner : parts[i].corners)
      outline.add(drawing.part_poses[i] * corner, 0);
  }
  for (const Tube& tube : drawing.tubes) {
    for (const Tube::Ring& ring : tube.rings)
      outline.add(ring.position, tube.radius);
  }
  for (const Ribbon& ribbon : drawing.ribbons) {
    for (const Ribbon::Point& point : ribbon.points)
      outline.add(point.position, 0);
  }
  return outline.region();
}

}  // namespace cprsim
