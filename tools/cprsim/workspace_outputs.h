// SPDX-License-Identifier: BSD-3-Clause
// The files of a workspace: points.csv, points.vtp, workspace.svg, workspace.json. Only timings in
// the last differ between equal sweeps.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/cprsim/workspace_options.h"

namespace cprsim {

constexpr const char* kWorkspaceReport = "workspace.json";
constexpr const char* kWorkspaceSchema = "cprsim-workspace/";
constexpr const char* kWorkspaceJournal = "points.journal";

struct WorkspaceReport {
  std::string label, scene_path;
  std::vector<std::pair<std::string, std::string>> options;
  std::string status = "running";  ///< done, interrupted
  int exit_code = 0;
  int jobs = 1;
  double seconds = 0;                  ///< of this process
  std::size_t before = 0;              ///< points that an interrupted sweep had left
  std::vector<WorkspacePoint> points;  ///< in order
};

/// How many of what.
struct WorkspaceCounts {
  std::map<std::string, std::size_t> by_status, by_stage, by_reason;
  std::size_t reached = 0, positions_broken = 0, efforts_broken = 0;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< of reached positions
};

WorkspaceCounts count(const std::vector<WorkspacePoint>& points);

/// What results must have in common to be put together.
std::string signature_of(const WorkspaceTask& task, const WorkspaceReport& report);

std::string to_json(const WorkspaceTask& task, const WorkspaceReport& report);

/// The closing lines, for people.
std::string to_summary(const WorkspaceTask& task, const WorkspaceReport& report,
                       const std::string& folder);

/// Everything but the report.
void write_points(const WorkspaceTask& task, const WorkspaceReport& report,
                  const std::filesystem::path& folder, const std::string& view);

}  // namespace cprsim
