// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/parameter.h"

#include <algorithm>
#include <cmath>

namespace cprsim {

bool StudyParameter::bounded() const {
  return std::isfinite(low) && std::isfinite(high);
}

double StudyParameter::unit() const {
  return bounded() ? 0.5 * (high - low) : std::abs(start);
}

double StudyParameter::extended(double z) const {
  return logarithmic() ? start * std::exp(z - 1) : start + unit() * (z - 1);
}

double StudyParameter::value(double z) const {
  return std::clamp(extended(z), low, high);
}

double StudyParameter::coordinate(double v) const {
  return 1 + (logarithmic() ? std::log(v / start) : (v - start) / unit());
}

double StudyParameter::slope(double z) const {
  return logarithmic() ? value(z) : unit();
}

}  // namespace cprsim
