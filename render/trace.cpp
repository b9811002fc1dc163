// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "engine/model/channel.h"
#include "render/renderer.h"

namespace cprsim {

namespace {

std::optional<Vec3> place_of(const Scene& scene, const Snapshot& now, const Channel& channel) {
  const auto i = static_cast<std::size_t>(channel.index);
  switch (channel.entity) {
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
        return point_at(now.rods[i], channel.s).position;
      }
      break;
    default:
      break;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Vec3> traced_point(const Scene& scene, const Snapshot& now,
                                 const std::string& channel) {
  for (const Channel& found : find_channels(scene, channel)) {
    if (found.quantity == Quantity::kPosition && found.index >= 0) {
      return place_of(scene, now, found);
    }
  }
  return std::nullopt;
}

}  // namespace cprsim
