// SPDX-License-Identifier: BSD-3-Clause
// What an observer sees of a rod: points along it with pose, motion, wrench and strain. Plain data.
#pragma once

#include <vector>

#include "engine/math/types.h"

namespace cprsim {

/// One point of a rod. The internal wrench is what the part beyond s exerts on the part before s.
struct RodPoint {
  double s = 0;  ///< fraction of the length, 0 base .. 1 tip
  Vec3 position{0, 0, 0};
  Mat3 rotation = Mat3::Identity();                 ///< section to world, z = tangent
  Vec3 velocity{0, 0, 0};                           ///< at fixed s, world axes
  Vec3 force{0, 0, 0}, moment{0, 0, 0};             ///< n, m, world axes
  Vec3 curvature{0, 0, 0}, shear_stretch{0, 0, 1};  ///< u, v, section axes
  Vec3 rest_curvature{0, 0, 0};                     ///< u without load
};

/// A tendon at its motor: what it pulls with, and how much shorter its way along the rod is than
/// along the unloaded one.
struct TendonSample {
  double tension = 0, displacement = 0;  ///< N, m
  double end_tension = 0;                ///< N, where it is fastened
  double rate = 0;                       ///< of the displacement, m/s
  /// With friction, of every section that it passes: its tension over that at the motor, and by how
  /// much its way there is shorter than along the unloaded rod (m).
  std::vector<Vec2> along = {};
};

struct RodSample {
  double length = 0;
  double radius = 0;             ///< half the section's largest dimension, for drawing
  std::vector<RodPoint> points;  ///< base → tip, s ascending, first s = 0 and last s = 1
};

}  // namespace cprsim
