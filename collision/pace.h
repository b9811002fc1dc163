// SPDX-License-Identifier: BSD-3-Clause
// How many substeps a step needs: a body that may reach something within the step must not come
// closer in one substep than half the distance at which Bullet takes notice (2 % of the smaller
// one's size), so that contacts are found before surfaces meet; a spinning one must not turn by
// more than 1/50 rad.
#pragma once

#include <vector>

#include "engine/math/types.h"

namespace cprsim {

/// A free body as a sphere.
struct Mover {
  Vec3 centre = Vec3::Zero();
  double radius = 0;
  double speed = 0, spin = 0, acceleration = 0;
  bool touches = true;
};

/// Something that does not care: a box along the world axes, or all that is below a plane.
struct Barrier {
  bool is_plane = false;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  double level = 0;
  double speed = 0;
};

/// @param notice distance at which the contacts of the smallest shape are found; all in the same
/// units.
int count_substeps(double step, const std::vector<Mover>& movers,
                   const std::vector<Barrier>& barriers, double notice);

}  // namespace cprsim
