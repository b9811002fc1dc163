// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/accuracy_control.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/cprsim/build_simulation.h"
#include "tools/cprsim/quiet_run.h"

namespace cprsim {

namespace {

constexpr int kInstants = 200;
constexpr int kPlaces = 8;              // along a rod
constexpr double kLooser = 10;          // asked of the pilot
constexpr double kShare = 3;            // (1)
constexpr double kLeastOrder = 2. / 3;  // kappa of (1)
constexpr int kMostRuns = 5;
constexpr double kLeastAccuracy = 1e-12;  // m; what a scene may ask for
constexpr double kRoundOff = 1e-9;        // of a step: times are sums of rounded steps

std::vector<Resolution> resolution_of(const Scene& scene) {
  std::vector<Resolution> all;
  const auto simulation = build_simulation(scene);
  for (const RodFacts& rod : simulation->facts().rods)
    all.push_back({rod.method, rod.elements, rod.order});
  return all;
}

/// Every rod into half as many pieces again, of an order more, or into two thirds and one less. A
/// resolution also says which method it is for: each rod keeps its own.
Scene cut(Scene scene, const std::vector<Resolution>& rods, bool finer) {
  const auto pick = [&](std::optional<int>& of_all, int n) {
    of_all = !of_all ? n : finer ? std::max(*of_all, n) : std::min(*of_all, n);
  };
  SolverSpec& solver = scene.solver;
  solver.points.reset();
  solver.elements.reset();
  solver.order.reset();
  for (std::size_t i = 0; i < rods.size(); ++i) {
    const auto& [method, elements, order] = rods[i];
    scene.rods[i].method = method;
    pick(method == Method::kShooting ? solver.points : solver.elements,
         finer ? (3 * elements + 1) / 2 : std::max(1, elements * 2 / 3));
    if (method == Method::kStrain) pick(solver.order, std::max(1, order + (finer ? 1 : -1)));
  }
  return scene;
}

/// Steps of this scheme are what the scene says, whatever the error.
bool takes_fixed_steps(const Scene& scene) {
  return scene.simulation.mode == Mode::kDynamic &&
         (scene.solver.step || !adapts(scene.solver.scheme.value_or(SchemeKind::kEsdirk32)));
}

/// The same with everything ten times looser, what the scene fixes included.
Scene looser(const Scene& scene) {
  Scene pilot = scene;
  SolverSpec& solver = pilot.solver;
  solver.accuracy = kLooser * *solver.accuracy;
  if (solver.tolerance) solver.tolerance = kLooser * *solver.tolerance;
  if (takes_fixed_steps(scene)) solver.step = 2 * solver.step.value_or(scene.max_step_size);
  if (solver.points) solver.points = std::max(1, *solver.points * 2 / 3);
  if (solver.elements) solver.elements = std::max(1, *solver.elements * 2 / 3);
  if (solver.order) solver.order = std::max(1, *solver.order - 1);
  return pilot;
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
  constexpr double kShareOfError = 1e-2, kDefault = 1e-9, kLeast = 1e-13;
  return std::clamp(kShareOfError * *scene.solver.accuracy / longest_rod(scene), kLeast, kDefault);
}

double estimated_error(const AnswerTrack& looser, const AnswerTrack& track, double times) {
  const auto of = [](double ratio) { return std::pow(ratio, kLeastOrder) - 1; };
  return farthest(looser, track) / (kShare * of(std::max(times, kLooser)) / of(kLooser));
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

AnswerTrack::AnswerTrack(const Scene& scene)
    : end_(scene.simulation.mode == Mode::kStatic ? 0 : scene.simulation.duration),
      goal_(scene.accuracy_goal) {
  if (!goal_) return;
  if (!goal_->channels.empty()) reader_.emplace(scene, goal_->channels);
  if (!goal_->relative) return;
  size_ = goal_->channels.empty() ? longest_rod(scene) : 0;
}

void AnswerTrack::record(const Snapshot& snapshot) {
  std::vector<Vec3>& all = answers_.emplace_back();
  if (reader_) {
    for (const double value : reader_->read(snapshot)) {
      all.emplace_back(value, 0, 0);
      if (goal_->relative) size_ = std::max(size_, std::abs(value));
    }
    return;
  }
  for (const BodySample& body : snapshot.bodies)
    all.push_back(body.X_WB.p);
  for (const RodSample& rod : snapshot.rods)
    for (int k = 1; k <= kPlaces; ++k)
      all.push_back(point_at(rod, static_cast<double>(k) / kPlaces).position);
}

void AnswerTrack::begin(const Snapshot& start) {
  answers_.clear();
  record(start);
}

void AnswerTrack::step(const Snapshot& before, const Snapshot& now) {
  const double slack = kRoundOff * (now.time - before.time);
  for (auto k = answers_.size(); k <= kInstants; ++k) {
    const double t = end_ * static_cast<double>(k) / kInstants;
    if (t > now.time + slack) return;
    record(interpolate(before, now, std::min(t, now.time)));
  }
}

double farthest(const AnswerTrack& a, const AnswerTrack& b) {
  double most = 0;
  for (std::size_t k = 0; k < std::min(a.answers_.size(), b.answers_.size()); ++k)
    for (std::size_t i = 0; i < std::min(a.answers_[k].size(), b.answers_[k].size()); ++i)
      most = std::max(most, (a.answers_[k][i] - b.answers_[k][i]).norm());
  return b.size_ > 0 ? most / b.size_ : most;
}

AccuracyControl::AccuracyControl(const Scene& scene)
    : scene_(scene), asked_(scene.solver.accuracy) {
  track_.emplace(scene_);
  if (!asked_) return;
  report_.asked = scene.accuracy_goal ? scene.accuracy_goal->error : *asked_;
  report_.unit = unit_of(scene);
  report_.held_back = fixed_by(scene);
  residual_is_ours_ = !scene.solver.residual_tolerance;
  if (residual_is_ours_) scene_.solver.residual_tolerance = residual_for(scene_);
}

void AccuracyControl::fly_pilot(const std::function<bool()>& stop) {
  Scene scene = looser(scene_);
  // at its coarsest the formula gives the pilot no fewer pieces, and no error would be seen
  const auto resolution = resolution_of(scene_);
  if (!resolution.empty() && resolution == resolution_of(scene))
    scene = cut(scene, resolution, false);
  pilot_.emplace(scene);
  const QuietRun run = run_quietly(scene, onlooker(*pilot_), stop);
  ++report_.runs;
  report_.evaluations += run.statistics.section_evaluations;
  // so coarse that it came to nothing: the next run will be another one's pilot
  if (run.status != RunStatus::kDone) pilot_.reset();
}

// Where the formula gives no more pieces for less error, what is left of it along the rods would
// not be seen.
void AccuracyControl::cut_finer(const std::vector<Resolution>& last) {
  if (!last.empty() && resolution_of(scene_) == last) scene_ = cut(scene_, last, true);
}

bool AccuracyControl::refine(long evaluations) {
  constexpr double kAim = 0.3;  // of what is asked for
  ++report_.runs;
  report_.estimate =
      pilot_ ? estimated_error(*pilot_, *track_, times_) : std::numeric_limits<double>::infinity();
  const bool at_the_end = *scene_.solver.accuracy <= kLeastAccuracy;
  const bool settled =
      report_.reached() || at_the_end || report_.runs >= kMostRuns || !report_.held_back.empty();
  if (settled) return false;
  report_.evaluations += evaluations;
  const auto last = resolution_of(scene_);
  const double factor =
      pilot_ ? std::clamp(kAim * report_.asked / report_.estimate, 1e-3, 1 / kLooser) : 1 / kLooser;
  const double before = *scene_.solver.accuracy;
  scene_.solver.accuracy = std::max(kLeastAccuracy, factor * before);
  times_ = before / *scene_.solver.accuracy;
  if (residual_is_ours_) scene_.solver.residual_tolerance = residual_for(scene_);
  cut_finer(last);
  pilot_ = std::move(track_);
  track_.emplace(scene_);
  return true;
}

}  // namespace cprsim
