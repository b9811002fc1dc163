// SPDX-License-Identifier: BSD-3-Clause
#include "engine/section/along.h"

#include <algorithm>
#include <cmath>

#include "engine/math/so3.h"

namespace cprsim {
namespace {

constexpr int kSteps = 400;  // of what only needs to be roughly right: a shape to start from

}  // namespace

SectionsAlong::SectionsAlong(const RodSpec& rod, bool immersed) : spec_(rod), immersed_(immersed) {
  for (const SectionSpec& section : rod.sections)
    if (section.s > 0 && section.s < 1 && (breaks_.empty() || section.s > breaks_.back()))
      breaks_.push_back(section.s);
  if (rod.rest_samples.empty()) return;
  for (int i = 0; i < 3; ++i) {
    ProfileTerm term;
    term.shape = ShapeOfTime::kKeyframes;
    term.interpolation = Interpolation::kCubic;
    for (const RestSample& sample : rod.rest_samples) {
      term.times.push_back(sample.s);
      term.values.push_back(sample.curvature[i]);
    }
    finish_keyframes(term);
    rest_[i].terms.push_back(term);
  }
}

Vec3 SectionsAlong::rest_curvature(double s) const {
  if (spec_.rest_samples.empty()) return spec_.rest_curvature;
  return {rest_[0].evaluate(s).value, rest_[1].evaluate(s).value, rest_[2].evaluate(s).value};
}

SectionProperties SectionsAlong::at(double s, double inside) const {
  RodSpec here = spec_;
  const std::vector<SectionSpec>& all = spec_.sections;
  if (all.size() > 1) {
    const auto after = std::upper_bound(
        all.begin(), all.end(), inside,
        [](double value, const SectionSpec& section) { return value < section.s; });
    if (after == all.begin()) {
      here.section = all.front();
    } else if (after == all.end()) {
      here.section = all.back();
    } else {
      const SectionSpec &a = *(after - 1), &b = *after;
      const double f = (s - a.s) / (b.s - a.s);
      here.section = a;
      here.section.size = (1 - f) * a.size + f * b.size;
    }
  }
  here.rest_curvature = rest_curvature(s);
  SectionProperties properties = section_properties(here);
  if (immersed_ && spec_.drag) properties.fluid = fluid_properties(*spec_.drag, properties.area);
  return properties;
}

Pose SectionsAlong::unloaded(double s, double length) const {
  Pose X;
  const double h = s * length / kSteps;
  for (int k = 0; k < kSteps && s > 0; ++k) {
    const Vec3 turn = h * rest_curvature(s * (k + 0.5) / kSteps);
    X.p += X.R * (h * right_jacobian(-turn).col(2));
    X.R = X.R * exp_so3(turn);
  }
  return X;
}

double SectionsAlong::turn(double length) const {
  double sum = 0;
  for (int k = 0; k < kSteps; ++k)
    sum += length / kSteps * rest_curvature((k + 0.5) / kSteps).norm();
  return sum;
}

}  // namespace cprsim
