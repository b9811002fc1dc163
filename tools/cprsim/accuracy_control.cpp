// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/accuracy_control.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tools/cprsim/quiet_run.h"

namespace cprsim {

namespace {

constexpr double kLooser = 10;          // asked of each pilot than of what follows
constexpr double kLeastOrder = 2. / 3;  // kappa of (1)
constexpr double kLikelyOrder = 0.85;   // likewise, to aim by
constexpr double kAim = 0.5;            // of what is asked for
constexpr double kSafety = 1.5;         // of kappa that is known from three runs only
constexpr double kMostGain = 30;        // that a run is believed to be nearer than to the last one
constexpr double kLeastAim = 0.2, kMostAim = 1e-3;  // of what the last run asked for
constexpr int kMostRuns = 7;
constexpr int kMostFailures = 5;
constexpr double kBolder = 64;            // after a failure: twice as many cells
constexpr double kLeastAccuracy = 1e-12;  // m; what a scene may ask for
constexpr double kUnknown = std::numeric_limits<double>::infinity();

/// Steps of this scheme are what the scene says, whatever the error.
bool takes_fixed_steps(const Scene& scene) {
  return scene.simulation.mode == Mode::kDynamic &&
         (scene.solver.step || !adapts(scene.solver.scheme.value_or(SchemeKind::kEsdirk32)));
}

/// The same, and what the scene fixes made ten times looser.
Scene looser(const Scene& scene) {
  Scene pilot = scene;
  SolverSpec& solver = pilot.solver;
  if (solver.tolerance) solver.tolerance = kLooser * *solver.tolerance;
  if (takes_fixed_steps(scene)) solver.step = 2 * solver.step.value_or(scene.max_step_size);
  if (solver.points) solver.points = std::max(1, *solver.points * 2 / 3);
  if (solver.elements) solver.elements = std::max(1, *solver.elements * 2 / 3);
  if (solver.order) solver.order = std::max(1, *solver.order - 1);
  return pilot;
}

/// kappa of (2), by bisection: the quotient grows with it.
double order_seen(double quotient, double times_1, double times_2, double least) {
  double low = least, high = kLikelyOrder;
  for (int i = 0; i < 40; ++i) {
    const double kappa = 0.5 * (low + high);
    const double a = std::pow(times_1, kappa), b = std::pow(times_2, kappa);
    (b * (a - 1) / (b - 1) > quotient ? high : low) = kappa;
  }
  return low;
}

double error_by(double distance, double times, double order) {
  return times > 1 ? distance / (std::pow(times, order) - 1) : kUnknown;
}

/// Of what is asked for, with what it is about.
std::string unit_of(const Scene& scene) {
  const auto& goal = scene.accuracy_goal;
  if (!goal) return "m";
  if (goal->of.empty()) return "of the longest rod";
  if (goal->relative) return "of " + goal->of;
  return (goal->channels.empty() ? "" : goal->channels.front().unit + " ") + "in " + goal->of;
}

std::string fixed_by(const Scene& scene) {
  const SolverSpec& solver = scene.solver;
  std::string text;
  const auto add = [&](bool fixed, const char* name) {
    if (fixed) text += (text.empty() ? "" : ", ") + std::string(name);
  };
  add(solver.tolerance.has_value(), "tolerance");
  add(takes_fixed_steps(scene), "step");
  add(solver.points.has_value(), "points");
  add(solver.elements.has_value(), "elements");
  add(solver.order.has_value(), "order");
  return text;
}

}  // namespace

double residual_for(const Scene& scene) {
  constexpr double kShareOfError = 1e-2, kDefault = 1e-9, kLeast = 1e-12;
  // a rod about to buckle turns a small residual into a large error
  if (scene.simulation.mode != Mode::kDynamic) return kLeast;
  return std::clamp(kShareOfError * *scene.solver.accuracy / longest_rod(scene), kLeast, kDefault);
}

double estimated_error(double distance, double times) {
  return error_by(distance, std::min(times, kLooser), kLeastOrder);
}

void free_settings(SolverSpec& solver) {
  solver.tolerance.reset();
  solver.step.reset();
  solver.points.reset();
  solver.elements.reset();
  solver.order.reset();
  solver.scheme.reset();
  solver.residual_tolerance.reset();
}

AccuracyControl::AccuracyControl(const Scene& scene)
    : scene_(scene), asked_(scene.solver.accuracy) {
  track_.emplace(scene_);
  if (!asked_) return;
  report_.asked = scene.accuracy_goal ? scene.accuracy_goal->error : *asked_;
  report_.unit = unit_of(scene);
  report_.held_back = fixed_by(scene);
  residual_is_ours_ = !scene.solver.residual_tolerance;
}

/// Makes this the scene to be run next: cut finer than what it will be compared with, by as much
/// as its error is to be smaller.
void AccuracyControl::begin(Scene scene) {
  if (residual_is_ours_) scene.solver.residual_tolerance = residual_for(scene);
  times_ = 1;
  if (!levels_.empty()) {
    const Level& last = levels_.back();
    times_ = *last.scene.solver.accuracy / *scene.solver.accuracy;
    if (report_.held_back.empty()) scene = cut(std::move(scene), last.resolution, times_);
  }
  scene_ = std::move(scene);
  resolution_ = resolution_of(scene_);
  // where nothing moves, nothing else is chosen
  if (!levels_.empty() && scene_.simulation.mode != Mode::kDynamic && report_.held_back.empty())
    times_ = times_smaller(levels_.back().resolution, resolution_);
  track_.emplace(scene_);
}

/// What scene() is to be after the last run, of which too large an error is to be feared. It is
/// likely to be smaller; and a run that differs little from the last one would tell little of it.
void AccuracyControl::aim(double feared) {
  const Level& last = levels_.back();
  const double likely = error_by(last.distance, last.times, kLikelyOrder);
  const double factor =
      std::isfinite(feared) ? kAim * report_.asked / std::sqrt(feared * likely) : kLeastAim;
  const double less = std::clamp(std::pow(factor, 1 / kLikelyOrder), kMostAim, kLeastAim);
  Scene scene = last.scene;
  scene.solver.accuracy = std::max(kLeastAccuracy, less * *scene.solver.accuracy);
  begin(std::move(scene));
}

/// Makes the scene of this run the one to be run next.
void AccuracyControl::repeat(const Level& level, double estimate) {
  scene_ = level.scene;
  track_.emplace(scene_);
  known_ = estimate;
}

/// Takes the run that got to its end among the levels.
void AccuracyControl::land(AnswerTrack track) {
  const double distance = levels_.empty() ? kUnknown : farthest(levels_.back().track, track);
  levels_.push_back({scene_, resolution_, times_, distance, std::move(track)});
}

bool AccuracyControl::fly(Scene scene, const std::function<bool()>& stop) {
  begin(std::move(scene));
  const QuietRun run = run_quietly(scene_, onlooker(*track_), stop);
  ++report_.runs;
  report_.evaluations += run.statistics.section_evaluations;
  report_.pilots_cpu_seconds += run.cpu_seconds;
  // so coarse that it came to nothing: the next run will be another one's pilot
  if (run.status != RunStatus::kDone) return false;
  land(std::move(*track_));
  return true;
}

void AccuracyControl::fly_pilots(const std::function<bool()>& stop) {
  const Scene wanted = scene_;
  const auto asking_for = [&](double times) {
    Scene scene = report_.held_back.empty() ? wanted : looser(wanted);
    scene.solver.accuracy = times * *asked_;
    return scene;
  };
  if (!report_.held_back.empty()) {
    fly(asking_for(kLooser), stop);
    begin(wanted);
    return;
  }
  const bool first = fly(asking_for(kLooser * kLooser), stop);
  const bool second = fly(asking_for(kLooser), stop);
  if (!first || !second) {
    begin(wanted);
    return;
  }
  const Level& last = levels_.back();
  const double error = estimated_error(last.distance, last.times);
  if (error <= report_.asked) {
    // one of them is good enough, and only remains to be run with all its outputs
    const double of_first = last.distance + error;
    if (of_first <= report_.asked)
      repeat(levels_.front(), of_first);
    else
      repeat(last, error);
    return;
  }
  aim(error);
}

double AccuracyControl::estimate() const {
  const std::size_t n = levels_.size();
  if (n < 2) return kUnknown;
  const Level& last = levels_[n - 1];
  if (n < 3 || last.distance == 0 || levels_[n - 2].times <= 1 || last.times <= 1)
    return estimated_error(last.distance, last.times);
  const Level& before = levels_[n - 2];
  // friction along a rod leaves shooting the first of its six orders, drag a motion half of its own
  const double least = scene_.simulation.mode == Mode::kDynamic ? 1. / 3 : 1. / 6;
  const double order = order_seen(before.distance / last.distance, before.times, last.times, least);
  const double error = kSafety * error_by(last.distance, last.times, order);
  return std::max(error, last.distance / kMostGain);
}

bool AccuracyControl::refine(long evaluations) {
  ++report_.runs;
  if (known_) {
    report_.estimate = *known_;
    return false;
  }
  land(std::move(*track_));
  report_.estimate = estimate();
  const bool at_the_end = *scene_.solver.accuracy <= kLeastAccuracy;
  const bool settled = report_.reached() || at_the_end || went_back_ || report_.runs >= kMostRuns ||
                       !report_.held_back.empty();
  if (settled) return false;
  report_.evaluations += evaluations;
  aim(report_.estimate);
  return true;
}

bool AccuracyControl::retry(long evaluations) {
  if (!report_.held_back.empty() || known_ || went_back_ || failures_++ >= kMostFailures)
    return false;
  ++report_.runs;
  report_.evaluations += evaluations;
  if (levels_.empty()) {
    scene_ = cut(scene_, resolution_, kBolder);
    resolution_ = resolution_of(scene_);
    track_.emplace(scene_);
    return true;
  }
  went_back_ = true;
  const Level last = levels_.back();
  levels_.pop_back();
  scene_ = last.scene;
  resolution_ = last.resolution;
  times_ = last.times;
  track_.emplace(scene_);
  return true;
}

}  // namespace cprsim
