// SPDX-License-Identifier: BSD-3-Clause
// A run without files, for commands that run many scenes: what it did, and the processor time that
// the solver took.
#pragma once

#include <functional>

#include "engine/run/simulation.h"

namespace cprsim {

struct QuietRun {
  RunStatus status = RunStatus::kRunning;  ///< kRunning: stopped before its end
  std::string failure;                     ///< a sentence, if it failed
  double time = 0, end_time = 0;
  double cpu_seconds = 0;  ///< of this thread: building, start and steps, not looking
  RunStatistics statistics;
  ProblemFacts facts;
};

/// Who looks at a run: at its start, then at both ends of every step.
struct Onlooker {
  std::function<void(const Snapshot&)> begin;
  std::function<void(const Snapshot&, const Snapshot&)> step;
};

/// Anything that has begin() and step().
template <class Recorder>
Onlooker onlooker(Recorder& recorder) {
  return {[&](const Snapshot& start) { recorder.begin(start); },
          [&](const Snapshot& before, const Snapshot& now) { recorder.step(before, now); }};
}

/// Runs the scene to its end. Scenes with free bodies wait for each other: Bullet counts some of
/// what it does in variables of the process.
/// @param stop asked before every step
/// @throws std::invalid_argument if the scene asks for what cannot be simulated
QuietRun run_quietly(const Scene& scene, const Onlooker& onlooker,
                     const std::function<bool()>& stop);

/// Calls work(0) ... work(count - 1) on `jobs` threads, in any order; 0: as many as there are
/// cores. What one of them throws is thrown once all have ended.
void on_threads(std::size_t count, int jobs, const std::function<void(std::size_t)>& work);

}  // namespace cprsim
