// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/rest_shape.h"

#include "engine/math/so3.h"

namespace cprsim {
namespace {

constexpr int kSteps = 400;

}  // namespace

RestShape::RestShape(const RodSpec& rod)
    : varies_(!rod.rest_samples.empty()), constant_(rod.rest_curvature) {
  for (int i = 0; i < 3 && varies_; ++i) {
    ProfileTerm term;
    term.shape = ShapeOfTime::kKeyframes;
    term.interpolation = Interpolation::kCubic;
    for (const RestSample& sample : rod.rest_samples) {
      term.times.push_back(sample.s);
      term.values.push_back(sample.curvature[i]);
    }
    finish_keyframes(term);
    axes_[i].terms.push_back(term);
  }
}

Vec3 RestShape::curvature(double s) const {
  if (!varies_) return constant_;
  return {axes_[0].evaluate(s).value, axes_[1].evaluate(s).value, axes_[2].evaluate(s).value};
}

Pose RestShape::unloaded(double s, double length) const {
  Pose X;
  const int steps = varies_ ? kSteps : 1;
  const double h = s * length / steps;
  for (int k = 0; k < steps && s > 0; ++k) {
    const Vec3 turn = h * curvature(s * (k + 0.5) / steps);
    X.p += X.R * (h * right_jacobian(-turn).col(2));
    X.R = X.R * exp_so3(turn);
  }
  return X;
}

double RestShape::turn(double length) const {
  double sum = 0;
  for (int k = 0; k < kSteps; ++k)
    sum += length / kSteps * curvature((k + 0.5) / kSteps).norm();
  return sum;
}

}  // namespace cprsim
