// SPDX-License-Identifier: BSD-3-Clause
// Order conditions of Runge-Kutta tables: one for each rooted tree (Hairer, Nørsett, Wanner I,
// table II.2.1).
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/math/types.h"

namespace cprsim {

struct ButcherTable {
  MatX A;
  VecX b;
};

/// Largest violation among the conditions of all trees with up to `order` <= 4 nodes.
inline double order_defect(const ButcherTable& t, int order) {
  const VecX e = VecX::Ones(t.b.size()), c = t.A * e, c2 = c.cwiseAbs2();
  const auto weighted = [&](const VecX& x) { return t.b.dot(x); };
  double worst = std::abs(weighted(e) - 1);
  const auto condition = [&](int nodes, const VecX& x, double value) {
    if (nodes <= order) worst = std::max(worst, std::abs(weighted(x) - value));
  };
  const VecX Ac = t.A * c, Ac2 = t.A * c2, AAc = t.A * Ac;
  condition(2, c, 1. / 2);
  condition(3, c2, 1. / 3);
  condition(3, Ac, 1. / 6);
  condition(4, c.cwiseProduct(c2), 1. / 4);
  condition(4, c.cwiseProduct(Ac), 1. / 8);
  condition(4, Ac2, 1. / 12);
  condition(4, AAc, 1. / 24);
  return worst;
}

/// Violation of B(p): sum b c^(k-1) = 1/k for k <= p.
inline double quadrature_defect(const ButcherTable& t, int p) {
  const VecX c = t.A.rowwise().sum();
  VecX power = VecX::Ones(c.size());
  double worst = 0;
  for (int k = 1; k <= p; ++k) {
    worst = std::max(worst, std::abs(t.b.dot(power) - 1. / k));
    power = power.cwiseProduct(c);
  }
  return worst;
}

/// Violation of C(q), stage order: A c^(k-1) = c^k / k for k <= q.
inline double stage_defect(const ButcherTable& t, int q) {
  const VecX c = t.A.rowwise().sum();
  VecX power = VecX::Ones(c.size());
  double worst = 0;
  for (int k = 1; k <= q; ++k) {
    const VecX next = power.cwiseProduct(c);
    worst = std::max(worst, (t.A * power - next / k).cwiseAbs().maxCoeff());
    power = next;
  }
  return worst;
}

}  // namespace cprsim
