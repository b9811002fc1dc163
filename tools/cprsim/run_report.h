// SPDX-License-Identifier: BSD-3-Clause
// Everything there is to say about a finished run, from which run.json and the closing lines are
// made.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/scene.h"
#include "engine/run/simulation.h"
#include "engine/solve/phase_clock.h"
#include "scenes/loader/diagnostic.h"
#include "tools/cprsim/accuracy_control.h"
#include "tools/cprsim/expectations.h"
#include "tools/cprsim/extremes.h"
#include "tools/cprsim/real_time.h"
#include "tools/sinks/sink.h"

namespace cprsim {

enum class RunEnd {
  kRunning,      ///< in the run.json that a killed run leaves behind
  kDone,         ///< the end of the scene is reached
  kFailed,       ///< the simulation could not go on
  kWallTime,     ///< --max-wall
  kInterrupted,  ///< SIGINT or SIGTERM
  kOutput        ///< files or pictures could not be written
};

const char* to_string(RunEnd end);

/// Wall time in s; the only part of a report, with the host, that differs between equal runs.
struct Timings {
  std::string started;  ///< UTC, ISO 8601
  int jobs = 0;         ///< as asked for with -j; 0: not limited
  double load = 0, build = 0, start = 0, steps = 0, outputs = 0, total = 0;
};

struct RunReport {
  std::string label;       ///< what the run is called: the scene file's stem
  std::string scene_path;  ///< as given
  std::vector<std::pair<std::string, std::string>> options;  ///< given on the command line
  RunEnd end = RunEnd::kRunning;
  int exit_code = 0;
  double time = 0, end_time = 0;  ///< s simulated, and to be simulated
  RunStatistics statistics;
  ProblemFacts facts;
  std::string failure;  ///< a sentence, if end is not kDone
  const char* failure_code = "";
  SolveReport last_solve;
  std::vector<std::string> likely_causes;
  Extremes extremes;
  std::string stability;  ///< of a static equilibrium: stable, unstable, singular; or empty
  int unstable_directions = 0;
  std::optional<AccuracyReport> accuracy;   ///< if one was asked for
  std::optional<RealTimeReport> real_time;  ///< likewise
  std::vector<Diagnostic> diagnostics;
  std::vector<ExpectResult> expectations;
  std::vector<WrittenFile> files;          ///< without run.json
  std::string film_device;                 ///< what drew the pictures; empty if nothing did
  std::optional<PhaseClock::Sums> phases;  ///< with --profile
  Timings timings;

  /// Another run takes the place of the one told of so far.
  void begin_anew() {
    end = RunEnd::kRunning;
    failure.clear();
    failure_code = "";
    likely_causes.clear();
  }

  bool interrupted() const { return end == RunEnd::kInterrupted; }

  /// Seconds simulated per second of wall time spent on it.
  double real_time_factor() const;
};

/// The text of run.json, schema "cprsim-run/1".
std::string to_json(const Scene& scene, const RunReport& report);

/// What --json answers for a scene that is not simulated.
std::string rejection_json(const std::string& path, int exit_code,
                           const std::vector<Diagnostic>& diagnostics);

/// The value that was seen and the one that was expected, for people; one line without its end.
std::string describe(const CheckResult& check);

/// The error asked for and the one found out; one line without its end.
std::string describe(const AccuracyReport& accuracy);

/// The accuracy that a time budget buys; one line without its end.
std::string describe(const RealTimeReport& real_time);

/// The closing lines, for people.
std::string to_summary(const Scene& scene, const RunReport& report, const std::string& folder);

/// Where the time of a run went, for people; empty unless it was measured.
std::string profile_table(const RunReport& report);

/// What went wrong and the likely causes, for people; several lines.
std::string explain_failure(const RunReport& report, const std::string& folder);

}  // namespace cprsim
