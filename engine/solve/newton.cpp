// SPDX-License-Identifier: BSD-3-Clause
#include "engine/solve/newton.h"

#include <algorithm>
#include <cmath>

namespace cprsim {
namespace {

constexpr double kSmallestStep = 1.0 / 1024;

struct Counts {
  long evaluations, factorizations;

  explicit Counts(const Problem& p)
      : evaluations(p.section_evaluations()), factorizations(p.factorizations()) {}
};

SolveReport finish(SolveReport report, const Problem& problem, const Counts& before,
                   const ProblemResidual& r, SolveStatus status) {
  report.status = status;
  report.residual = r.largest;
  report.evaluations = problem.section_evaluations() - before.evaluations;
  report.factorizations = static_cast<int>(problem.factorizations() - before.factorizations);
  report.growth = problem.growth();
  report.worst_row = problem.worst_row();
  return report;
}

bool falls(const ProblemResidual& trial, const ProblemResidual& r, double alpha) {
  return trial.finite && trial.merit <= (1 - 2e-4 * alpha) * r.merit;
}

/// Shortens the current direction until it helps. @return false if no step does; the unknowns are
/// then as before.
bool backtrack(Problem& problem, ProblemResidual& r, ProblemResidual trial) {
  for (double alpha = 1; alpha >= kSmallestStep;) {
    // minimum of the parabola through merit, slope -2 merit and trial, kept within [0.1, 0.5] alpha
    double next = 0.5 * alpha;
    if (trial.finite) {
      const double curvature = trial.merit - r.merit + 2 * alpha * r.merit;
      next = std::clamp(alpha * alpha * r.merit / curvature, 0.1 * alpha, 0.5 * alpha);
    }
    alpha = next;
    problem.move(alpha);
    trial = problem.evaluate();
    if (!falls(trial, r, alpha)) continue;
    r = trial;
    return true;
  }
  problem.move(0);
  r = problem.evaluate();
  return false;
}

/// From a full step that raised the merit: one more. @return true if the merit is then below `r`.
bool second_chance(Problem& problem, const ProblemResidual& r, ProblemResidual& after) {
  constexpr double kHopeless = 1e6;
  if (!after.finite || after.merit > kHopeless * r.merit) return false;
  if (!problem.find_direction(0)) return false;
  problem.keep();
  problem.move(1);
  after = problem.evaluate();
  return falls(after, r, 1);
}

enum class Moved { kNo, kOnce, kTwice };

Moved newton_step(Problem& problem, ProblemResidual& r) {
  problem.keep();
  problem.move(1);
  ProblemResidual trial = problem.evaluate();
  if (falls(trial, r, 1)) {
    r = trial;
    return Moved::kOnce;
  }
  const ProblemResidual full = trial;
  problem.move(0);
  problem.mark();
  problem.move(1);
  problem.evaluate();
  if (second_chance(problem, r, trial)) {
    r = trial;
    return Moved::kTwice;
  }
  problem.return_to_mark();
  problem.evaluate();
  if (!problem.find_direction(0)) return Moved::kNo;
  problem.keep();
  return backtrack(problem, r, full) ? Moved::kOnce : Moved::kNo;
}

Moved full_step(Problem& problem, ProblemResidual& r) {
  problem.keep();
  problem.move(1);
  r = problem.evaluate();
  return Moved::kOnce;
}

void polish(Problem& problem, const SolveOptions& options, SolveReport& report,
            ProblemResidual& r) {
  if (!problem.find_direction(0)) return;
  ++report.iterations;
  problem.keep();
  problem.move(1);
  const ProblemResidual trial = problem.evaluate();
  if (trial.finite && trial.largest <= options.tolerance) {
    r = trial;
    return;
  }
  problem.move(0);
  r = problem.evaluate();
}

}  // namespace

const char* to_string(SolveStatus status) {
  switch (status) {
    case SolveStatus::kConverged:
      return "converged";
    case SolveStatus::kStalled:
      return "stalled";
    case SolveStatus::kIterationLimit:
      return "iteration limit";
    case SolveStatus::kNotFinite:
      return "not finite";
    case SolveStatus::kWorkLimit:
      return "work limit";
    case SolveStatus::kSingular:
      break;
  }
  return "singular";
}

const char* to_string(SolveStage stage) {
  switch (stage) {
    case SolveStage::kNewton:
      return "Newton";
    case SolveStage::kLevenbergMarquardt:
      return "Levenberg-Marquardt";
    case SolveStage::kContinuation:
      return "continuation";
    case SolveStage::kRelaxation:
      break;
  }
  return "relaxation";
}

SolveReport newton(Problem& problem, const SolveOptions& options) {
  SolveReport report;
  const Counts before(problem);
  ProblemResidual r = problem.evaluate();
  report.initial_residual = r.largest;
  report.history.push_back(r.largest);
  while (true) {
    if (!r.finite) return finish(report, problem, before, r, SolveStatus::kNotFinite);
    if (r.largest <= options.tolerance) {
      if (options.polish && report.iterations == 0) polish(problem, options, report, r);
      return finish(report, problem, before, r, SolveStatus::kConverged);
    }
    if (report.iterations >= options.max_iterations || r.merit > options.max_merit)
      return finish(report, problem, before, r, SolveStatus::kIterationLimit);
    if (problem.work() > options.most_work)
      return finish(report, problem, before, r, SolveStatus::kWorkLimit);
    if (!problem.find_direction(0))
      return finish(report, problem, before, r, SolveStatus::kSingular);
    ++report.iterations;
    const Moved moved = options.bold ? full_step(problem, r) : newton_step(problem, r);
    if (moved == Moved::kTwice) ++report.iterations;
    report.history.push_back(r.largest);
    if (moved == Moved::kNo) return finish(report, problem, before, r, SolveStatus::kStalled);
  }
}

SolveReport levenberg_marquardt(Problem& problem, const SolveOptions& options) {
  SolveReport report;
  report.stage = SolveStage::kLevenbergMarquardt;
  const Counts before(problem);
  ProblemResidual r = problem.evaluate();
  report.initial_residual = r.largest;
  report.history.push_back(r.largest);
  double mu = 1e-3, growth = 2;
  while (true) {
    if (!r.finite) return finish(report, problem, before, r, SolveStatus::kNotFinite);
    if (r.largest <= options.tolerance)
      return finish(report, problem, before, r, SolveStatus::kConverged);
    if (report.iterations >= options.max_iterations)
      return finish(report, problem, before, r, SolveStatus::kIterationLimit);
    if (problem.work() > options.most_work)
      return finish(report, problem, before, r, SolveStatus::kWorkLimit);
    ++report.iterations;
    const bool found = problem.find_direction(mu);
    ProblemResidual trial;
    trial.finite = false;
    problem.keep();
    if (found) {
      problem.move(1);
      trial = problem.evaluate();
    }
    if (found && trial.finite && trial.merit < r.merit) {
      const double promised = r.merit - problem.predicted_merit();
      const double gain = promised > 0 ? (r.merit - trial.merit) / promised : 1;
      mu *= std::max(1. / 10, 1 - std::pow(2 * gain - 1, 3));
      growth = 2;
      r = trial;
    } else {
      // without a direction nothing was moved, and there is nothing to move along
      if (found) {
        problem.move(0);
        r = problem.evaluate();
      }
      mu *= growth;
      growth *= 2;
      if (mu > 1e12) return finish(report, problem, before, r, SolveStatus::kStalled);
    }
    report.history.push_back(r.largest);
  }
}

void add_counts(SolveReport& total, const SolveReport& part) {
  total.iterations += part.iterations;
  total.evaluations += part.evaluations;
  total.factorizations += part.factorizations;
  total.history.insert(total.history.end(), part.history.begin(), part.history.end());
  total.status = part.status;
  total.residual = part.residual;
  total.growth = part.growth;
  total.worst_row = part.worst_row;
}

SolveReport continuation(Problem& problem, const SolveOptions& options) {
  SolveReport total;
  total.stage = SolveStage::kContinuation;
  SolveOptions inner = options;
  inner.max_iterations = 12;
  constexpr double kSmallestFraction = 1e-3;
  double done = 0, step = 0.25;
  while (done < 1) {
    const double target = std::min(1.0, done + step);
    problem.set_fraction(target);
    // intermediate points need no precision, only to stay on the branch
    inner.tolerance = target < 1 ? std::max(options.tolerance, 1e-4) : options.tolerance;
    inner.max_iterations = target < 1 ? 12 : options.max_iterations;
    const SolveReport part = newton(problem, inner);
    add_counts(total, part);
    if (part.converged()) {
      done = target;
      step *= 2;
      continue;
    }
    step /= 4;
    if (step < kSmallestFraction || part.status == SolveStatus::kWorkLimit) break;
    problem.set_fraction(done);
    problem.restart();
    if (done > 0) {
      // walk back up to the last good fraction in one solve; if that fails too the branch is lost
      SolveOptions back = inner;
      back.tolerance = 1e-4;
      double reached = 0, stride = done;
      while (reached < done && stride > kSmallestFraction) {
        problem.set_fraction(std::min(done, reached + stride));
        const SolveReport again = newton(problem, back);
        add_counts(total, again);
        if (again.converged()) {
          reached += stride;
        } else if (again.status == SolveStatus::kWorkLimit) {
          break;
        } else {
          problem.restart();
          reached = 0;
          stride /= 4;
        }
      }
      if (reached < done) break;
    }
  }
  problem.set_fraction(1);
  return total;
}

SolveReport relaxation(Problem& problem, const SolveOptions& options) {
  SolveReport total;
  total.stage = SolveStage::kRelaxation;
  SolveOptions inner = options;
  inner.max_iterations = 12;
  inner.tolerance = 1e-6;
  // assembly gaps close first, under strong drag; then the drag follows the residual, down as it
  // falls and up as it grows, which is what leads away from an unstable equilibrium
  constexpr int kSteps = 400, kFew = 8;
  constexpr double kNoDrag = 1e-3;
  double drag = 10, fraction = options.assembled ? 1 : 0, last_residual = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double target = std::min(1.0, fraction + 0.1);
    problem.set_fraction(target);
    if (options.brisk) problem.remember();
    problem.set_relaxation(drag);
    const SolveReport part = newton(problem, inner);
    add_counts(total, part);
    if (!part.converged()) {
      drag *= 8;
      if (drag > 1e9 || part.status == SolveStatus::kWorkLimit) break;
      if (options.brisk) {
        problem.recall();
        problem.evaluate();  // what drags is measured from there
      }
      continue;
    }
    fraction = target;
    if (fraction < 1) continue;
    problem.set_relaxation(0);
    const double residual = problem.evaluate().largest;
    const bool falling = residual < last_residual;
    const bool easy = options.brisk && falling && part.iterations <= kFew;
    if (last_residual > 0) drag *= std::clamp(residual / last_residual, 0.25, easy ? 0.5 : 2.0);
    last_residual = residual;
    const bool there = residual <= 10 * inner.tolerance || (falling && drag <= kNoDrag);
    if (!there) continue;
    const SolveReport last = newton(problem, options);
    add_counts(total, last);
    if (last.converged()) return total;
    if (last.status == SolveStatus::kWorkLimit) break;
    drag = 100 * kNoDrag;
  }
  problem.set_relaxation(0);
  total.residual = problem.evaluate().largest;
  total.worst_row = problem.worst_row();
  if (total.converged()) total.status = SolveStatus::kIterationLimit;
  return total;
}

}  // namespace cprsim
