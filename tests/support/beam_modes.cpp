// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/beam_modes.h"

#include <cmath>
#include <numbers>

namespace cprsim {

double clamped_free_root(int mode) {
  // Newton on cos β + 1 / cosh β, which does not grow; starts at the roots of cos β
  double beta = (mode - 0.5) * std::numbers::pi;
  for (int i = 0; i < 50; ++i) {
    const double f = std::cos(beta) + 1 / std::cosh(beta);
    const double slope = -std::sin(beta) - std::tanh(beta) / std::cosh(beta);
    const double step = f / slope;
    beta -= step;
    if (std::abs(step) < 1e-15 * beta) break;
  }
  return beta;
}

double clamped_free_frequency(int mode, double EI, double rhoA, double length) {
  const double beta = clamped_free_root(mode) / length;
  return beta * beta * std::sqrt(EI / rhoA);
}

}  // namespace cprsim
