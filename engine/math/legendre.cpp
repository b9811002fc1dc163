// SPDX-License-Identifier: BSD-3-Clause
#include "engine/math/legendre.h"

#include <cmath>
#include <numbers>

namespace cprsim {
namespace {

/// P_0 .. P_degree at y in [-1, 1], by the three-term recurrence.
VecX legendre_p(double y, int degree) {
  VecX P(degree + 1);
  P[0] = 1;
  if (degree > 0) P[1] = y;
  for (int k = 1; k < degree; ++k)
    P[k + 1] = ((2 * k + 1) * y * P[k] - k * P[k - 1]) / (k + 1);
  return P;
}

}  // namespace

VecX legendre(double x, int degree) {
  VecX phi = legendre_p(2 * x - 1, degree);
  for (int k = 0; k <= degree; ++k)
    phi[k] *= std::sqrt(2.0 * k + 1);
  return phi;
}

VecX legendre_integrals(double x, int degree) {
  const VecX P = legendre_p(2 * x - 1, degree + 1);
  VecX I(degree + 1);
  I[0] = x;
  for (int k = 1; k <= degree; ++k)
    I[k] = (P[k + 1] - P[k - 1]) / (2 * std::sqrt(2.0 * k + 1));
  return I;
}

GaussRule gauss_rule(int n) {
  GaussRule rule{VecX(n), VecX(n)};
  for (int i = 0; i < n; ++i) {
    // Newton's method from Tricomi's estimate of the root
    double y = -std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 0;
    for (int pass = 0; pass < 8; ++pass) {
      const VecX P = legendre_p(y, n);
      slope = n * (P[n - 1] - y * P[n]) / (1 - y * y);
      y -= P[n] / slope;
    }
    rule.points[i] = 0.5 * (1 + y);
    rule.weights[i] = 1 / ((1 - y * y) * slope * slope);
  }
  return rule;
}

MatX integration_matrix(const GaussRule& rule) {
  const Eigen::Index n = rule.points.size();
  const int degree = static_cast<int>(n) - 1;
  MatX a = MatX::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const VecX integrals = legendre_integrals(rule.points[i], degree);
    for (Eigen::Index j = 0; j < n; ++j)
      a(i, j) = rule.weights[j] * integrals.dot(legendre(rule.points[j], degree));
  }
  return a;
}

VecX interpolation_weights(const GaussRule& rule, double x) {
  const int degree = static_cast<int>(rule.points.size()) - 1;
  const VecX phi = legendre(x, degree);
  VecX weights(rule.points.size());
  for (Eigen::Index j = 0; j < weights.size(); ++j)
    weights[j] = rule.weights[j] * phi.dot(legendre(rule.points[j], degree));
  return weights;
}

}  // namespace cprsim
