// SPDX-License-Identifier: BSD-3-Clause
// Nonlinear least squares with bounds: the z in [low, high] with the least |r(z)|².
//
// Levenberg-Marquardt as in MINPACK's lmder (Moré, Lecture Notes in Mathematics 630, 1978), in the
// form that Eigen ships. Bounds by projection: residuals are those of the nearest point inside, and
// a parameter that stands at a bound which the gradient pushes it through has no column in the
// Jacobian, so that the others move as if it were fixed. A model without an answer at a trial point
// is a rejected step.
#pragma once

#include <functional>
#include <vector>

#include "engine/math/types.h"

namespace cprsim {

/// r(z), every entry in units of its standard deviation (or all in one unit), and its derivative.
class LeastSquaresProblem {
 public:
  virtual ~LeastSquaresProblem() = default;

  /// @return false if there is no answer at z
  virtual bool residuals(const VecX& z, VecX& r) = 0;
  /// @param J one row a residual, one column a parameter. @param r residuals at z
  virtual bool derivative(const VecX& z, const VecX& r, MatX& J) = 0;
};

enum class FitStatus {
  kConverged,       ///< the Gauss-Newton step that remains is within `step_tolerance`, or smaller
                    ///< than `noise_fraction` of its own standard error
  kStalled,         ///< no step reduces the sum of squares any more, but one of size remains
  kIterationLimit,  ///< max_iterations reached
  kNoStart,         ///< no residuals at the start
  kNoDerivative,    ///< no residuals on any side of a point that was reached
  kInterrupted      ///< go_on() said no
};

const char* to_string(FitStatus status);

struct FitOptions {
  int max_iterations = 100;
  double step_tolerance = 1e-7;  ///< in units of z
  double noise_fraction = 0.01;  ///< of a standard error
  double rank_tolerance = 1e-7;  ///< of the columns' lengths: flatter directions are not stepped in
  std::function<bool()> go_on;   ///< asked before every iteration; may be empty
};

struct FitReport {
  FitStatus status = FitStatus::kConverged;
  VecX z, r;
  MatX J;
  std::vector<bool> at_bound;     ///< held there by the gradient
  double start_sum = 0, sum = 0;  ///< |r|² before and after
  double remaining_step = 0;      ///< largest entry of the Gauss-Newton step at z
  int iterations = 0, evaluations = 0, rejected = 0;

  bool converged() const { return status == FitStatus::kConverged; }
};

/// @pre at least as many residuals as parameters, low < high, z inside
FitReport fit(LeastSquaresProblem& problem, const VecX& z, const VecX& low, const VecX& high,
              const FitOptions& options);

/// Whether the Gauss-Newton step that remains is what FitStatus::kConverged says.
/// @param held parameters that do not move: at a bound, or without influence
/// @param largest if not null, the largest entry of the step
bool settled(const MatX& J, const VecX& r, const std::vector<bool>& held, const FitOptions& options,
             double* largest = nullptr);

/// ∂r/∂z by central differences with this step; at a bound, and where one side has no answer, by
/// the one-sided formula of the same order.
/// @return false if neither side has an answer
bool difference_jacobian(LeastSquaresProblem& problem, const VecX& z, const VecX& r, double step,
                         const VecX& low, const VecX& high, MatX& J);

}  // namespace cprsim
