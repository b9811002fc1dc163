// SPDX-License-Identifier: BSD-3-Clause
// Points of a workspace as lines of CSV, and back: what an interrupted sweep wrote is what it goes
// on from.
#pragma once

#include <optional>
#include <string>

#include "tools/cprsim/workspace_options.h"

namespace cprsim {

/// "stable", "unstable", "singular" or "not reached".
const char* status_of(const WorkspacePoint& point);

/// "Newton" and so on, "inverse", or empty where nothing was found.
const char* found_by(const WorkspacePoint& point);

class WorkspaceTable {
 public:
  explicit WorkspaceTable(const WorkspaceTask& task);

  /// Names and units, with the end of the line.
  std::string header() const;
  /// With the end of the line; equal for equal points.
  std::string row(const WorkspacePoint& point) const;
  /// @param line without its end. @return nothing if it is no whole row of this table
  std::optional<WorkspacePoint> read(const std::string& line) const;

 private:
  const WorkspaceTask& task_;
};

}  // namespace cprsim
