// SPDX-License-Identifier: BSD-3-Clause
// <accuracy>: an error is asked for, and what the run's own error is has to be found out.
// The run is compared with a looser one, its pilot, for which errors of 10 times the size are
// asked: with errors proportional to a^kappa, kappa >= 2/3 for every scheme that adapts,
//   d = max |x_pilot - x|,   e <= d / (10^kappa - 1) < d / 3                                (1)
// (with r instead of 10 where errors of r times the size were asked of the pilot).
// Where (1) exceeds what is asked for, a smaller error is asked for in secret and the run made
// again, with the last one as its pilot.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "engine/run/observe.h"
#include "tools/sinks/sink.h"

namespace cprsim {

/// What an accuracy is about, at evenly spaced instants: where links are, and rods at eighths of
/// their length, or the channels that the scene names. What is interpolated between nodes counts:
/// it is what a scene gets to see.
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

  double end_;
  std::optional<AccuracyGoal> goal_;
  std::optional<ChannelReader> reader_;
  double size_ = 1;                         ///< what is relative is relative to
  std::vector<std::vector<Vec3>> answers_;  ///< by instant; of a channel (value, 0, 0)
};

/// (1) from two runs of which the first is made for errors `times` the size, 10 at least.
double estimated_error(const AnswerTrack& looser, const AnswerTrack& track, double times = 10);

/// Takes away what a scene says of step, tolerance, scheme and resolution; its method stays.
void free_settings(SolverSpec& solver);

/// Residual to which equations are solved so that what is left does not count beside the accuracy
/// that a scene asks for: residuals are relative to the robot's size and stiffness.
double residual_for(const Scene& scene);

/// What came of an accuracy that was asked for.
struct AccuracyReport {
  double asked = 0;
  double estimate = 0;    ///< (1)
  std::string unit;       ///< of both, with what they are about: "m", "of the longest rod"
  int runs = 0;           ///< all told, pilot and last one included
  long evaluations = 0;   ///< section evaluations of those before the last
  std::string held_back;  ///< what the scene fixes and accuracy therefore does not choose

  bool reached() const { return estimate <= asked; }
};

/// What a rod is cut into.
struct Resolution {
  Method method = Method::kShooting;
  int elements = 0, order = 0;

  bool operator==(const Resolution&) const = default;
};

class AccuracyControl {
 public:
  explicit AccuracyControl(const Scene& scene);

  /// The scene asks for an accuracy.
  bool asked() const { return asked_.has_value(); }

  /// Makes the pilot. @param stop asked before every step
  void fly_pilot(const std::function<bool()>& stop);

  /// The scene to be run next.
  const Scene& scene() const { return scene_; }

  /// Sees that run.
  AnswerTrack& track() { return *track_; }

  /// After a run that got to its end: whether another one is needed, which scene() then is.
  bool refine(long evaluations);

  const AccuracyReport& report() const { return report_; }

 private:
  void cut_finer(const std::vector<Resolution>& last);

  Scene scene_;
  std::optional<double> asked_;
  bool residual_is_ours_ = false;  ///< the scene does not say how far equations are solved
  double times_ = 10;              ///< the error of the last run that was asked of its pilot
  std::optional<AnswerTrack> pilot_, track_;
  AccuracyReport report_;
};

}  // namespace cprsim
