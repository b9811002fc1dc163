// SPDX-License-Identifier: BSD-3-Clause
#include "engine/section/along.h"

#include <algorithm>

namespace cprsim {

SectionsAlong::SectionsAlong(const RodSpec& rod, bool immersed)
    : spec_(rod), immersed_(immersed), rest_(rod) {
  for (const SectionSpec& section : rod.sections)
    if (section.s > 0 && section.s < 1 && (breaks_.empty() || section.s > breaks_.back()))
      breaks_.push_back(section.s);
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

}  // namespace cprsim
