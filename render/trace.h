// SPDX-License-Identifier: BSD-3-Clause
// The points whose paths a film shows.
#pragma once

#include <optional>
#include <string>

#include "engine/model/channel.h"
#include "engine/model/scene.h"
#include "engine/run/snapshot.h"

namespace cprsim {

/// The point that a position channel (or its stem, robot::platform) names.
std::optional<Channel> find_point(const Scene& scene, const std::string& channel);

/// Where it is.
std::optional<Vec3> point_now(const Scene& scene, const Snapshot& now, const Channel& point);

}  // namespace cprsim
