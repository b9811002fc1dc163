// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/workspace_table.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <charconv>

#include "scenes/loader/values.h"
#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

constexpr const char* kPose[] = {"position.x [m]", "position.y [m]", "position.z [m]",
                                 "roll [rad]",     "pitch [rad]",    "yaw [rad]"};
constexpr std::size_t kFixed = 9;  // columns between those asked and those of drives

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) {
    if (c == '"') cell += '"';
    cell += c;
  }
  return cell + '"';
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells{""};
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      const bool twice = inside && i + 1 < line.size() && line[i + 1] == '"';
      if (twice) cells.back() += line[++i];
      if (!twice) inside = !inside;
    } else if (c == ',' && !inside) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

/// Reads cells one after another, and remembers whether all were what they should be.
class CellReader {
 public:
  explicit CellReader(const std::vector<std::string>& cells) : cells_(cells) {}

  const std::string& text() { return cells_[next_++]; }

  double number() { return to_number<double>(text()); }

  int whole() { return to_number<int>(text()); }

  bool yes() { return whole() == 1; }

  bool good() const { return good_; }

 private:
  template <typename T>
  T to_number(const std::string& text) {
    T value{};
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec != std::errc{} || result.ptr != text.data() + text.size()) good_ = false;
    return value;
  }

  const std::vector<std::string>& cells_;
  std::size_t next_ = 0;
  bool good_ = true;
};

void read_stage(const std::string& word, WorkspacePoint& point) {
  point.origin = word.empty()        ? PointOrigin::kNone
                 : word == "inverse" ? PointOrigin::kInverse
                                     : PointOrigin::kForward;
  for (const SolveStage stage : {SolveStage::kNewton, SolveStage::kLevenbergMarquardt,
                                 SolveStage::kContinuation, SolveStage::kRelaxation})
    if (word == to_string(stage)) point.stage = stage;
}

void read_status(const std::string& word, WorkspacePoint& point) {
  for (const StabilityVerdict verdict :
       {StabilityVerdict::kStable, StabilityVerdict::kUnstable, StabilityVerdict::kSingular})
    if (word == to_string(verdict)) point.verdict = verdict;
}

}  // namespace

const char* status_of(const WorkspacePoint& point) {
  return point.reached() ? to_string(point.verdict) : "not reached";
}

const char* found_by(const WorkspacePoint& point) {
  switch (point.origin) {
    case PointOrigin::kNone:
      break;
    case PointOrigin::kForward:
      return to_string(point.stage);
    case PointOrigin::kInverse:
      return "inverse";
  }
  return "";
}

WorkspaceTable::WorkspaceTable(const WorkspaceTask& task) : task_(task) {}

std::string WorkspaceTable::header() const {
  std::string line = "point [1]";
  for (const WorkspaceAxis& axis : task_.question.axes)
    line += fmt::format(",asked.{} [{}]", axis.name, axis.unit);
  line +=
      ",status,found_by,iterations [1],residual [1],unstable [1],limits_kept [1],efforts_kept "
      "[1],broken,why";
  for (const Parameter& drive : task_.drives)
    line += fmt::format(",{} [{}]", drive.name, drive.unit);
  for (const Parameter& drive : task_.drives) {
    const bool turns = drive.unit == "rad" || drive.unit == "N m";
    const std::string stem = drive.name.substr(0, drive.name.rfind('.'));
    line += fmt::format(",{}.effort [{}]", stem, turns ? "N m" : "N");
  }
  for (const char* name : kPose)
    line += fmt::format(",{}.{}", task_.frame_name, name);
  return line + '\n';
}

std::string WorkspaceTable::row(const WorkspacePoint& point) const {
  std::string line = std::to_string(point.index);
  for (const double value : point.asked)
    line += ',' + shortest(value);
  line += fmt::format(",{},{},{},{}", status_of(point), found_by(point), point.iterations,
                      shortest(point.residual));
  if (!point.reached())
    return line + ",,,,," + quoted(point.why) + std::string(2 * task_.drives.size() + 6, ',') +
           '\n';
  line += fmt::format(",{},{},{},{},", point.unstable, point.positions_kept ? 1 : 0,
                      point.efforts_kept ? 1 : 0, fmt::join(point.broken, " "));
  for (const double value : point.drives)
    line += ',' + shortest(value);
  for (const double value : point.efforts)
    line += ',' + shortest(value);
  for (const Vec3& part : {point.position, point.angles})
    for (int i = 0; i < 3; ++i)
      line += ',' + shortest(part[i]);
  return line + '\n';
}

std::optional<WorkspacePoint> WorkspaceTable::read(const std::string& line) const {
  const std::vector<std::string> cells = cells_of(line);
  const std::size_t axes = task_.question.axes.size();
  if (cells.size() != 1 + axes + kFixed + 2 * task_.drives.size() + 6) return std::nullopt;
  CellReader reader(cells);
  WorkspacePoint point;
  const int index = reader.whole();
  if (index < 0 || static_cast<std::size_t>(index) >= task_.points.size()) return std::nullopt;
  point.index = static_cast<std::size_t>(index);
  for (std::size_t i = 0; i < axes; ++i)
    point.asked.push_back(reader.number());
  read_status(reader.text(), point);
  read_stage(reader.text(), point);
  point.iterations = reader.whole();
  point.residual = reader.number();
  if (!point.reached()) {
    for (int i = 0; i < 4; ++i)
      reader.text();
    point.why = reader.text();
  } else {
    point.unstable = reader.whole();
    point.positions_kept = reader.yes();
    point.efforts_kept = reader.yes();
    const std::string broken = reader.text();
    for (const std::string_view name : split_words(broken))
      point.broken.emplace_back(name);
    reader.text();
    for (std::size_t i = 0; i < task_.drives.size(); ++i)
      point.drives.push_back(reader.number());
    for (std::size_t i = 0; i < task_.drives.size(); ++i)
      point.efforts.push_back(reader.number());
    for (Vec3* part : {&point.position, &point.angles})
      for (int i = 0; i < 3; ++i)
        (*part)[i] = reader.number();
  }
  if (!reader.good() || point.asked != task_.points[point.index]) return std::nullopt;
  return point;
}

}  // namespace cprsim
