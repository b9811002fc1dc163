// SPDX-License-Identifier: BSD-3-Clause
// What one element of a strain-basis rod knows about polynomials: the same for all elements of a
// rod. Sections are asked at the Gauss points of the element; from each to the next lead Magnus
// steps (engine/rod/magnus.h), which see the strain at three Gauss points of their own.
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

  /// The step from `from` to `to`, fractions of the element.
  Step step(double from, double to) const;

  Eigen::Index functions() const { return order + 1; }

  Eigen::Index points() const { return gauss.points.size(); }

  int order;
  GaussRule gauss;
  MatX integrate;           ///< integration_matrix(gauss)
  MatX phi;                 ///< functions × points
  std::size_t per_gap;      ///< steps from one point to the next
  std::vector<Step> steps;  ///< start → points → end: gaps are one more than points
};

}  // namespace cprsim
