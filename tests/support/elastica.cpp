// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/elastica.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace cprsim {
namespace {

/// Carlson's R_F(x, y, z) = ½ ∫ dt / √((t+x)(t+y)(t+z)) by duplication until the three are equal.
double carlson_F(double x, double y, double z) {
  for (int i = 0; i < 60; ++i) {
    const double mean = (x + y + z) / 3;
    const double X = 1 - x / mean, Y = 1 - y / mean, Z = 1 - z / mean;
    if (std::abs(X) + std::abs(Y) + std::abs(Z) < 1e-3) {
      // the next terms are of the sixth order, 1e-18
      const double e2 = X * Y - Z * Z, e3 = X * Y * Z;
      return (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44) / std::sqrt(mean);
    }
    const double l = std::sqrt(x * y) + std::sqrt(y * z) + std::sqrt(z * x);
    x = (x + l) / 4, y = (y + l) / 4, z = (z + l) / 4;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// Carlson's R_D(x, y, z) = 3/2 ∫ dt / (√((t+x)(t+y)) (t+z)^(3/2)).
double carlson_D(double x, double y, double z) {
  double sum = 0, factor = 1;
  for (int i = 0; i < 60; ++i) {
    const double mean = (x + y + 3 * z) / 5;
    const double X = 1 - x / mean, Y = 1 - y / mean, Z = 1 - z / mean;
    if (std::abs(X) + std::abs(Y) + std::abs(Z) < 1e-3) {
      const double a = X * Y, b = Z * Z, c = a - b, d = a - 6 * b, e = d + c + c;
      const double series = 1 + d * (-3.0 / 14 + 9.0 / 88 * d - 9.0 / 52 * Z * e) +
                            Z * (e / 6 + Z * (-9.0 / 22 * c + Z * 3.0 / 26 * a));
      return 3 * sum + factor * series / (mean * std::sqrt(mean));
    }
    const double l = std::sqrt(x * y) + std::sqrt(y * z) + std::sqrt(z * x);
    sum += factor / (std::sqrt(z) * (z + l));
    factor /= 4;
    x = (x + l) / 4, y = (y + l) / 4, z = (z + l) / 4;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// Everything that θ_L decides. β = π/2 - θ_L is carried too: at large loads θ_L cannot resolve it.
struct Loaded {
  double sin_tip;  // sin θ_L
  double alpha;    // α L
  double x, z;
};

Loaded at_tip_angle(double theta, double beta) {
  const double sin_tip = std::sin(theta);
  const double half = std::sin(beta / 2);
  const double k2 = (1 + sin_tip) / 2, kc2 = half * half;   // (2); 1 - sin θ_L = 2 sin²(β/2)
  const double sin_0 = 1 / std::sqrt(2 * k2);               // sin φ_0
  const double cos_0 = std::sqrt(sin_tip / (1 + sin_tip));  // cos φ_0
  const double norm = std::hypot(cos_0, std::sqrt(kc2) * sin_0);
  const double s = cos_0 / norm, c = std::sqrt(kc2) * sin_0 / norm;  // (4): sin ψ, cos ψ
  const double alpha = elliptic_F(s, c, kc2);
  const double E = elliptic_E(s, c, kc2) - k2 * sin_0 * s;
  return {sin_tip, alpha, 1 - 2 * E / alpha, std::sqrt(2 * sin_tip) / alpha};  // (3)
}

}  // namespace

double elliptic_F(double s, double c, double kc2) {
  return s * carlson_F(c * c, c * c + kc2 * s * s, 1);
}

double elliptic_E(double s, double c, double kc2) {
  const double y = c * c + kc2 * s * s;
  return s * (carlson_F(c * c, y, 1) - (1 - kc2) * s * s / 3 * carlson_D(c * c, y, 1));
}

Elastica solve_elastica(double load) {
  // bisection in λ = log(θ_L / β), in which α L grows from 0 to ∞
  const double alpha = std::sqrt(load);
  const double right = std::numbers::pi / 2;
  double low = -80, high = 80, theta = 0, beta = 0;
  for (int i = 0; i < 200; ++i) {
    const double lambda = (low + high) / 2;
    theta = right / (1 + std::exp(-lambda)), beta = right / (1 + std::exp(lambda));
    (at_tip_angle(theta, beta).alpha < alpha ? low : high) = lambda;
  }
  const Loaded tip = at_tip_angle(theta, beta);
  return {tip.x, tip.z, theta, load * tip.z};
}

}  // namespace cprsim
