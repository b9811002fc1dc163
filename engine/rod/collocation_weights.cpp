// SPDX-License-Identifier: BSD-3-Clause
// Splines with weights: NURBS.
#include <stdexcept>

#include "engine/rod/collocation.h"

namespace cprsim {

// The weights say which function W divides the splines; where its knots are among those of a piece
// the piece takes it over exactly, as by knot insertion.
void CollocationRod::weigh(BsplineSpace& space) const {
  const auto count = static_cast<Eigen::Index>(options_.weights.size());
  std::vector<double> breaks;
  const auto elements = count - options_.degree;
  for (Eigen::Index e = 0; e <= elements; ++e)
    breaks.push_back(static_cast<double>(e) / static_cast<double>(elements));
  const BsplineSpace whole(options_.degree, breaks);
  const std::vector<double> points = space.greville();
  MatX W(space.size(), 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const BasisValues b = whole.basis(points[i]);
    W(static_cast<Eigen::Index>(i), 0) =
        Eigen::Map<const VecX>(options_.weights.data() + b.first, options_.degree + 1)
            .dot(Eigen::Map<const VecX>(b.value, options_.degree + 1));
  }
  const VecX weights = space.interpolate(W);
  if (!(weights.minCoeff() > 0))
    throw std::invalid_argument("the weights of rod '" + name_ +
                                "' change too much from element to element");
  space.weigh(weights);
}

}  // namespace cprsim
