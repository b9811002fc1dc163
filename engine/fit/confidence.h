// SPDX-License-Identifier: BSD-3-Clause
// What a least-squares fit knows about its parameters, from the linearisation at its end.
//
//   C = sigma² (Jᵀ J)⁻¹      covariance of z; sigma² = |r|² / (N - P) where it is not known   (1)
//   J D⁻¹ = U S Vᵀ           D: lengths of the columns                                        (2)
// A direction v of (2) whose singular value is below the accuracy of the derivatives themselves
// changes nothing that was measured: the parameters in it are not observable. Björck, Numerical
// Methods for Least Squares Problems, SIAM 1996, ch. 1 and 2.7; Seber & Wild, Nonlinear Regression,
// Wiley 1989, ch. 3 and 5 (identifiability, linear confidence intervals).
#pragma once

#include <vector>

#include "engine/math/types.h"

namespace cprsim {

struct GaussNewtonStep {
  VecX step;            ///< the shortest that minimises |J step + r|; 0 in directions below `rank`
  VecX standard_error;  ///< with sigma² estimated; 0 with as many residuals as parameters
};

/// @param rank_tolerance relative to columns scaled to length 1
GaussNewtonStep gauss_newton_step(const MatX& J, const VecX& r, double rank_tolerance);

struct ConfidenceOptions {
  bool sigma_known = false;  ///< residuals are in units of their standard deviation
  double level = 0.95;
  /// Errors of the columns of J, as lengths. A column not longer than three times its error is
  /// zero; singular values of (2) below ten times the largest relative error of the others are
  /// zero.
  VecX derivative_error;
  /// Longest interval of z (its half) that still says something: half the range of the bounds, or 1
  VecX widest;
  std::vector<bool> fixed;  ///< at a bound: not counted as a parameter
};

enum class Observability {
  kObservable,
  kNoInfluence,  ///< its column is zero: nothing measured depends on it
  kDependent,    ///< only in combination with others
  kTooUncertain  ///< the interval is wider than the bounds, or than the value itself
};

struct Confidence {
  VecX standard_error;  ///< of z; NaN where not observable or fixed
  VecX half_width;      ///< of the interval of z at the level asked for
  MatX correlation;     ///< NaN in rows and columns of what is not observable or fixed
  std::vector<Observability> observable;
  std::vector<VecX> combinations;  ///< unit directions in z that change nothing measured
  double rank_tolerance = 0;       ///< singular values of (2) at or below this count as zero
  double condition = 0;  ///< of J D⁻¹ over parameters with a column; infinite if singular
  double sigma = 1;      ///< used in (1)
  double reduced_chi_square = 0;  ///< |r|² / freedom
  int freedom = 0;                ///< N - P
};

Confidence confidence(const MatX& J, const VecX& r, const ConfidenceOptions& options);

/// t such that a Student t variable of `freedom` degrees lies in [-t, t] with probability `level`;
/// freedom 0 stands for infinitely many: the normal distribution.
double student_t(double level, int freedom);

}  // namespace cprsim
