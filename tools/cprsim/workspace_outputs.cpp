// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/workspace_outputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/cprsim/version.h"
#include "tools/cprsim/workspace_table.h"
#include "tools/sinks/output_file.h"
#include "tools/sinks/scatter.h"
#include "tools/sinks/vtk_points.h"

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kAxes[] = {"x", "y", "z"};
constexpr std::size_t kReasons = 10;  // of failures that are told

/// Most frequent first.
std::vector<std::pair<std::string, std::size_t>> ranked(
    const std::map<std::string, std::size_t>& counts) {
  std::vector<std::pair<std::string, std::size_t>> list(counts.begin(), counts.end());
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return list;
}

std::string listed(const std::map<std::string, std::size_t>& counts) {
  std::string text;
  for (const auto& [name, number] : ranked(counts))
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", number, name);
  return text;
}

Json axes_json(const WorkspaceTask& task, bool random) {
  Json list = Json::array();
  for (const WorkspaceAxis& axis : task.question.axes) {
    Json entry = {{"name", axis.name}, {"unit", axis.unit}, {"low", axis.low}, {"high", axis.high}};
    if (!random) entry["count"] = axis.count;
    list.push_back(entry);
  }
  return list;
}

Json held_json(const WorkspaceTask& task) {
  static constexpr const char* kNames[] = {"x", "y", "z", "roll", "pitch", "yaw"};
  Json list = Json::array();
  for (std::size_t f = 0; f < 6; ++f) {
    const HeldFreedom& other = task.question.others[f];
    if (!other.held) continue;
    Json entry = {{"name", kNames[f]}};
    if (other.at) entry["at"] = *other.at;
    list.push_back(entry);
  }
  return list;
}

Json options_json(const WorkspaceReport& report) {
  Json options = Json::array();
  for (const auto& [name, value] : report.options)
    options.push_back({{"name", name}, {"value", value}});
  return options;
}

Json counts_json(const WorkspaceCounts& counts) {
  Json json = {{"reached", counts.reached},
               {"status", counts.by_status},
               {"found_by", counts.by_stage},
               {"beyond_joint_limits", counts.positions_broken},
               {"beyond_effort_limits", counts.efforts_broken},
               {"not_reached_because", Json::array()}};
  for (const auto& [why, number] : ranked(counts.by_reason)) {
    if (json["not_reached_because"].size() == kReasons) break;
    json["not_reached_because"].push_back({{"why", why}, {"points", number}});
  }
  if (counts.reached > 0) {
    json["position_low"] = {counts.low.x(), counts.low.y(), counts.low.z()};
    json["position_high"] = {counts.high.x(), counts.high.y(), counts.high.z()};
  }
  return json;
}

bool is_random(const WorkspaceReport& report) {
  return std::any_of(report.options.begin(), report.options.end(),
                     [](const auto& option) { return option.first == "--random"; });
}

/// Which freedoms the picture shows: as asked, or those varied, or where the points spread most.
std::pair<int, int> plane_of(const WorkspaceTask& task, const WorkspaceCounts& counts,
                             const std::string& view) {
  if (!view.empty()) return {view[0] - 'x', view[1] - 'x'};
  Vec3 spread = counts.high - counts.low;
  for (const WorkspaceAxis& axis : task.question.axes)
    if (axis.freedom >= 0 && axis.freedom < 3) spread[axis.freedom] += 1e6;
  int thinnest = 2;
  for (int i = 1; i >= 0; --i)
    if (spread[i] < spread[thinnest]) thinnest = i;
  return {thinnest == 0 ? 1 : 0, thinnest == 2 ? 1 : 2};
}

/// The wanted coordinate of a point that is not reached, if it was one of those varied.
std::optional<double> wanted(const WorkspaceTask& task, const WorkspacePoint& point, int freedom) {
  for (std::size_t i = 0; i < point.asked.size(); ++i)
    if (task.question.axes[i].freedom == freedom) return point.asked[i];
  return std::nullopt;
}

