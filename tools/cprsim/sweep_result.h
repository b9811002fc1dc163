// SPDX-License-Identifier: BSD-3-Clause
// A sweep as far as it is done, and what follows from it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/cprsim/sweep_plan.h"

namespace cprsim {

/// One run; as it is kept on disk while others are still to be made.
struct SweepRun {
  bool known = false;
  std::string refusal, failure;
  std::vector<double> errors;  ///< one per measure; empty without a reference
  std::vector<double> last;    ///< value of each channel at the last instant
  double cpu_seconds = 0, end_time = 0;
  RunStatistics statistics;
  std::optional<double> order;  ///< of the first measure, from the coarser neighbour on its line
  bool cheapest = false;        ///< no other run is as good at less cost

  bool done() const { return known && refusal.empty() && failure.empty(); }
};

struct SweepResult {
  const SweepPlan& plan;
  std::vector<SweepRun> runs;            ///< as SweepPlan::points
  std::vector<double> reference_spread;  ///< per measure: the looser reference from the tight one
  std::string reference_text;            ///< what errors are against
  double seconds = 0;                    ///< wall time, all told
  int jobs = 1;
  std::string status = "running", scene_path;
  std::vector<std::pair<std::string, std::string>> options;

  /// The least error that means anything: a few times the spread of the references.
  double resolved(std::size_t measure) const;
};

/// Orders along lines and the front of cheapest runs.
void analyse(SweepResult& result);

/// An accuracy, and the cheapest run that reaches it.
struct Decade {
  double bound = 0;
  std::size_t run = 0;
};

/// For each power of ten of the first measure's error the cheapest run, as long as errors mean
/// anything.
std::vector<Decade> decades(const SweepResult& result);

/// "1e-5 m costs 0.04 s of one core per simulated second with ...; ten times more accurate
/// costs 1.8 times more"
std::string cost_in_words(const SweepResult& result);

std::string to_summary(const SweepResult& result, const std::string& folder);
std::string to_json(const SweepResult& result);
std::string to_csv(const SweepResult& result);
std::string to_html(const SweepResult& result, const std::string& svg);

/// sweep.csv, sweep.gp, sweep.svg, sweep.png, sweep.html
void write_sweep(const SweepResult& result, const std::filesystem::path& folder,
                 const Console& console);

/// Names of all files that a sweep may leave beside its sweep.json.
const std::vector<std::string>& sweep_files();

}  // namespace cprsim
