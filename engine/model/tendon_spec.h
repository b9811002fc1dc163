// SPDX-License-Identifier: BSD-3-Clause
// A tendon as the scene describes it: a thin cable without mass that runs along a rod in channels
// or through eyelets fixed to its sections, held by a motor at the base and fastened to the section
// where it ends.
#pragma once

#include <string>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/place.h"

namespace cprsim {

enum class TendonRoute { kParallel, kHelical, kPoints };

struct TendonSpec {
  std::string name;  ///< scoped
  Place place;
  int rod = -1;  ///< index into Scene::rods
  TendonRoute route = TendonRoute::kParallel;
  double radius = 0;  ///< m, distance from the centreline
  double angle = 0;   ///< rad, about the tangent from the section's x axis; helical: at the base
  double turns = 0;   ///< helical: about the tangent from base to tip, positive right-handed
  std::vector<Vec3> points;  ///< kPoints: (s / length, x, y), s ascending; straight in between
  double termination = 1;    ///< s / length of the section to which it is fastened
  double friction = 0;       ///< coefficient against its channel; acts if the effect is listed
};

/// Where a tendon runs and in which direction, section axes.
struct TendonOffset {
  Vec2 r, r_s;  ///< m, and by the fraction of the length
};

/// At the fraction s. @param inside a fraction in the interior of the straight piece to which s
/// belongs: at a bend there are two slopes.
TendonOffset tendon_offset(const TendonSpec& tendon, double s, double inside);

}  // namespace cprsim
