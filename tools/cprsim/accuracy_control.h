// SPDX-License-Identifier: BSD-3-Clause
// <accuracy>: an error is asked for, and what the run's own error is has to be found out. The scene
// is run for larger errors first, each run with errors that ought to be r times smaller than the
// last one's. With errors e proportional to r^-kappa
//   d = max |x_last - x|,   e = d / (r^kappa - 1).                                            (1)
// Two runs know nothing of kappa: it is taken for 2/3, what the least able of the schemes that
// adapt has. Of three runs the quotient of both distances tells it,
//   d_1 / d_2 = r_2^kappa (r_1^kappa - 1) / (r_2^kappa - 1).                                  (2)
// Of two runs no r above ten counts, and of three no run is believed to be more than thirty times
// nearer than the one before it. Two pilots, for
// errors 100 and 10 times as large as asked for, tell what a run has to aim at to get there, and no
// farther: what is more accurate is not what was asked for, but costs more. The first pilot's error
// is at most d + e. The coarser pilot that is good enough is run again with all its outputs. Where
// (1) still exceeds what is asked for, the run is made again with a smaller aim.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/cprsim/answer_track.h"
#include "tools/cprsim/resolution.h"

namespace cprsim {

/// (1) from two runs, the errors of the second being `times` smaller.
double estimated_error(double distance, double times);

/// Takes away what a scene says of step, tolerance, scheme and resolution; its method stays.
void free_settings(SolverSpec& solver);

/// Residual to which equations are solved so that what is left does not count beside the accuracy
/// that a scene asks for: residuals are relative to the robot's size and stiffness.
double residual_for(const Scene& scene);

/// What came of an accuracy that was asked for.
struct AccuracyReport {
  double asked = 0;
  double estimate = 0;   ///< (1)
  std::string unit;      ///< of both, with what they are about: "m", "of the longest rod"
  int runs = 0;          ///< all told, pilots and last one included
  long evaluations = 0;  ///< section evaluations of those before the last
  double pilots_cpu_seconds = 0;
  std::string held_back;  ///< what the scene fixes and accuracy therefore does not choose

  bool reached() const { return estimate <= asked; }
};

class AccuracyControl {
 public:
  explicit AccuracyControl(const Scene& scene);

  /// The scene asks for an accuracy.
  bool asked() const { return asked_.has_value(); }

  /// Makes the pilots and decides what is to be run next.
  /// @param stop asked before every step
  void fly_pilots(const std::function<bool()>& stop);

  /// The scene to be run next.
  const Scene& scene() const { return scene_; }

  /// Sees that run.
  AnswerTrack& track() { return *track_; }

  /// After a run that got to its end: whether another one is needed, which scene() then is.
  bool refine(long evaluations);

  /// After a run that failed: likewise. Rods that the program cut may be too coarse for any
  /// solution, and a smaller error than that of the last run that got to its end may be out of
  /// reach of round-off.
  bool retry(long evaluations);

  const AccuracyReport& report() const { return report_; }

 private:
  /// A run that got to its end.
  struct Level {
    Scene scene;
    std::vector<Resolution> resolution;
    double times = 1;     ///< smaller than the last one's its errors ought to be
    double distance = 0;  ///< from the last one
    AnswerTrack track;
  };

  void aim(double feared);
  void begin(Scene scene);
  double estimate() const;  ///< of the last level
  bool fly(Scene scene, const std::function<bool()>& stop);
  void land(AnswerTrack track);
  void repeat(const Level& level, double estimate);

  Scene scene_;
  std::optional<double> asked_;
  bool residual_is_ours_ = false;  ///< the scene does not say how far equations are solved
  std::vector<Resolution> resolution_;
  double times_ = 1;           ///< Level::times of scene_
  std::vector<Level> levels_;  ///< coarse to fine
  std::optional<AnswerTrack> track_;
  std::optional<double> known_;  ///< estimate of scene_, which a pilot was run for
  int failures_ = 0;
  bool went_back_ = false;
  AccuracyReport report_;
};

}  // namespace cprsim
