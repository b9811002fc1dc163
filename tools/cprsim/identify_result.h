// SPDX-License-Identifier: BSD-3-Clause
// What `cprsim identify` found, and its forms: text, JSON, CSV, plot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/fit/confidence.h"
#include "engine/fit/least_squares.h"
#include "tools/cprsim/console.h"
#include "tools/cprsim/identify_study.h"

namespace cprsim {

struct IdentifyResult {
  FitReport fit;
  Confidence confidence;
  VecX start_residuals;                   ///< in units of sigma, as fit.r
  std::vector<std::string> combinations;  ///< of values that change nothing measured, in words
  double derivative_error = 0;            ///< largest relative, of a column that is not zero
  double level = 0.95;
  long simulations = 0, restarts = 0;
  double seconds = 0;
  std::string failure;  ///< of the last trial that had no answer
  int exit_code = 0;
  std::vector<std::string> files;

  bool has_confidence() const { return confidence.standard_error.size() > 0; }

  /// Whether the data determine value j; only then may an interval be shown.
  bool determined(std::size_t j) const;
};

/// "at its lower bound" or "at its upper bound"; empty where it is at none
std::string bound_of(const IdentifyResult& result, const Study& study, std::size_t j);

/// A fitted value in words: "observable", "at its lower bound", "NOT OBSERVABLE: dependent", ...
std::string state_of(const IdentifyResult& result, const Study& study, std::size_t j);

struct Interval {
  double value = 0, error = 0, low = 0, high = 0;
};

/// Value, standard error and ends of the interval; NaN where not determined.
Interval interval_of(const IdentifyResult& result, const Study& study, std::size_t j);

/// Root mean square of the residuals of a matched column, SI.
double rms(const Study& study, const VecX& residuals, std::size_t match);

std::string identify_text(const IdentifyResult& result, const Study& study,
                          const std::string& folder);
std::string identify_json(const IdentifyResult& result, const Study& study,
                          const IdentifyOptions& options);
std::string residuals_csv(const IdentifyResult& result, const Study& study);

/// Writes identify.gp beside residuals.csv and lets gnuplot make identify.svg of them.
/// @return whether there is a plot; if not, says why and how to make it later
bool draw_residuals(const Study& study, const std::filesystem::path& folder,
                    const Console& console);

}  // namespace cprsim
