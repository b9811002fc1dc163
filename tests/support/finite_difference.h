// SPDX-License-Identifier: BSD-3-Clause
// Checks an analytic Jacobian against differences of the function, also on manifolds:
//   (1) J e_j = [8 (f(x ⊕ h e_j) ⊖ f(x)) - 8 (f(x ⊕ -h e_j) ⊖ f(x))
//               - (f(x ⊕ 2h e_j) ⊖ f(x)) + (f(x ⊕ -2h e_j) ⊖ f(x))] / 12 h
// Fourth order: with h = 1e-3 of the scale of x, truncation and roundoff are both about 1e-12.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "engine/math/types.h"

namespace cprsim {

/// Steps h_j of (1): the same for every column, or one for each (unknowns of different units).
struct DifferenceSteps {
  VecX steps;

  DifferenceSteps(double step) : steps(VecX::Constant(1, step)) {}  // NOLINT: converts on purpose

  DifferenceSteps(VecX all) : steps(std::move(all)) {}  // NOLINT: converts on purpose

  double operator[](int column) const { return steps.size() == 1 ? steps[0] : steps[column]; }
};

/// The matrix of (1) for f: X → Y with tangent dimension `columns` of X.
/// @param increment (x, d) → x ⊕ d, d a VecX of `columns` entries.
/// @param difference (y, y0) → y ⊖ y0, a vector.
template <class Function, class Point, class Increment, class Difference>
MatX difference_jacobian(const Function& f, const Point& x, int columns, const Increment& increment,
                         const Difference& difference, const DifferenceSteps& steps = 1e-3) {
  const auto y0 = f(x);
  const auto moved = [&](int column, double by) -> VecX {
    VecX d = VecX::Zero(columns);
    d[column] = by;
    return difference(f(increment(x, d)), y0);
  };
  MatX J;
  for (int j = 0; j < columns; ++j) {
    const double h = steps[j];
    const VecX column =
        (8 * (moved(j, h) - moved(j, -h)) - (moved(j, 2 * h) - moved(j, -2 * h))) / (12 * h);
    if (j == 0) J.resize(column.size(), columns);
    J.col(j) = column;
  }
  return J;
}

/// (1) for f: manifold → vector.
template <class Function, class Point, class Increment>
MatX difference_jacobian(const Function& f, const Point& x, int columns, const Increment& increment,
                         const DifferenceSteps& steps = 1e-3) {
  const auto vector_f = [&](const Point& at) -> VecX { return f(at); };
  const auto subtract = [](const VecX& y, const VecX& y0) -> VecX { return y - y0; };
  return difference_jacobian(vector_f, x, columns, increment, subtract, steps);
}

/// (1) for f: vector → vector.
template <class Function>
MatX difference_jacobian(const Function& f, const VecX& x, const DifferenceSteps& steps = 1e-3) {
  const auto add = [](const VecX& at, const VecX& d) -> VecX { return at + d; };
  return difference_jacobian(f, x, static_cast<int>(x.size()), add, steps);
}

/// Agreement of every entry within `tolerance` of its scale, the geometric mean of the largest
/// entries of its row and column (rows and columns may have different units), or within `absolute`.
/// On failure names the worst entries.
inline ::testing::AssertionResult jacobians_agree(const MatX& analytic, const MatX& numeric,
                                                  double tolerance, double absolute = 0) {
  if (analytic.rows() != numeric.rows() || analytic.cols() != numeric.cols())
    return ::testing::AssertionFailure()
           << "analytic is " << analytic.rows() << "×" << analytic.cols() << ", numeric is "
           << numeric.rows() << "×" << numeric.cols();

  struct Entry {
    Eigen::Index row, column;
    double excess;  // error / allowed
    double error, scale;
  };

  std::vector<Entry> wrong;
  const MatX larger = analytic.cwiseAbs().cwiseMax(numeric.cwiseAbs());
  for (Eigen::Index i = 0; i < analytic.rows(); ++i)
    for (Eigen::Index j = 0; j < analytic.cols(); ++j) {
      const double scale = std::sqrt(larger.row(i).maxCoeff() * larger.col(j).maxCoeff());
      const double error = std::abs(analytic(i, j) - numeric(i, j));
      const double allowed = std::max(tolerance * scale, absolute);
      // negated so that a NaN fails
      if (!(error <= allowed)) wrong.push_back({i, j, error / allowed, error, scale});
    }
  if (wrong.empty()) return ::testing::AssertionSuccess();
  const auto worse = [](const Entry& a, const Entry& b) {
    return std::isnan(b.excess) ? false : std::isnan(a.excess) || a.excess > b.excess;
  };
  std::stable_sort(wrong.begin(), wrong.end(), worse);
  std::ostringstream text;
  text << wrong.size() << " of " << analytic.size() << " entries differ by more than " << tolerance
       << " of their scale; the worst:\n"
       << std::setprecision(12);
  for (std::size_t k = 0; k < std::min<std::size_t>(wrong.size(), 6); ++k) {
    const Entry& e = wrong[k];
    text << "  (" << e.row << ", " << e.column << "): analytic " << analytic(e.row, e.column)
         << ", numeric " << numeric(e.row, e.column) << ", error " << e.error << ", scale "
         << e.scale << "\n";
  }
  return ::testing::AssertionFailure() << text.str();
}

}  // namespace cprsim
