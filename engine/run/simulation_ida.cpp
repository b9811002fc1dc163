// SPDX-License-Identifier: BSD-3-Clause
// Steps by IDA: smooth motion, without contact, as an independent reference for the other schemes.
#include "engine/run/simulation_parts.h"

namespace cprsim {
namespace {

constexpr double kStarter = 1e-3;   // of the largest step: after a jump, one of our own
constexpr double kLongestTurn = 1;  // rad, from the frame in which rotation vectors are measured
constexpr int kMostFailures = 3;
constexpr int kShorter = 10;  // starters that are tried, each half as long

double longest_turn(const std::vector<Track*>& tracks) {
  double longest = 0;
  for (const Track* track : tracks) {
    if (track->kind != Track::Kind::kRotation) continue;
    for (Eigen::Index i = 0; i + 3 <= track->x.size(); i += 3)
      longest = std::max(longest, track->x.segment<3>(i).norm());
  }
  return longest;
}

}  // namespace

/// Accelerations after a jump follow from a short step that needs none to begin with.
void Simulation::Parts::begin_ida(double stop) {
  double step = std::min(kStarter * scene.max_step_size, stop - t);
  for (int tries = 0; tries < kShorter; ++tries, step *= 0.5) {
    const Marcher::Outcome outcome = marcher.attempt(t, step, ledger);
    report = outcome.report;
    if (!outcome.converged) {
      marcher.reject();
      ++statistics.retried;
      continue;
    }
    const bool landed = step == stop - t;
    arrive(landed ? stop : t + step, step, outcome);
    marcher.begin();
    marcher.keep(t);
    ida->begin(t, step);
    if (landed) ida->stop();
    return;
  }
  fail("step failed at t = " + short_number(t) + " s");
}

void Simulation::Parts::step_by_ida() {
  const double stop = next_break(), from = t;
  ledger.begin_step(from);
  SolveReport total;
  if (!ida)
    ida = std::make_unique<IdaIntegrator>(
        marcher.tracks(), marcher.track_errors(), plan.tolerance,
        [this](double time, const StageRates& rates) {
          const SolveReport last = marcher.solve_at(time, rates);
          const int iterations = report.iterations + last.iterations,
                    factorizations = report.factorizations + last.factorizations;
          const long evaluations = report.evaluations + last.evaluations;
          report = last;
          report.iterations = iterations;
          report.factorizations = factorizations;
          report.evaluations = evaluations;
          return last.converged();
        });
  if (!ida->begun()) return begin_ida(stop);
  Marcher::Outcome outcome;
  const double loss = ledger.damping_power(), power = ledger.drive_power(from, false);
  report = {};
  const std::optional<double> reached = ida->advance(stop);
  outcome.report = report;
  if (!reached) {
    if (++ida_failures > kMostFailures) {
      fail("ida found no step beyond t = " + short_number(from) + " s");
      return;
    }
    // its past may not go on smoothly: forget it
    ++statistics.retried;
    marcher.go_back();
    marcher.accept();
    marcher.restart();
    return begin_ida(stop);
  }
  ida_failures = 0;
  statistics.rejected += ida->take_rejected();
  const bool landed = *reached >= stop;
  const double step = *reached - from;
  outcome.damping_loss = 0.5 * step * (loss + ledger.damping_power());
  outcome.drive_work = 0.5 * step * (power + ledger.drive_power(*reached, true));
  settle(landed ? stop : *reached, step, outcome);
  marcher.keep(t);
  if (landed && t < end) {
    marcher.accept();
    marcher.restart();
    ida->stop();
  } else if (longest_turn(marcher.tracks()) > kLongestTurn) {
    marcher.accept();
    // at order 1, and velocities that satisfied no more than the formula: small steps forget it
    ida->begin(t, std::min(ida->next_step(), kStarter * scene.max_step_size));
  }
}

}  // namespace cprsim
