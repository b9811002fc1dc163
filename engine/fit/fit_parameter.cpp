// SPDX-License-Identifier: BSD-3-Clause
#include "engine/fit/fit_parameter.h"

#include <algorithm>
#include <cmath>

namespace cprsim {

bool FitParameter::bounded() const {
  return std::isfinite(low) && std::isfinite(high);
}

double FitParameter::unit() const {
  return bounded() ? 0.5 * (high - low) : std::abs(start);
}

double FitParameter::extended(double z) const {
  return logarithmic() ? start * std::exp(z - 1) : start + unit() * (z - 1);
}

double FitParameter::value(double z) const {
  return std::clamp(extended(z), low, high);
}

double FitParameter::coordinate(double v) const {
  return 1 + (logarithmic() ? std::log(v / start) : (v - start) / unit());
}

double FitParameter::slope(double z) const {
  return logarithmic() ? value(z) : unit();
}

}  // namespace cprsim
