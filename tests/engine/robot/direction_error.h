// SPDX-License-Identifier: BSD-3-Clause
// Whether a Newton direction is exact: along it the merit, half a sum of squares, must begin to
// fall by twice itself.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/robot/equations.h"

namespace cprsim {

/// |slope of merit / (-2 merit) - 1| along the Newton direction at the present state, by
/// fourth-order differences: directions are anything between 1 and 1e10 long, so the difference
/// that fits best. 1 if there is no direction.
inline double direction_error(Equations& equations) {
  const double merit = equations.evaluate().merit;
  if (!equations.find_direction(0)) return 1;
  equations.keep();
  const auto merit_at = [&](double alpha) {
    equations.move(alpha);
    return equations.evaluate().merit;
  };
  double error = 1;
  for (double a = 1e-2; a > 1e-13; a *= 0.1) {
    const double slope =
        (8 * (merit_at(a) - merit_at(-a)) - (merit_at(2 * a) - merit_at(-2 * a))) / (12 * a);
    error = std::min(error, std::abs(slope / (-2 * merit) - 1));
  }
  return error;
}

}  // namespace cprsim
