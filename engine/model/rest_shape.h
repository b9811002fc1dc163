// SPDX-License-Identifier: BSD-3-Clause
// The shape of a rod without load: its rest curvature, constant or the natural cubic spline through
// samples, and where that leads from its base.
#pragma once

#include "engine/model/profile.h"
#include "engine/model/rod_spec.h"

namespace cprsim {

class RestShape {
 public:
  explicit RestShape(const RodSpec& rod);

  /// @param s fraction of the length
  Vec3 curvature(double s) const;

  /// Section s as seen from the base, for curvatures that vary to some 1e-6 of the length.
  Pose unloaded(double s, double length) const;

  /// Turn from end to end, rad.
  double turn(double length) const;

 private:
  bool varies_;
  Vec3 constant_;
  Profile axes_[3];  ///< of s in place of time
};

}  // namespace cprsim
