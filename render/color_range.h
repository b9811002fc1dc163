// SPDX-License-Identifier: BSD-3-Clause
// A colour range that stays put through a film whose largest value is not known beforehand.
#pragma once

#include "engine/model/scene.h"
#include "engine/run/snapshot.h"

namespace cprsim {

/// Starts at half as much again as the first frame's largest value, rounded up to a number of 1,
/// 2, 5. It never shrinks, and grows only when a value exceeds it: then to the next such number,
/// gliding there within 0.4 s of film, so that colours never jump.
class SteadyRange {
 public:
  SteadyRange(const Scene& scene, ColorBy by) : scene_(scene), by_(by) {}

  /// The range for the next frame. @param film_time  seconds of film, ascending
  Vec2 next(const Snapshot& now, double film_time);

 private:
  const Scene& scene_;
  ColorBy by_;
  double from_ = 0, to_ = 0;  ///< upper ends the range glides between
  double since_ = 0;
};

/// A value to expect of a robot of which no rod is loaded yet: bent by one radian over its length.
double typical_value(ColorBy by, const Scene& scene);

}  // namespace cprsim
