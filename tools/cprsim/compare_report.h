// SPDX-License-Identifier: BSD-3-Clause
// A finished comparison, and how it is told: a table, JSON, CSV and a picture.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/cprsim/console.h"
#include "tools/series/comparison.h"
#include "tools/series/vibration.h"

namespace cprsim {

/// A limit of --rms or --max, and what it was held against.
struct CheckedLimit {
  std::string quantity, kind;  ///< kind: rms, max
  double limit = 0, value = 0;
  std::string unit;

  bool kept() const { return value <= limit; }
};

/// How a quantity vibrates, along the axis on which the reference moves most.
struct VibrationComparison {
  std::string name;  ///< with the component
  Vibration run, reference;
};

/// Nothing where one side does not vibrate, and for attitudes.
std::optional<VibrationComparison> compare_vibration(const QuantityComparison& comparison);

struct CompareReport {
  std::string label, run_path, reference_path;
  double from = 0, to = 0;   ///< s, instants of the reference that were compared
  std::size_t instants = 0;  ///< of the reference
  std::optional<Lag> lag;    ///< as found
  bool lag_applied = false;
  std::optional<Pose> aligned;  ///< --align: pose of the reference's frame
  std::optional<double> length;
  std::vector<QuantityComparison> quantities;
  std::vector<VibrationComparison> vibrations;
  std::vector<std::string> ignored;  ///< columns of the reference that the run does not have
  std::vector<CheckedLimit> limits;

  bool kept() const;
};

/// Attitudes are told in degrees.
std::string shown_unit(const QuantityComparison& comparison);
double shown_factor(const QuantityComparison& comparison);

std::string to_json(const CompareReport& report);
std::string to_summary(const CompareReport& report, const std::string& folder);

/// compare.csv, compare.gp and compare.svg. @return names of the files
std::vector<std::string> write_comparison(const CompareReport& report,
                                          const std::filesystem::path& folder,
                                          const Console& console);

}  // namespace cprsim
