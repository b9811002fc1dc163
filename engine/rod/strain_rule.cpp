// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/strain_rule.h"

namespace cprsim {

StrainRule::StrainRule(int order_of, int points_of)
    : order(order_of),
      gauss(gauss_rule(points_of)),
      integrate(integration_matrix(gauss)),
      phi(order_of + 1, points_of) {
  for (Eigen::Index i = 0; i < points(); ++i) {
    phi.col(i) = legendre(gauss.points[i], order);
    steps.push_back(step_to(i - 1, gauss.points[i]));
  }
  steps.push_back(step_to(points() - 1, 1));
}

StrainRule::Step StrainRule::step_to(Eigen::Index from, double x) const {
  const double start = from < 0 ? 0 : gauss.points[from];
  const GaussRule three = gauss_rule(3);
  Step step{x - start, MatX(functions(), 3)};
  for (Eigen::Index g = 0; g < 3; ++g)
    step.phi.col(g) = legendre(start + step.fraction * three.points[g], order);
  return step;
}

}  // namespace cprsim
