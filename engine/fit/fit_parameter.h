// SPDX-License-Identifier: BSD-3-Clause
// An unknown value of a study and the coordinate z in which it is sought, so that a step of 1
// means "a lot" for every parameter:
//   logarithmic   value = start exp(z - 1)          bounds positive and a factor of 10 apart or
//   more linear        value = start + unit (z - 1)      otherwise; unit: half the range of the
//   bounds,
//                                                   or |start| where there are none
// z = 1 at the start, not 0: a search that measures its steps relative to |z| needs a size.
#pragma once

#include <limits>
#include <string>

namespace cprsim {

struct FitParameter {
  std::string name;
  double start = 0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  bool logarithmic() const { return low > 0 && start > 0 && high >= 10 * low; }

  /// The length of the linear coordinate. @pre bounded() or start != 0
  double unit() const;
  bool bounded() const;

  /// Never beyond the bounds.
  double value(double z) const;
  /// The same without regard to bounds: ends of intervals.
  double extended(double z) const;
  double coordinate(double v) const;
  /// d value / d z
  double slope(double z) const;
};

}  // namespace cprsim
