// SPDX-License-Identifier: BSD-3-Clause
// The ladder of solvers that finds a static equilibrium from the scene alone.
#include <cmath>

#include "engine/solve/newton.h"

namespace cprsim {

namespace {

// Rods that stretch as easily as they bend can be brought together in a few steps; then they
// harden.
void soft_start(Problem& problem, const SolveOptions& options, SolveReport& total) {
  SolveOptions rough;
  rough.most_work = options.most_work;
  rough.tolerance = 1e-2;
  rough.max_iterations = 15;
  for (const double softness : {2e-2, 2e-3}) {
    problem.set_softness(softness);
    add_counts(total, newton(problem, rough));
  }
  problem.set_softness(0);
}

}  // namespace

SolveReport hardening(Problem& problem, const SolveOptions& options) {
  SolveReport total;
  total.stage = SolveStage::kContinuation;
  SolveOptions rough = options;
  rough.tolerance = std::max(options.tolerance, 1e-4);
  rough.max_iterations = 15;
  // half a decade at a time, to where rods are as stiff as they are for all purposes
  for (double softness = 0.1; softness > 5e-6; softness /= std::sqrt(10.0)) {
    problem.set_softness(softness);
    add_counts(total, newton(problem, rough));
  }
  problem.set_softness(0);
  add_counts(total, newton(problem, options));
  return total;
}

namespace {

/// Each part by itself. @return whether all of them are in their places
bool bring_together(Problem& problem, const SolveOptions& options) {
  bool all = true;
  for (const std::unique_ptr<Problem>& part : problem.take_apart()) {
    if (solve_statics(*part, options).converged()) continue;
    all = false;
    part->restart();
    part->break_symmetry();
  }
  problem.put_together();
  return all;
}

}  // namespace

SolveReport solve_statics(Problem& problem, const SolveOptions& options) {
  struct Rung {
    SolveReport (*solve)(Problem&, const SolveOptions&);
    bool soft, bowed, gaping;  ///< gaping: only where parts must be brought together
    bool together = false;     ///< each by itself before
  };

  const Rung rungs[] = {{newton, true, false, false},
                        {newton, false, true, true},
                        {levenberg_marquardt, true, false, false},
                        {hardening, false, false, true},
                        {continuation, false, false, false},
                        {relaxation, false, true, true},
                        {relaxation, true, false, true},
                        {relaxation, false, false, false},
                        {newton, false, false, true, true},
                        {relaxation, false, false, true, true}};
  SolveReport total;
  const ProblemResidual first = problem.evaluate();
  total.initial_residual = first.largest;
  const bool gaping = problem.wants_soft_start() && first.largest > options.tolerance;
  for (const Rung& rung : rungs) {
    if (rung.gaping && !gaping) continue;
    if (rung.bowed) {
      problem.break_symmetry();
      problem.evaluate();
    }
    if (rung.soft && gaping) soft_start(problem, options, total);
    const bool assembled = rung.together && bring_together(problem, options);
    SolveOptions own = options;
    own.assembled = options.assembled || assembled;
    own.brisk = options.brisk || rung.together;
    const SolveReport part = rung.solve(problem, own);
    add_counts(total, part);
    total.stage = part.stage;
    if (part.converged()) return total;
    problem.set_fraction(1);
    problem.set_relaxation(0);
    problem.restart();
    if (total.status == SolveStatus::kWorkLimit) break;
  }
  return total;
}

}  // namespace cprsim
