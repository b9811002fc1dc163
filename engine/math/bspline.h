// SPDX-License-Identifier: BSD-3-Clause
// B-splines: piecewise polynomials of degree p on knots t_0 <= t_1 <= ..., as smooth at a knot as p
// minus its multiplicity. Basis functions by the recursion of Cox and de Boor,
//   B_i,0(x) = 1 on [t_i, t_i+1),
//   B_i,p(x) = (x - t_i) / (t_i+p - t_i) B_i,p-1 + (t_i+p+1 - x) / (t_i+p+1 - t_i+1) B_i+1,p-1, (1)
//   B'_i,p   = p / (t_i+p - t_i) B_i,p-1 - p / (t_i+p+1 - t_i+1) B_i+1,p-1.                     (2)
// With weights w_i the functions are rational (NURBS),
//   R_i = w_i B_i,p / W,   R'_i = (w_i B'_i,p - R_i W') / W,   W = sum_i w_i B_i,p.             (3)
// Source: Piegl & Tiller, "The NURBS book", 2nd ed., eqs. 2.5, 2.7, 4.2 and 4.8; Greville
// abscissae: de Boor, "A practical guide to splines", ch. IX.
#pragma once

#include <vector>

#include "engine/math/types.h"

namespace cprsim {

constexpr int kMaxDegree = 8;

/// The functions that do not vanish at a point.
struct BasisValues {
  int first = 0;  ///< index of the first of degree + 1
  double value[kMaxDegree + 1] = {};
  double slope[kMaxDegree + 1] = {};  ///< first derivatives
};

/// All splines of one degree on one knot vector; a spline is one coefficient (control point) for
/// each basis function.
class BsplineSpace {
 public:
  /// As smooth as the degree allows; the end knots are repeated, so that a spline starts at its
  /// first control point and ends at its last. @param breaks ascending, at least two.
  BsplineSpace(int degree, const std::vector<double>& breaks);

  /// Makes the functions those of (3). @param weights one for each function, positive
  void weigh(const VecX& weights);

  int degree() const { return degree_; }

  int size() const { return static_cast<int>(knots_.size()) - degree_ - 1; }

  const std::vector<double>& knots() const { return knots_; }

  /// At the end of the last piece: the limit from within.
  BasisValues basis(double x) const;

  /// Where the spline with control points at these abscissae is x itself, without weights; one for
  /// each function, and interpolation there is well-posed.
  std::vector<double> greville() const;

  /// The splines that are derivatives of these, without weights; of degree one less, one function
  /// fewer.
  BsplineSpace derivatives() const;

  /// Control points (rows) of the spline with the given values (rows) at greville().
  MatX interpolate(const MatX& values) const;

  /// Weights of the quadrature at greville() that is exact for these splines.
  VecX greville_weights() const;

 private:
  BsplineSpace() = default;
  int span(double x) const;
  void make_rational(BasisValues& basis) const;

  int degree_ = 0;
  std::vector<double> knots_;
  VecX weights_;  ///< empty: all 1
};

}  // namespace cprsim
