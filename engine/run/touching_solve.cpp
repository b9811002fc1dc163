// SPDX-License-Identifier: BSD-3-Clause
#include "engine/run/touching_solve.h"

#include <algorithm>

namespace cprsim {
namespace {

void add(SolveReport& total, const SolveReport& part) {
  const int iterations = total.iterations + part.iterations;
  const int factorizations = total.factorizations + part.factorizations;
  const long evaluations = total.evaluations + part.evaluations;
  total = part;
  total.iterations = iterations;
  total.factorizations = factorizations;
  total.evaluations = evaluations;
}

}  // namespace

SolveReport settle_contacts(RodContacts& contacts, Problem& problem, const SolveOptions& options,
                            SolveReport first) {
  constexpr int kMostHeld = 3;
  int held = 0;
  for (int round = 0; first.converged() && contacts.revise(round); ++round) {
    if (round == RodContacts::kMostRounds) {
      first.status = SolveStatus::kStalled;
      first.worst_row = "which points touch";
      return first;
    }
    add(first, newton(problem, options));
    if (first.status == SolveStatus::kWorkLimit) return first;
    if (!first.converged() && contacts.ease()) {
      SolveOptions bold = options;
      bold.bold = true;
      add(first, newton(problem, bold));
    }
    if (!first.converged() && held < kMostHeld && contacts.hold()) {
      ++held;
      add(first, newton(problem, options));
    }
  }
  return first;
}

SolveReport load_gradually(RodContacts& contacts, Equations& equations,
                           const SolveOptions& options) {
  constexpr double kSmallestStep = 1e-5;
  equations.set_loads(false);
  equations.set_fraction(1);
  SolveReport total = solve_statics(equations, options);
  equations.set_loads(true);
  if (!total.converged()) return total;
  equations.accept_contacts();  // slip counts from the assembled robot
  double carried = 0, step = 1;
  while (carried < 1) {
    const RobotUnknowns from = equations.unknowns();
    const double target = std::min(1.0, carried + step);
    contacts.begin_step();
    equations.set_fraction(target);
    const SolveReport part =
        settle_contacts(contacts, equations, options, newton(equations, options));
    add(total, part);
    if (part.converged() && !contacts.leapt()) {
      carried = target;
      step *= 2;
      equations.accept_contacts();
      continue;
    }
    equations.set_unknowns(from);
    step = 0.25 * (target - carried);
    if (step >= kSmallestStep && part.status != SolveStatus::kWorkLimit) continue;
    if (total.converged()) {
      total.status = SolveStatus::kStalled;
      total.worst_row = "a rod that would pass through an obstacle";
    }
    break;
  }
  equations.set_fraction(1);
  total.loaded = carried;
  total.stage = SolveStage::kContinuation;
  return total;
}

}  // namespace cprsim
