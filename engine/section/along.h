// SPDX-License-Identifier: BSD-3-Clause
// What varies along a rod: the dimensions of its sections, linear between those that the scene
// gives, with a step where two stand at one place; and its rest curvature, the natural cubic spline
// through samples. A rod that is the same all along has none of this.
#pragma once

#include <vector>

#include "engine/model/rest_shape.h"
#include "engine/section/section.h"

namespace cprsim {

class SectionsAlong {
 public:
  /// @param immersed whether the rod's <drag> counts.
  SectionsAlong(const RodSpec& rod, bool immersed);

  /// Whether it is needed.
  static bool varies(const RodSpec& rod) {
    return rod.sections.size() > 1 || !rod.rest_samples.empty();
  }

  /// At s, a fraction of the length; where s is a step, on the side of `inside`.
  SectionProperties at(double s, double inside) const;

  Vec3 rest_curvature(double s) const { return rest_.curvature(s); }

  /// The unloaded rod: section s as seen from the base.
  Pose unloaded(double s, double length) const { return rest_.unloaded(s, length); }

  bool bent_at_rest() const {
    return !spec_.rest_samples.empty() || !spec_.rest_curvature.isZero();
  }

  /// Turn of the unloaded rod from end to end, rad.
  double turn(double length) const { return rest_.turn(length); }

  /// Where sections are not smooth, fractions of the length within (0, 1).
  const std::vector<double>& breaks() const { return breaks_; }

 private:
  RodSpec spec_;
  bool immersed_ = false;
  std::vector<double> breaks_;
  RestShape rest_;
};

}  // namespace cprsim
