// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/answer_track.h"

#include <algorithm>
#include <cmath>

namespace cprsim {

namespace {

constexpr int kMostInstants = 200;
constexpr int kPlaces = 8;          // along a rod
constexpr double kRoundOff = 1e-9;  // of a step: times are sums of rounded steps

/// A quasi-static run knows nothing of what lies between its steps.
double interval_of(const Scene& scene) {
  const double duration = scene.simulation.duration;
  if (scene.simulation.mode == Mode::kStatic) return 1;
  if (scene.simulation.mode == Mode::kDynamic) return duration / kMostInstants;
  const double step = scene.solver.step.value_or(scene.max_step_size);
  return step * std::max(1.0, std::ceil(duration / step / kMostInstants));
}

}  // namespace

AnswerTrack::AnswerTrack(const Scene& scene)
    : end_(scene.simulation.mode == Mode::kStatic ? 0 : scene.simulation.duration),
      interval_(interval_of(scene)),
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
  for (auto k = answers_.size();; ++k) {
    const double t = interval_ * static_cast<double>(k);
    if (t > std::min(now.time, end_) + slack) return;
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

}  // namespace cprsim
