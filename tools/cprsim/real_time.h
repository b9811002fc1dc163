// SPDX-License-Identifier: BSD-3-Clause
// --real-time-factor: the most accurate settings with which a run keeps up with a clock. Runs for
// ever smaller errors are tried, each stopped once its time is up, so that all of them together
// take a few times what the last one may take.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/scene.h"
#include "tools/cprsim/accuracy_control.h"

namespace cprsim {

/// What came of the search.
struct RealTimeReport {
  double asked = 0;     ///< s simulated per s of wall time
  double factor = 0;    ///< of the trial with the settings chosen; it had to be a quarter faster
  double accuracy = 0;  ///< m, which the chosen settings are made for
  std::optional<double> estimate;  ///< m, of the error; none where no looser run could be compared
  int runs = 0;                    ///< trials

  /// Otherwise even the coarsest settings are too slow.
  bool kept_up() const { return factor >= asked; }
};

class RealTimeSearch {
 public:
  /// @param scene with a duration
  RealTimeSearch(const Scene& scene, double factor);

  /// @param stop asked before every step
  void run(const std::function<bool()>& stop);

  /// With the settings chosen.
  const Scene& scene() const { return scene_; }

  const RealTimeReport& report() const { return report_; }

 private:
  struct Trial {
    double accuracy = 0, factor = 0;
    AnswerTrack track;
  };

  Scene with_accuracy(double accuracy) const;
  std::optional<Trial> attempt(double accuracy, const std::function<bool()>& stop);
  void choose(const Trial& trial);

  Scene scene_;
  RealTimeReport report_;
  double length_ = 0;
  std::vector<Trial> kept_up_;
};

}  // namespace cprsim
