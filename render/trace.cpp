// SPDX-License-Identifier: BSD-3-Clause
#include "render/trace.h"

#include "render/renderer.h"

namespace cprsim {

std::optional<Channel> find_point(const Scene& scene, const std::string& channel) {
  for (const std::string& pattern : {channel, channel + ".position"}) {
    for (const Channel& found : find_channels(scene, pattern)) {
      if (found.quantity == Quantity::kPosition && found.index >= 0) return found;
    }
  }
  return std::nullopt;
}

std::optional<Vec3> point_now(const Scene& scene, const Snapshot& now, const Channel& point) {
  const auto i = static_cast<std::size_t>(point.index);
  switch (point.entity) {
    case ChannelEntity::kBody:
      if (i < now.bodies.size()) return now.bodies[i].X_WB.p;
      break;
    case ChannelEntity::kFrame: {
      if (i >= scene.frames.size()) break;
      const FrameRef& frame = scene.frames[i].at;
      const auto body = static_cast<std::size_t>(frame.body);
      if (frame.body >= 0 && body >= now.bodies.size()) break;
      return frame.body < 0 ? frame.X_BF.p : now.bodies[body].X_WB * frame.X_BF.p;
    }
    case ChannelEntity::kRodPoint:
      if (i < now.rods.size() && !now.rods[i].points.empty()) {
        return point_at(now.rods[i], point.s).position;
      }
      break;
    default:
      break;
  }
  return std::nullopt;
}

std::optional<Vec3> traced_point(const Scene& scene, const Snapshot& now,
                                 const std::string& channel) {
  const std::optional<Channel> point = find_point(scene, channel);
  return point ? point_now(scene, now, *point) : std::nullopt;
}

}  // namespace cprsim