std::string picture(const WorkspaceTask& task, const WorkspaceReport& report,
                    const std::string& view) {
  const WorkspaceCounts counts = count(report.points);
  const auto [i, j] = plane_of(task, counts, view);
  // colours that colour-blind people tell apart: Okabe and Ito (2008)
  ScatterGroup none{"not reached", "#bbbbbb", {}}, good{"stable, limits kept", "#0072b2", {}},
      broken{"stable, a limit broken", "#e69f00", {}}, unstable{"unstable", "#d55e00", {}},
      singular{"singular", "#cc79a7", {}};
  std::size_t nowhere = 0;
  for (const WorkspacePoint& point : report.points) {
    if (!point.reached()) {
      const auto x = wanted(task, point, i), y = wanted(task, point, j);
      if (x && y)
        none.points.emplace_back(*x, *y);
      else
        ++nowhere;
      continue;
    }
    ScatterGroup& group = point.verdict == StabilityVerdict::kUnstable   ? unstable
                          : point.verdict == StabilityVerdict::kSingular ? singular
                          : point.positions_kept && point.efforts_kept   ? good
                                                                         : broken;
    group.points.emplace_back(point.position[i], point.position[j]);
  }
  Scatter scatter;
  scatter.title = fmt::format("{}: reached positions of {}", report.label, task.frame_name);
  scatter.x_label = fmt::format("{} [m]", kAxes[i]);
  scatter.y_label = fmt::format("{} [m]", kAxes[j]);
  for (ScatterGroup& group : std::vector<ScatterGroup>{none, good, broken, unstable, singular})
    if (!group.points.empty()) scatter.groups.push_back(group);
  scatter.notes.push_back(fmt::format("{} points", report.points.size()));
  if (nowhere > 0)
    scatter.notes.push_back(fmt::format("{} without equilibrium, not shown", nowhere));
  return to_svg(scatter);
}

std::string vtk(const WorkspaceTask& task, const WorkspaceReport& report) {
  std::vector<Vec3> positions;
  std::vector<PointArray> arrays{{"point", {}},       {"unstable", {}},     {"singular", {}},
                                 {"limits_kept", {}}, {"efforts_kept", {}}, {"roll", {}},
                                 {"pitch", {}},       {"yaw", {}}};
  const std::size_t own = arrays.size();
  for (const Parameter& drive : task.drives) {
    arrays.push_back({drive.name, {}});
    arrays.push_back({drive.name.substr(0, drive.name.rfind('.')) + " drive effort", {}});
  }
  for (const WorkspacePoint& point : report.points) {
    if (!point.reached()) continue;
    positions.push_back(point.position);
    const double values[] = {static_cast<double>(point.index),
                             static_cast<double>(point.unstable),
                             point.verdict == StabilityVerdict::kSingular ? 1.0 : 0.0,
                             point.positions_kept ? 1.0 : 0.0,
                             point.efforts_kept ? 1.0 : 0.0,
                             point.angles.x(),
                             point.angles.y(),
                             point.angles.z()};
    for (std::size_t k = 0; k < own; ++k)
      arrays[k].values.push_back(values[k]);
    for (std::size_t k = 0; k < point.drives.size(); ++k) {
      arrays[own + 2 * k].values.push_back(point.drives[k]);
      arrays[own + 2 * k + 1].values.push_back(point.efforts[k]);
    }
  }
  return to_points_vtp(positions, arrays);
}

}  // namespace

WorkspaceCounts count(const std::vector<WorkspacePoint>& points) {
  WorkspaceCounts counts;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  counts.low.setConstant(kInfinity);
  counts.high.setConstant(-kInfinity);
  for (const WorkspacePoint& point : points) {
    ++counts.by_status[status_of(point)];
    if (!point.reached()) {
      ++counts.by_reason[point.why];
      continue;
    }
    ++counts.reached;
    ++counts.by_stage[found_by(point)];
    if (!point.positions_kept) ++counts.positions_broken;
    if (!point.efforts_kept) ++counts.efforts_broken;
    counts.low = counts.low.cwiseMin(point.position);
    counts.high = counts.high.cwiseMax(point.position);
  }
  if (counts.reached == 0) counts.low = counts.high = Vec3::Zero();
  return counts;
}

