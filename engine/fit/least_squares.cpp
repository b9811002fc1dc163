// SPDX-License-Identifier: BSD-3-Clause
#include "engine/fit/least_squares.h"

#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>

#include "engine/fit/confidence.h"

namespace cprsim {

namespace {

// What a trial point without an answer is worth: more than ten times any residual, so that
// MINPACK's test refuses the step and shortens the next one to a tenth.
constexpr double kNoAnswer = 1e100;

/// The problem as Eigen's solver wants to see it.
struct Projected {
  LeastSquaresProblem& problem;
  const VecX &low, &high;
  VecX z_known, r_known;  ///< the last evaluation, of which the derivative is often asked next
  VecX z_linearised;
  MatX J;  ///< with all columns
  std::vector<bool> held;
  int evaluations = 0, failed = 0;
  bool derivative_failed = false;

  VecX inside(const VecX& z) const { return z.cwiseMax(low).cwiseMin(high); }

  bool evaluate(const VecX& z, VecX& r) {
    ++evaluations;
    if (!problem.residuals(z, r) || !r.allFinite()) return false;
    z_known = z;
    r_known = r;
    return true;
  }

  int operator()(const VecX& trial, VecX& r) {
    if (evaluate(inside(trial), r)) return 0;
    ++failed;
    r.setConstant(kNoAnswer);
    return 0;
  }

  int df(const VecX& at, MatX& J_free) {
    const VecX z = inside(at);
    VecX r = r_known;
    if (z_known != z && !evaluate(z, r)) derivative_failed = true;
    if (derivative_failed || !problem.derivative(z, r, J)) {
      derivative_failed = true;
      return -1;
    }
    const VecX gradient = J.transpose() * r;
    J_free = J;
    for (Eigen::Index j = 0; j < z.size(); ++j) {
      // r^T r falls along -gradient
      const bool out = (z[j] <= low[j] && gradient[j] > 0) || (z[j] >= high[j] && gradient[j] < 0);
      held[static_cast<std::size_t>(j)] = out;
      if (out) J_free.col(j).setZero();
    }
    z_linearised = z;
    return 0;
  }

  int inputs() const { return static_cast<int>(low.size()); }

  int values() const { return static_cast<int>(r_known.size()); }
};

// The part of J that may still move, for the test of convergence.
MatX free_columns(const MatX& J, const std::vector<bool>& held) {
  MatX free = J;
  for (Eigen::Index j = 0; j < J.cols(); ++j)
    if (held[static_cast<std::size_t>(j)]) free.col(j).setZero();
  return free;
}

}  // namespace

const char* to_string(FitStatus status) {
  switch (status) {
    case FitStatus::kConverged:
      return "converged";
    case FitStatus::kStalled:
      return "stalled";
    case FitStatus::kIterationLimit:
      return "iteration limit";
    case FitStatus::kNoStart:
      return "no answer at the start";
    case FitStatus::kNoDerivative:
      return "no derivative";
    case FitStatus::kInterrupted:
      return "interrupted";
  }
  return "";
}

FitReport fit(LeastSquaresProblem& problem, const VecX& start, const VecX& low, const VecX& high,
              const FitOptions& options) {
  FitReport report;
  const auto n = static_cast<std::size_t>(start.size());
  Projected projected{problem, low, high, {}, {}, {}, {}, std::vector<bool>(n, false)};
  report.z = projected.inside(start);
  report.at_bound.assign(n, false);
  if (!projected.evaluate(report.z, report.r)) {
    report.status = FitStatus::kNoStart;
    return report;
  }
  report.start_sum = report.sum = report.r.squaredNorm();

  Eigen::LevenbergMarquardt<Projected> search(projected);
  search.parameters.factor = 1;  // the first step is at most as long as z: one unit
  search.parameters.ftol = 1e-15;
  search.parameters.xtol = 1e-12;
  search.parameters.maxfev = 50 * (options.max_iterations + 1);
  namespace Space = Eigen::LevenbergMarquardtSpace;
  VecX z = report.z;
  Space::Status status = search.minimizeInit(z);
  FitStatus end = FitStatus::kConverged;
  if (status == Space::NotStarted) status = Space::Running;
  while (status == Space::Running) {
    if (options.go_on && !options.go_on()) {
      end = FitStatus::kInterrupted;
      break;
    }
    if (report.iterations == options.max_iterations) {
      end = FitStatus::kIterationLimit;
      break;
    }
    ++report.iterations;
    status = search.minimizeOneStep(z);
    z = projected.inside(z);
  }
  if (projected.derivative_failed) end = FitStatus::kNoDerivative;
  report.z = z;
  report.r = search.fvec;
  report.sum = report.r.squaredNorm();
  report.rejected = projected.failed;
  // the linearisation where the search ended, not where its last step began
  MatX unused;
  if (end != FitStatus::kNoDerivative && end != FitStatus::kInterrupted) {
    if (projected.z_linearised.size() == 0 || projected.z_linearised != z)
      if (projected.df(z, unused) < 0) end = FitStatus::kNoDerivative;
  }
  report.evaluations = projected.evaluations;
  report.J = projected.J;
  report.at_bound = projected.held;
  const bool linear = projected.J.size() > 0 && !projected.derivative_failed;
  report.status = end;
  if (!linear || end == FitStatus::kInterrupted) return report;
  const FitStatus verdict =
      settled(report.J, report.r, report.at_bound, options, &report.remaining_step)
          ? FitStatus::kConverged
          : FitStatus::kStalled;
  if (end == FitStatus::kConverged || verdict == FitStatus::kConverged) report.status = verdict;
  return report;
}

bool settled(const MatX& J, const VecX& r, const std::vector<bool>& held, const FitOptions& options,
             double* largest) {
  const GaussNewtonStep rest = gauss_newton_step(free_columns(J, held), r, options.rank_tolerance);
  if (largest != nullptr) *largest = rest.step.cwiseAbs().maxCoeff();
  const VecX noise = options.noise_fraction * rest.standard_error;
  return (rest.step.cwiseAbs().array() <= noise.cwiseMax(options.step_tolerance).array()).all();
}

bool difference_jacobian(LeastSquaresProblem& problem, const VecX& z, const VecX& r, double step,
                         const VecX& low, const VecX& high, MatX& J) {
  J.resize(r.size(), z.size());
  VecX near, far;
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    const auto at = [&](double offset, VecX& out) {
      VecX moved = z;
      moved[j] += offset;
      return moved[j] >= low[j] && moved[j] <= high[j] && problem.residuals(moved, out) &&
             out.allFinite();
    };
    const bool up = at(step, near), down = at(-step, far);
    if (up && down) {
      J.col(j) = (near - far) / (2 * step);
      continue;
    }
    // -3 f(0) + 4 f(d) - f(2 d) over 2 d: second order as well
    const double d = up ? step : -step;
    const VecX first = up ? near : far;
    if (!(up || down) || !at(2 * d, far)) return false;
    J.col(j) = (-3 * r + 4 * first - far) / (2 * d);
  }
  return true;
}

}  // namespace cprsim
