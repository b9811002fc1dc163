// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/rod_curve.h"

#include <algorithm>
#include <cmath>

#include "engine/math/so3.h"

namespace cprsim {
namespace {

/// Slope at the first of four keys of the cubic through them.
double slope_of_cubic(const double* t, const double* x) {
  double slope = 0;
  for (int i = 0; i < 4; ++i) {
    // derivative of Lagrange's i-th polynomial at t[0]
    double of_i = i == 0 ? 0 : 1 / (t[i] - t[0]);
    for (int k = 1; k < 4; ++k) {
      if (i == 0)
        of_i += 1 / (t[0] - t[k]);
      else if (k != i)
        of_i *= (t[0] - t[k]) / (t[i] - t[k]);
    }
    slope += of_i * x[i];
  }
  return slope;
}

EndSlopes end_slopes(const ProfileTerm& term) {
  const std::size_t n = term.times.size();
  double t[4], x[4];
  for (std::size_t i = 0; i < 4; ++i) {
    t[i] = term.times[n - 1 - i];
    x[i] = term.values[n - 1 - i];
  }
  return {slope_of_cubic(term.times.data(), term.values.data()), slope_of_cubic(t, x)};
}

}  // namespace

RodCurve::RodCurve(const std::vector<CurveSample>& samples, double length, const Mat3& R_WBase,
                   const Mat3* R_WTip)
    : length_(length) {
  for (int axis = 0; axis < 3; ++axis) {
    ProfileTerm term;
    term.shape = ShapeOfTime::kKeyframes;
    term.interpolation = Interpolation::kCubic;
    for (const CurveSample& sample : samples) {
      term.times.push_back(sample.s);
      term.values.push_back(sample.position[axis]);
    }
    const EndSlopes ends = end_slopes(term);
    finish_keyframes(term, &ends);
    axes_[axis].terms.push_back(std::move(term));
  }
  // steps short enough that turning from tangent to tangent by the least angle is parallel
  // transport
  constexpr std::size_t kStepsPerSample = 8;
  const std::size_t steps = kStepsPerSample * samples.size();
  grid_.push_back(rotation_between(R_WBase.col(2), at(0).p_s.normalized()) * R_WBase);
  for (std::size_t i = 1; i <= steps; ++i) {
    const Mat3& last = grid_.back();
    const Vec3 next = at(static_cast<double>(i) / static_cast<double>(steps)).p_s.normalized();
    grid_.push_back(orthonormalized(rotation_between(last.col(2), next) * last));
  }
  if (!R_WTip) return;
  const Mat3 tip = rotation_between(R_WTip->col(2), grid_.back().col(2)) * *R_WTip;
  const Vec3 x = grid_.back().transpose() * tip.col(0);
  twist_ = std::atan2(x.y(), x.x());
}

RodCurve::Point RodCurve::at(double s) const {
  Point point;
  for (int axis = 0; axis < 3; ++axis) {
    // keyframes are constant outside: at the tip what counts is the side of the rod
    const ProfileValue of = axes_[axis].evaluate(s, s > 0.5);
    point.p[axis] = of.value;
    point.p_s[axis] = of.rate;
    point.p_ss[axis] = of.acceleration;
  }
  return point;
}

Mat3 RodCurve::untwisted(double s, const Vec3& tangent) const {
  const double place = std::clamp(s, 0.0, 1.0) * static_cast<double>(grid_.size() - 1);
  const Mat3& near = grid_[static_cast<std::size_t>(place)];
  return rotation_between(near.col(2), tangent) * near;
}

Pose RodCurve::pose(double s) const {
  const Point point = at(s);
  return {untwisted(s, point.p_s.normalized()) * exp_so3({0, 0, twist_ * s}), point.p};
}

Vec3 RodCurve::curvature(double s) const {
  const Point point = at(s);
  const Vec3 turning = point.p_s.cross(point.p_ss) / point.p_s.squaredNorm();
  return (pose(s).R.transpose() * turning + twist_ * Vec3::UnitZ()) / length_;
}

}  // namespace cprsim
