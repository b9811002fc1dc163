// SPDX-License-Identifier: BSD-3-Clause
// Where the wall time of a run goes. Stretches of time are added to phases that never lie within
// each other. Who is not asked to measure holds a null pointer and pays one comparison a phase.
#pragma once

#include <array>
#include <chrono>
#include <functional>

namespace cprsim {

enum class Phase {
  kSections,     ///< rods' equations along their length: state and derivatives
  kElimination,  ///< rods condensed to their ends, and the way back
  kSystem,       ///< bodies, joints, the robot's linear system
  kContact,      ///< where rods touch
  kFreeBodies,   ///< Bullet
  kObservation,  ///< shapes and energies at the end of a step
  kRecording,    ///< files, expectations
  kPictures,     ///< drawing and encoding
};

constexpr int kPhaseCount = 8;

const char* to_string(Phase phase);

class PhaseClock {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Sum {
    double seconds = 0;
    long count = 0;
  };

  using Sums = std::array<Sum, kPhaseCount>;

  /// Told of every stretch, in s since the clock was made.
  using Listener = std::function<void(Phase phase, double begin, double end)>;

  explicit PhaseClock(Listener listener = {})
      : made_(std::chrono::steady_clock::now()), listener_(std::move(listener)) {}

  void add(Phase phase, Time begin, Time end);

  /// s since the clock was made.
  double now() const { return since(std::chrono::steady_clock::now()); }

  /// By phase.
  const Sums& sums() const { return sums_; }

 private:
  double since(Time t) const { return std::chrono::duration<double>(t - made_).count(); }

  Time made_;
  Listener listener_;
  Sums sums_{};
};

/// One stretch, from here to the end of the block.
class PhaseTimer {
 public:
  PhaseTimer(PhaseClock* clock, Phase phase) : clock_(clock), phase_(phase) {
    if (clock_ != nullptr) begin_ = std::chrono::steady_clock::now();
  }

  ~PhaseTimer() {
    if (clock_ != nullptr) clock_->add(phase_, begin_, std::chrono::steady_clock::now());
  }

  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;

 private:
  PhaseClock* clock_;
  Phase phase_;
  PhaseClock::Time begin_;
};

}  // namespace cprsim
