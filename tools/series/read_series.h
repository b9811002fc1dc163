// SPDX-License-Identifier: BSD-3-Clause
// Trajectories from files: CSV with a time column, TUM (t x y z qx qy qz qw), HDF5, or a recorded
// run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/series/measured_table.h"
#include "tools/series/series.h"

namespace cprsim {

/// CSV: a column called time, t or stamp, others by name. A file whose first line of data is eight
/// numbers is TUM; its columns are position.x .. orientation.w. Units that a header names are
/// turned into SI; where it names none the column's unit stays empty. HDF5 (.h5, .hdf5): see
/// hdf5_series.h.
/// @throws TableError
Series read_series(const std::string& path);
Series parse_series(const std::string& text, const std::string& name);

/// What run.json in a run's folder says.
struct RunFiles {
  /// One that the run wrote: "csv", "hdf5", ...; its name in the folder.
  struct File {
    std::string kind, name;
  };

  std::string label, folder;
  std::string scene;                  ///< path; empty if unknown
  std::optional<double> longest_rod;  ///< m
  std::vector<File> files;

  std::vector<std::string> of_kind(const std::string& kind) const;
};

/// @throws std::runtime_error if the folder holds no run
RunFiles read_run_files(const std::string& folder);

/// What a run recorded.
struct RecordedRun {
  std::string label, folder;
  std::vector<Series> recordings;     ///< one per CSV file; HDF5 where there is no CSV
  std::optional<double> longest_rod;  ///< m
};

/// @throws TableError, std::runtime_error if the folder holds no run, or the run neither CSV nor
/// HDF5 files
RecordedRun read_run(const std::string& folder);

}  // namespace cprsim
