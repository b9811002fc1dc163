// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/accuracy_control.h"

#include <algorithm>
#include <cmath>

#include "tools/cprsim/build_simulation.h"
#include "tools/cprsim/quiet_run.h"

namespace cprsim {

namespace {

constexpr int kInstants = 200;
constexpr double kLooser = 10;  // asked of the pilot
constexpr double kShare = 3;    // (1)
constexpr int kMostRuns = 5;
constexpr double kLeastAccuracy = 1e-12;  // m; what a scene may ask for
constexpr double kRoundOff = 1e-9;        // of a step: times are sums of rounded steps

/// What every rod is cut into: pieces, and the order on them.
std::vector<std::pair<int, int>> resolution_of(const Scene& scene) {
  std::vector<std::pair<int, int>> all;
  const auto simulation = build_simulation(scene);
  for (const RodFacts& rod : simulation->facts().rods)
    all.emplace_back(rod.elements, rod.order);
  return all;
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
  double length = 0;
  for (const RodSpec& rod : scene.rods)
    length = std::max(length, rod.length);
  return std::clamp(kShareOfError * *scene.solver.accuracy / std::max(length, 1e-3), kLeast,
                    kDefault);
}

double estimated_error(const PositionTrack& looser, const PositionTrack& track) {
  return farthest(looser, track) / kShare;
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

PositionTrack::PositionTrack(const Scene& scene)
    : end_(scene.simulation.mode == Mode::kStatic ? 0 : scene.simulation.duration) {}

void PositionTrack::record(const Snapshot& snapshot) {
  std::vector<Vec3>& all = positions_.emplace_back();
  for (const BodySample& body : snapshot.bodies)
    all.push_back(body.X_WB.p);
  for (const RodSample& rod : snapshot.rods)
    all.push_back(rod.points.back().position);
}

void PositionTrack::begin(const Snapshot& start) {
  positions_.clear();
  record(start);
}

void PositionTrack::step(const Snapshot& before, const Snapshot& now) {
  const double slack = kRoundOff * (now.time - before.time);
  for (auto k = positions_.size(); k <= kInstants; ++k) {
    const double t = end_ * static_cast<double>(k) / kInstants;
    if (t > now.time + slack) return;
    record(interpolate(before, now, std::min(t, now.time)));
  }
}

double farthest(const PositionTrack& a, const PositionTrack& b) {
  double most = 0;
  for (std::size_t k = 0; k < std::min(a.positions_.size(), b.positions_.size()); ++k)
    for (std::size_t i = 0; i < std::min(a.positions_[k].size(), b.positions_[k].size()); ++i)
      most = std::max(most, (a.positions_[k][i] - b.positions_[k][i]).norm());
  return most;
}

AccuracyControl::AccuracyControl(const Scene& scene)
    : scene_(scene), asked_(scene.solver.accuracy) {
  track_.emplace(scene_);
  if (!asked_) return;
  report_.asked = *asked_;
  report_.held_back = fixed_by(scene);
  residual_is_ours_ = !scene.solver.residual_tolerance;
  if (residual_is_ours_) scene_.solver.residual_tolerance = residual_for(scene_);
}

void AccuracyControl::fly_pilot(const std::function<bool()>& stop) {
  Scene scene = looser(scene_);
  // at its coarsest the formula gives the pilot no fewer pieces, and no error would be seen
  const auto resolution = resolution_of(scene_);
  if (!resolution.empty() && resolution == resolution_of(scene)) {
    const auto [elements, order] = *std::min_element(resolution.begin(), resolution.end());
    scene.solver.points = scene.solver.elements = std::max(1, elements * 2 / 3);
    scene.solver.order = std::max(1, order - 1);
  }
  pilot_.emplace(scene);
  const QuietRun run = run_quietly(scene, onlooker(*pilot_), stop);
  ++report_.runs;
  report_.evaluations += run.statistics.section_evaluations;
}

bool AccuracyControl::refine(long evaluations) {
  constexpr double kAim = 0.3;  // of what is asked for
  ++report_.runs;
  report_.estimate = estimated_error(*pilot_, *track_);
  const bool at_the_end = *scene_.solver.accuracy <= kLeastAccuracy;
  const bool settled =
      report_.reached() || at_the_end || report_.runs >= kMostRuns || !report_.held_back.empty();
  if (settled) return false;
  report_.evaluations += evaluations;
  const double factor = std::clamp(kAim * *asked_ / report_.estimate, 1e-3, 1 / kLooser);
  scene_.solver.accuracy = std::max(kLeastAccuracy, factor * *scene_.solver.accuracy);
  if (residual_is_ours_) scene_.solver.residual_tolerance = residual_for(scene_);
  pilot_ = std::move(track_);
  track_.emplace(scene_);
  return true;
}

}  // namespace cprsim
