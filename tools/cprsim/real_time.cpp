// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/real_time.h"

#include <algorithm>
#include <cmath>

#include "tools/cprsim/quiet_run.h"
#include "tools/cprsim/stopwatch.h"

namespace cprsim {

namespace {

constexpr double kReserve = 1.25;  // trials must be so much faster: machines are not always alike
constexpr double kCoarsest = 0.1;  // of the longest rod
constexpr int kDecades = 9;
constexpr double kApart = 9.9;  // of the accuracies of two runs whose distance tells the error

}  // namespace

RealTimeSearch::RealTimeSearch(const Scene& scene, double factor) : scene_(scene) {
  report_.asked = factor;
  free_settings(scene_.solver);
  scene_.accuracy_goal.reset();
  for (const RodSpec& rod : scene.rods)
    length_ = std::max(length_, rod.length);
}

Scene RealTimeSearch::with_accuracy(double accuracy) const {
  Scene scene = scene_;
  scene.solver.accuracy = accuracy;
  scene.solver.residual_tolerance = residual_for(scene);
  return scene;
}

/// @return nothing if the run was too slow, failed or was stopped
std::optional<RealTimeSearch::Trial> RealTimeSearch::attempt(double accuracy,
                                                             const std::function<bool()>& stop) {
  const Scene scene = with_accuracy(accuracy);
  Trial trial{accuracy, 0, AnswerTrack(scene)};
  const double most = scene.simulation.duration / (kReserve * report_.asked);
  const Stopwatch watch;
  bool late = false;
  // the very first one shows how far away from real time its coarsest settings are
  const bool first = report_.runs++ == 0;
  const QuietRun run = run_quietly(scene, onlooker(trial.track), [&] {
    late = watch.seconds() > most;
    return (late && !first) || stop();
  });
  if (run.status != RunStatus::kDone) return std::nullopt;
  const double wall = run.statistics.start_seconds + run.statistics.step_seconds;
  trial.factor = run.time / std::max(wall, 1e-9);
  if (first || trial.factor >= kReserve * report_.asked) return trial;
  return std::nullopt;
}

void RealTimeSearch::choose(const Trial& trial) {
  report_.accuracy = trial.accuracy;
  report_.factor = trial.factor;
  report_.estimate.reset();
  const Trial* looser = nullptr;
  for (const Trial& other : kept_up_)
    if (other.accuracy >= kApart * trial.accuracy &&
        (looser == nullptr || other.accuracy < looser->accuracy))
      looser = &other;
  if (looser != nullptr)
    report_.estimate = estimated_error(farthest(looser->track, trial.track), kApart);
}

void RealTimeSearch::run(const std::function<bool()>& stop) {
  double best = kCoarsest * length_;
  const auto keeps_up = [&](double accuracy) {
    std::optional<Trial> trial = attempt(accuracy, stop);
    if (!trial) return false;
    choose(*trial);
    kept_up_.push_back(std::move(*trial));
    best = accuracy;
    return report_.kept_up();
  };
  report_.accuracy = best;
  bool more = keeps_up(best);
  for (int decade = 1; more && decade <= kDecades; ++decade)
    more = keeps_up(0.1 * best);
  // within the last decade
  if (!kept_up_.empty() && report_.kept_up())
    for (const double exponent : {0.5, 0.25})
      keeps_up(best * std::pow(10, -exponent));
  scene_ = with_accuracy(report_.accuracy);
}

}  // namespace cprsim
