// SPDX-License-Identifier: BSD-3-Clause
// What one element of a strain-basis rod knows about polynomials: the same for all elements of a
// rod. Sections are asked at the Gauss points of the element; from each to the next leads one
// Magnus step (engine/rod/magnus.h), which sees the strain at its own three Gauss points.
#pragma once

#include <vector>

#include "engine/math/legendre.h"

namespace cprsim {

struct StrainRule {
  /// @param order highest degree of the strain polynomials. @param points of quadrature.
  StrainRule(int order, int points);

  struct Step {
    double fraction = 0;  ///< of the element's length
    MatX phi;             ///< (order + 1) × 3: polynomials at the step's Gauss points
  };

  /// The step from point `from` (-1: the element's start) to x, a fraction of the element.
  Step step_to(Eigen::Index from, double x) const;

  Eigen::Index functions() const { return order + 1; }

  Eigen::Index points() const { return gauss.points.size(); }

  int order;
  GaussRule gauss;
  MatX integrate;           ///< integration_matrix(gauss)
  MatX phi;                 ///< functions × points
  std::vector<Step> steps;  ///< start → points → end: one more than points
};

}  // namespace cprsim
