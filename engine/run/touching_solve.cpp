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

namespace {

/// In units of the robot's own stiffness: within 1/100 of the length a rod gives way to it.
constexpr double kHold = 1e8;

}  // namespace

SolveReport hold_shape(Equations& equations, const SolveOptions& options) {
  constexpr double kLeast = 1e4;
  const RobotUnknowns given = equations.unknowns();
  SolveReport total;
  equations.hold_bodies(true);
  equations.set_relaxation(kHold * equations.limpness());
  // too stiff springs resist what the ends demand
  for (double hold = kHold * equations.limpness(); hold >= kLeast; hold *= 0.1) {
    equations.set_unknowns(given);
    equations.hold_marked(hold);
    add(total, newton(equations, options));
    if (total.converged()) break;
  }
  equations.set_relaxation(0);
  equations.hold_bodies(false);
  return total;
}

SolveReport relax_from_shape(RodContacts& contacts, Equations& equations,
                             const SolveOptions& options) {
  constexpr int kMostSteps = 1000, kMostReturns = 5, kMostPasses = 8;
  // bodies stay where they are while rods come loose
  constexpr double kNoDrag = 1e-3, kLoose = 1e3;
  SolveOptions inner = options;
  inner.tolerance = std::max(options.tolerance, 1e-6);
  SolveReport total;
  int returns = 0;
  const auto solve = [&](const SolveOptions& settings) {
    SolveReport part = newton(equations, settings);
    if (!part.converged() && contacts.ease()) {
      // past the kinks between stick and slip
      SolveOptions bold = settings;
      bold.bold = true;
      add(part, newton(equations, bold));
    }
    return settle_contacts(contacts, equations, settings, part);
  };
  // friction is bounded by what pressed a pass before, until that is what presses
  const auto settle = [&](const SolveOptions& settings) {
    SolveReport part = solve(settings);
    add(total, part);
    for (int pass = 0; part.converged() && pass < kMostPasses && contacts.bound_by_pressure();
         ++pass) {
      part = solve(settings);
      add(total, part);
    }
    return part.converged() && !contacts.leapt();
  };
  equations.accept_contacts();
  const double hold = kHold * equations.limpness();
  contacts.lag_friction(true);
  double drag = hold;
  for (int step = 0; step < kMostSteps && drag <= hold; ++step) {
    const RobotUnknowns from = equations.unknowns();
    equations.hold_bodies(drag > kLoose);
    equations.evaluate();
    equations.set_relaxation(drag);
    contacts.begin_step();
    if (!settle(inner)) {
      equations.set_unknowns(from);
      if (total.status == SolveStatus::kWorkLimit) break;
      drag *= 8;
      continue;
    }
    equations.accept_contacts();
    drag *= 0.5;
    if (drag > kNoDrag) continue;
    equations.set_relaxation(0);
    contacts.begin_step();
    if (settle(options)) {
      contacts.grip_what_rests();
      break;
    }
    equations.set_unknowns(from);
    drag = 100 * kNoDrag;
    if (total.status == SolveStatus::kWorkLimit || ++returns == kMostReturns) break;
  }
  equations.hold_bodies(false);
  equations.set_relaxation(0);
  contacts.lag_friction(false);
  if (total.converged() && drag > kNoDrag) total.status = SolveStatus::kIterationLimit;
  total.stage = SolveStage::kRelaxation;
  return total;
}

}  // namespace cprsim
