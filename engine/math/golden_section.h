// SPDX-License-Identifier: BSD-3-Clause
// Where a function of one number is lowest, without its derivative.
#pragma once

#include <algorithm>
#include <limits>

namespace cprsim {

struct Lowest {
  double at = 0, value = std::numeric_limits<double>::infinity();
};

/// Of f on [0, 1]: nine samples, then golden section around the lowest (Kiefer, Proc. Am. Math.
/// Soc. 4, 1953), to the square root of round-off, which is how well a minimum is known.
template <class F>
Lowest lowest_of(const F& f) {
  constexpr int kSamples = 8;
  constexpr double kGolden = 0.3819660112501051, kWidth = 1e-7;
  Lowest lowest;
  const auto look = [&](double at) {
    const double value = f(at);
    if (value < lowest.value) lowest = {at, value};
    return value;
  };
  for (int i = 0; i <= kSamples; ++i)
    look(static_cast<double>(i) / kSamples);
  double a = std::max(0.0, lowest.at - 1.0 / kSamples),
         b = std::min(1.0, lowest.at + 1.0 / kSamples);
  double x1 = a + kGolden * (b - a), x2 = b - kGolden * (b - a), f1 = look(x1), f2 = look(x2);
  while (b - a > kWidth) {
    if (f1 < f2) {
      b = x2;
      x2 = x1;
      f2 = f1;
      f1 = look(x1 = a + kGolden * (b - a));
    } else {
      a = x1;
      x1 = x2;
      f1 = f2;
      f2 = look(x2 = b - kGolden * (b - a));
    }
  }
  return lowest;
}

}  // namespace cprsim
