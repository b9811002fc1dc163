// SPDX-License-Identifier: BSD-3-Clause
// How far a run is: a bar redrawn at most five times a second on a terminal, else a line per 10 %.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "tools/cprsim/console.h"

namespace cprsim {

class Progress {
 public:
  Progress(ProgressStyle style, std::string name, double end_time);

  void update(double time, long steps, long iterations);
  /// Leaves the line, so that what follows starts on a fresh one.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  ProgressStyle style_;
  std::string name_;
  double end_time_;
  Clock::time_point began_, drawn_;
  int tenths_ = 0;
  bool on_screen_ = false;
};

/// The same for work that is counted: "workspace  [#####---]  1840/3000  ETA 0:07".
class CountProgress {
 public:
  CountProgress(ProgressStyle style, std::string name, std::size_t before, std::size_t total);

  void update(std::size_t done);
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  ProgressStyle style_;
  std::string name_;
  std::size_t before_, total_;  ///< done before this began
  Clock::time_point began_, drawn_;
  std::size_t tenths_;
  bool on_screen_ = false;
};

/// "stewart_gough  [#########-----]  1.84/3.00 s  2.6x real time  3.1 it/step  ETA 0:07"
std::string progress_line(const std::string& name, double time, double end_time, double wall,
                          double iterations_per_step);

}  // namespace cprsim
