// SPDX-License-Identifier: BSD-3-Clause
// A shape that a rod is to start in: the cubic spline through points of its centreline, with
// sections that turn no more about the tangent than they must to meet both ends.
#pragma once

#include <vector>

#include "engine/math/types.h"
#include "engine/model/profile.h"
#include "engine/model/rod_spec.h"

namespace cprsim {

class RodCurve {
 public:
  /// @param samples at least four, s from 0 to 1
  /// @param R_WBase the section at the base is this one, turned by the least angle that brings its
  /// z axis to the tangent
  /// @param R_WTip of a rod that is twisted until its tip has these axes; null: not twisted at all
  RodCurve(const std::vector<CurveSample>& samples, double length, const Mat3& R_WBase,
           const Mat3* R_WTip);

  /// @param s fraction of the length
  Pose pose(double s) const;

  /// Rate of turning along the rod, section axes, 1/m.
  Vec3 curvature(double s) const;

 private:
  struct Point {
    Vec3 p, p_s, p_ss;  ///< with derivatives by s
  };

  Point at(double s) const;
  Mat3 untwisted(double s, const Vec3& tangent) const;

  double length_;
  Profile axes_[3];         ///< of s in place of time
  std::vector<Mat3> grid_;  ///< untwisted, at even steps of s
  double twist_ = 0;        ///< rad, from end to end
};

}  // namespace cprsim
