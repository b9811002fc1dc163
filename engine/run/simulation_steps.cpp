// SPDX-License-Identifier: BSD-3-Clause
// One step after another: time steps, and equilibria where nothing has inertia.
#include <algorithm>
#include <cmath>

#include "engine/run/simulation_parts.h"

namespace cprsim {
namespace {

// Steps of backward Euler from a change of contact on: the change itself, one that takes the
// velocity into the obstacle out, one that takes its acceleration out; and their size over that of
// the largest step where the scheme chooses it.
constexpr int kCushionedSteps = 3;
constexpr double kCushion = 0.1;
// Steps that shrink below this part of max_step_size before they converge creep up to a contact
// that they will not get over.
constexpr double kShortest = 1. / 128;
// A step of the scheme that touches something and makes more energy is taken by backward Euler
// instead.
constexpr double kMostGain = 1e-3;

// Instants are sums of steps: after a million of them the end is off by some 1e-5 of a step. What
// is left is taken with the last step, not by one that is a hundred thousand times shorter.
constexpr double kSliver = 1e-4;

// What is rescued may be halved so much more often: nothing is thrown in short steps.
constexpr int kRescueRetries = 8;

}  // namespace

void Simulation::Parts::arrive(double t_new, double h_used, const Marcher::Outcome& outcome) {
  marcher.accept();
  settle(t_new, h_used, outcome);
}

/// The robot is at t_new: everybody else follows.
void Simulation::Parts::settle(double t_new, double h_used, const Marcher::Outcome& outcome) {
  t = t_new;
  report = outcome.report;
  count(report);
  if (free_bodies) {
    const PhaseTimer timer(robot.clock, Phase::kFreeBodies);
    free_bodies->advance(h_used, link_motions(robot, free_bodies.get()));
  }
  ledger.close_step(t, outcome.damping_loss, outcome.drive_work, cushioned > 0);
  ++statistics.steps;
  statistics.largest_step = std::max(statistics.largest_step, h_used);
  statistics.smallest_step =
      statistics.steps == 1 ? h_used : std::min(statistics.smallest_step, h_used);
  if (t >= end) status = RunStatus::kDone;
}

// After a cushioned step: on with it where contacts still change, else back to the scheme.
void Simulation::Parts::soften(bool touched) {
  cushioned = touched ? kCushionedSteps : cushioned - 1;
  if (cushioned > 0) return;
  marcher.cushion(false);
  last_error = 0;
  if (plan.adaptive) h = std::min(h, 1e-3);
}

/// Whether a step must be taken again for the sake of contacts: shorter, or cushioned.
bool Simulation::Parts::contacts_object(const Marcher::Outcome& outcome, double step,
                                        double& target) {
  const bool impact = outcome.converged && cushioned == 0 &&
                      (outcome.struck || gain(t + step, outcome) > kMostGain);
  // long steps are for flight
  const bool far = outcome.converged && outcome.touched && plan.adaptive &&
                   step > scene.max_step_size * (1 + 1e-9);
  if (!outcome.leapt && !impact && !far) return false;
  marcher.reject();
  ++statistics.rejected;
  // what gives can be followed into contact, in shorter steps
  const bool softly = impact && !outcome.struck && plan.adaptive &&
                      step > kCushion * scene.max_step_size * (1 + 1e-9);
  if (outcome.leapt || far || softly) {
    target = 0.5 * step;
    return true;
  }
  marcher.cushion(true);
  cushioned = kCushionedSteps;
  if (plan.adaptive) target = std::min(target, kCushion * scene.max_step_size);
  return true;
}

/// How much energy a step would make, over what has been about so far.
double Simulation::Parts::gain(double t_new, const Marcher::Outcome& outcome) const {
  if (!contacts.touching() && cushioned == 0) return 0;
  EnergyLedger trial = ledger;
  const EnergySample old = trial.sample();
  trial.close_step(t_new, outcome.damping_loss, outcome.drive_work, cushioned > 0);
  const double known = old.kinetic + old.elastic + old.dissipated + std::abs(old.work);
  return known > 0 ? (trial.sample().balance - old.balance) / known : 0;
}

void Simulation::Parts::step_dynamic() {
  const int retries = scene.solver.halve_on_failure ? scene.solver.retries : 0;
  const double on_course = next_of_course();
  const bool retraces = std::isfinite(on_course);
  const double stop = next_break();
  ledger.begin_step(t);
  double target = retraces ? on_course - t : h;
  if (!retraces && plan.adaptive && (free_bodies || contacts.touching() || cushioned > 0))
    target = std::min(target, scene.max_step_size);
  // Backward Euler from a distance, once: points that chatter in short steps settle in a longer
  // one.
  bool rescued = false, lagged = false, halved = false;
  const auto rescue = [&](double& to) {
    rescued = true;
    marcher.cushion(true);
    cushioned = kCushionedSteps;
    to = scene.max_step_size;
    ++statistics.retried;
  };
  for (int failures = 0;; ++failures) {
    const double left = stop - t;
    // land on the break; in adaptive mode without leaving a sliver
    double step = target >= left * (1 - (plan.adaptive ? 1e-9 : kSliver)) ? left : target;
    if (plan.adaptive && !retraces && step < left && left < 2 * step) step = 0.5 * left;
    const Marcher::Outcome outcome = marcher.attempt(t, step, ledger);
    if (contacts_object(outcome, step, target)) {
      failures = -1;
      if (target > 1e-12 * std::max(1.0, end)) continue;
      fail(Failure::kContact,
           "a rod would pass through an obstacle at t = " + short_number(t) + " s");
      return;
    }
    if (outcome.converged && gain(t + step, outcome) > 1) {
      marcher.reject();
      report = outcome.report;
      if (rescued) {
        fail(Failure::kContact,
             "contact would throw a rod at t = " + short_number(t) +
                 " s: it has sunk between the points that are held, its cells are too long");
        return;
      }
      rescue(target);
      failures = -1;
      continue;
    }
    const bool accurate = !plan.adaptive || retraces || outcome.error <= plan.tolerance;
    if (outcome.converged && accurate) {
      const bool landed = step == left;
      if (plan.adaptive && cushioned == 0) {
        const double next = controlled(step, outcome.error);
        h = landed && step < 0.5 * target ? std::max(target, next) : next;
        last_error = outcome.error;
      }
      // what had to be halved would have to be again
      if (plan.adaptive && cushioned > 0 && !retraces)
        h = halved ? step : std::min(scene.max_step_size, std::max(h, 2 * step));
      const double there = retraces && step == on_course - t ? on_course : t + step;
      arrive(landed ? stop : there, step, outcome);
      contacts.lag_friction(false);
      if (cushioned > 0) soften(outcome.touched);
      if (landed && t < end) {
        marcher.restart();
        last_error = 0;
        if (plan.adaptive) h = std::min(h, 1e-3);
      } else if (ledger.speeds_jumped()) {
        // the acceleration that this step ends with is that of the jump: nothing is to go on from
        // it
        marcher.restart();
      }
      return;
    }
    marcher.reject();
    if (outcome.converged) {
      ++statistics.rejected;
      failures = -1;
      target = controlled(step, outcome.error);
      last_error = 0;
      if (target > 1e-12 * std::max(1.0, end)) continue;
    }
    report = outcome.report;
    // what is asked for is that many retries below the step that a scene with a fixed one takes
    if (plan.adaptive && step > scene.max_step_size) failures = -1;
    // where Coulomb's law finds no rest
    if (!outcome.converged && cushioned > 0 && !lagged && contacts.any()) {
      lagged = true;
      contacts.lag_friction(true);
      --failures;
      continue;
    }
    const bool creeps = plan.adaptive && step < kShortest * scene.max_step_size;
    if ((failures >= retries || creeps) && contacts.any() && !rescued) {
      rescue(target);
      failures = -1;
      continue;
    }
    if (failures >= (rescued ? retries + kRescueRetries : retries) ||
        target <= 1e-12 * std::max(1.0, end)) {
      fail("step failed at t = " + short_number(t) + " s with a step of " + short_number(step) +
           " s");
      return;
    }
    ++statistics.retried;
    halved = true;
    target = 0.5 * step;
  }
}

namespace {

/// Of this step, after t: where one was halved, or a break lay between, the next ones come back to
/// the instants that a scene records, between which positions are not known but joined by lines.
double next_multiple(double t, double step) {
  return step * (std::floor(t / step + kSliver) + 1);
}

}  // namespace

void Simulation::Parts::step_quasistatic() {
  const double stop = std::min(next_break(), next_multiple(t, plan.step));
  double target = plan.step;
  const RobotUnknowns start = equations.unknowns();
  const double from = t, power = ledger.drive_power(t, false);
  ledger.begin_step(t);
  for (int failures = 0;; ++failures) {
    const double step = std::min(target, stop - from);
    t = step >= (stop - from) * (1 - kSliver) ? stop : from + step;
    equations.set_instant(t, true, StageRates{});
    SolveOptions options = static_options(scene.solver);
    options.most_work = equations.work() + kMostStaticWork;
    contacts.begin_step();
    report = newton(equations, options);
    if (!report.converged()) {
      equations.set_unknowns(start);
      report = levenberg_marquardt(equations, options);
    }
    if (contacts.any()) report = settle_contacts(contacts, equations, options, report);
    count(report);
    if (report.converged() && !contacts.leapt()) {
      start_motion();
      equations.accept_equilibrium(t);
      ledger.close_step(t, 0,
                        0.5 * step * (power + ledger.drive_power(t, true)) + ledger.effort_work(t));
      ++statistics.steps;
      if (t >= end) status = RunStatus::kDone;
      return;
    }
    equations.set_unknowns(start);
    t = from;
    if (failures >= scene.solver.retries) {
      fail("no equilibrium found beyond t = " + short_number(from) + " s");
      return;
    }
    ++statistics.retried;
    target = 0.5 * step;
  }
}

}  // namespace cprsim
