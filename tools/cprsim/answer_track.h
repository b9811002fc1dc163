// SPDX-License-Identifier: BSD-3-Clause
// What two runs of a scene are compared by, to find out their error.
#pragma once

#include <optional>
#include <vector>

#include "engine/model/scene.h"
#include "engine/run/observe.h"
#include "tools/sinks/sink.h"

namespace cprsim {

/// What an accuracy is about, at evenly spaced instants: where links are, and rods at eighths of
/// their length, or the channels that the scene names. What is interpolated between nodes counts,
/// and in a motion between steps: it is what a scene gets to see.
class AnswerTrack : public Sink {
 public:
  explicit AnswerTrack(const Scene& scene);

  void begin(const Snapshot& start) override;
  void step(const Snapshot& before, const Snapshot& now) override;

  void finish() override {}

  std::vector<WrittenFile> files() const override { return {}; }

  /// Largest distance at instants that both have reached: in m, or as AccuracyGoal says.
  friend double farthest(const AnswerTrack& a, const AnswerTrack& b);

 private:
  void record(const Snapshot& snapshot);

  double end_, interval_;  ///< s
  std::optional<AccuracyGoal> goal_;
  std::optional<ChannelReader> reader_;
  double size_ = 1;                         ///< what is relative is relative to
  std::vector<std::vector<Vec3>> answers_;  ///< by instant; of a channel (value, 0, 0)
};

}  // namespace cprsim