std::string signature_of(const WorkspaceTask& task, const WorkspaceReport& report) {
  std::string text = task.scene.hash + ' ' + version().revision;
  for (const auto& [name, value] : report.options)
    if (name != "--view") text += ' ' + name + ' ' + value;
  return text;
}

std::string to_json(const WorkspaceTask& task, const WorkspaceReport& report) {
  const bool done = report.status == "done";
  Json json = {
      {"schema", std::string(kWorkspaceSchema) + "1"},
      {"status", report.status},
      {"interrupted", report.status == "interrupted"},
      {"exit_code", report.exit_code},
      {"label", report.label},
      {"scene",
       {{"path", report.scene_path}, {"name", task.scene.name}, {"hash", task.scene.hash}}},
      {"version", {{"number", version().number}, {"revision", version().revision}}},
      {"options", options_json(report)},
      {"seed", task.scene.simulation.seed},
      {"kind", task.question.poses ? "poses" : "drives"},
      {"frame", task.frame_name},
      {"axes", axes_json(task, is_random(report))},
      {"held", held_json(task)},
      {"points", task.points.size()},
      {"solved", report.points.size()},
      {"counts", counts_json(count(report.points))},
      {"signature", signature_of(task, report)},
      {"files", Json::array()}};
  for (const char* name : {"points.csv", "points.vtp", "workspace.svg"})
    json["files"].push_back({{"name", name}});
  if (!done) json["files"].push_back({{"name", kWorkspaceJournal}});
  json["timings"] = {
      {"jobs", report.jobs}, {"total", report.seconds}, {"points_before", report.before}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_summary(const WorkspaceTask& task, const WorkspaceReport& report,
                       const std::string& folder) {
  const WorkspaceCounts counts = count(report.points);
  std::string text = fmt::format("{}: {} of {} {} reached, {:.1f} s with {} thread{}\n",
                                 report.label, counts.reached, report.points.size(),
                                 task.question.poses ? "poses" : "drive vectors", report.seconds,
                                 report.jobs, report.jobs == 1 ? "" : "s");
  if (report.before > 0)
    text += fmt::format("  resumed    {} points were solved before\n", report.before);
  text += fmt::format("  stability  {}\n", listed(counts.by_status));
  if (counts.reached > 0) {
    text += fmt::format("  found by   {}\n", listed(counts.by_stage));
    text += fmt::format("  limits     {} beyond a joint's limit, {} beyond an effort limit\n",
                        counts.positions_broken, counts.efforts_broken);
    text += fmt::format("  {}  x {:.4g} .. {:.4g}, y {:.4g} .. {:.4g}, z {:.4g} .. {:.4g} m\n",
                        task.frame_name, counts.low.x(), counts.high.x(), counts.low.y(),
                        counts.high.y(), counts.low.z(), counts.high.z());
  }
  std::size_t told = 0;
  for (const auto& [why, number] : ranked(counts.by_reason))
    if (told++ < 3) text += fmt::format("  not        {}: {}\n", number, why);
  return text + fmt::format("  wrote      {}/{{points.csv,points.vtp,workspace.svg,{}}}\n", folder,
                            kWorkspaceReport);
}

void write_points(const WorkspaceTask& task, const WorkspaceReport& report,
                  const std::filesystem::path& folder, const std::string& view) {
  const WorkspaceTable table(task);
  OutputFile csv(folder / "points.csv");
  csv.write(table.header());
  for (const WorkspacePoint& point : report.points)
    csv.write(table.row(point));
  csv.commit();
  write_file(folder / "points.vtp", vtk(task, report));
  write_file(folder / "workspace.svg", picture(task, report, view));
}

}  // namespace cprsim
