// SPDX-License-Identifier: BSD-3-Clause
// <accuracy>: an error is asked for, and what the run's own error is has to be found out.
// The run is compared with a looser one, its pilot, for which errors of 10 times the size are
// asked: with errors proportional to a^kappa, kappa >= 2/3 for every scheme that adapts,
//   d = max |x_pilot - x|,   e <= d / (10^kappa - 1) < d / 3                                (1)
// Where (1) exceeds what is asked for, a smaller error is asked for in secret and the run made
// again, with the last one as its pilot.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "tools/sinks/sink.h"

namespace cprsim {

/// Where links and tips of rods are at evenly spaced instants. Between its nodes a rod is
/// interpolated, which errs by the fourth power of their distance and is no error of the solution.
class PositionTrack : public Sink {
 public:
  explicit PositionTrack(const Scene& scene);

  void begin(const Snapshot& start) override;
  void step(const Snapshot& before, const Snapshot& now) override;

  void finish() override {}

  std::vector<WrittenFile> files() const override { return {}; }

  /// Largest distance at instants that both have reached, m.
  friend double farthest(const PositionTrack& a, const PositionTrack& b);

 private:
  void record(const Snapshot& snapshot);

  double end_;
  std::vector<std::vector<Vec3>> positions_;  ///< by instant
};

/// (1) from two runs of which the first is made for errors of at least ten times the size, m.
double estimated_error(const PositionTrack& looser, const PositionTrack& track);

/// Takes away what a scene says of step, tolerance, scheme and resolution; its method stays.
void free_settings(SolverSpec& solver);

/// Residual to which equations are solved so that what is left does not count beside the accuracy
/// that a scene asks for: residuals are relative to the robot's size and stiffness.
double residual_for(const Scene& scene);

/// What came of an accuracy that was asked for.
struct AccuracyReport {
  double asked = 0;       ///< m
  double estimate = 0;    ///< (1), m
  int runs = 0;           ///< all told, pilot and last one included
  long evaluations = 0;   ///< section evaluations of those before the last
  std::string held_back;  ///< what the scene fixes and accuracy therefore does not choose

  bool reached() const { return estimate <= asked; }
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
  PositionTrack& track() { return *track_; }

  /// After a run that got to its end: whether another one is needed, which scene() then is.
  bool refine(long evaluations);

  const AccuracyReport& report() const { return report_; }

 private:
  Scene scene_;
  std::optional<double> asked_;
  bool residual_is_ours_ = false;  ///< the scene does not say how far equations are solved
  std::optional<PositionTrack> pilot_, track_;
  AccuracyReport report_;
};

}  // namespace cprsim
