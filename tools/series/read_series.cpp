// SPDX-License-Identifier: BSD-3-Clause
#include "tools/series/read_series.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "scenes/loader/values.h"
#include "tools/series/hdf5_series.h"

namespace cprsim {

namespace {

namespace fs = std::filesystem;

bool is_time(const std::string& name) {
  return name == "time" || name == "t" || name == "stamp" || name == "timestamp";
}

/// The first line that is neither empty nor a comment.
std::string_view first_line(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trim(text.substr(0, end));
    if (!line.empty() && line.front() != '#') return line;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return {};
}

bool is_tum(std::string_view text) {
  const auto numbers = parse_numbers(first_line(text));
  return numbers && numbers->size() == 8;
}

void require_increasing(const Series& series, const std::vector<int>& lines) {
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (std::isnan(series.time[i]))
      throw TableError(fmt::format("{}:{}: no time is given", series.path, lines[i]));
    if (i > 0 && series.time[i] <= series.time[i - 1])
      throw TableError(fmt::format("{}:{}: time does not increase", series.path, lines[i]));
  }
}

Series parse_tum(std::string_view text, const std::string& name) {
  Series series;
  series.path = name;
  for (const char* letter : {"x", "y", "z"})
    series.columns.push_back({std::string("position.") + letter, "m", {}});
  for (const char* letter : {"x", "y", "z", "w"})
    series.columns.push_back({std::string("orientation.") + letter, "1", {}});
  std::vector<int> lines;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = trim(text.substr(at, end - at));
    at = end + 1;
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const auto numbers = parse_numbers(line);
    if (!numbers || numbers->size() != series.columns.size() + 1)
      throw TableError(fmt::format(
          "{}:{}: a line of a TUM trajectory is eight numbers, t x y z qx qy qz qw", name, number));
    series.time.push_back(numbers->front());
    for (std::size_t i = 0; i < series.columns.size(); ++i)
      series.columns[i].values.push_back((*numbers)[i + 1]);
    lines.push_back(number);
  }
  require_increasing(series, lines);
  return series;
}

Series to_series(const MeasuredTable& table) {
  Series series;
  series.path = table.path;
  for (const MeasuredColumn& column : table.columns) {
    const auto unit = si_unit(column.unit);
    std::vector<double> values = column.values;
    for (double& value : values)
      value *= unit ? unit->factor : 1;
    if (is_time(column.name) && series.time.empty())
      series.time = std::move(values);
    else
      series.columns.push_back({column.name, unit ? unit->name : "", std::move(values)});
  }
  if (series.time.empty())
    throw TableError(table.path + ": no column is called time [s] (nor t, stamp, timestamp)");
  require_increasing(series, table.lines);
  return series;
}

/// The files of a run that hold channels, each recording once.
std::vector<std::string> recordings_of(const RunFiles& run) {
  std::vector<std::string> names;
  std::set<std::string> seen;  // without their extensions
  for (const char* kind : {"csv", "hdf5"})
    for (const std::string& name : run.of_kind(kind))
      if (seen.insert(fs::path(name).replace_extension()).second) names.push_back(name);
  return names;
}

RunFiles files_in(const nlohmann::json& report, const std::string& folder) {
  const auto list = [](const nlohmann::json& of, const char* name) {
    return of.value(name, nlohmann::json::array());
  };
  const auto object = [&](const char* name) {
    return report.value(name, nlohmann::json::object());
  };
  RunFiles run;
  run.label = report.value("label", "run");
  run.folder = folder;
  run.scene = object("scene").value("path", "");
  for (const nlohmann::json& file : list(report, "files"))
    run.files.push_back({file.value("kind", ""), file.value("name", "")});
  for (const nlohmann::json& rod : list(object("method"), "rods"))
    if (rod.contains("length"))
      run.longest_rod = std::max(run.longest_rod.value_or(0), rod.value("length", 0.0));
  return run;
}

}  // namespace

Series parse_series(const std::string& text, const std::string& name) {
  if (is_tum(text)) return parse_tum(text, name);
  return to_series(parse_measured_table(text, name));
}

bool is_hdf5(const std::string& path) {
  const std::string extension = fs::path(path).extension();
  return extension == ".h5" || extension == ".hdf5";
}

Series read_series(const std::string& path) {
  if (is_hdf5(path)) return read_hdf5_series(path);
  return parse_series(table_text(path), path);
}

std::vector<std::string> RunFiles::of_kind(const std::string& kind) const {
  std::vector<std::string> names;
  for (const File& file : files)
    if (file.kind == kind) names.push_back(file.name);
  return names;
}

RunFiles read_run_files(const std::string& folder) {
  std::ifstream stream(fs::path(folder) / "run.json");
  const nlohmann::json report = nlohmann::json::parse(stream, nullptr, false);
  try {
    if (stream && report.is_object() && report.value("schema", "").rfind("cprsim-run/", 0) == 0)
      return files_in(report, folder);
  } catch (const nlohmann::json::exception&) {  // texts, numbers and lists in the wrong places
    throw std::runtime_error(folder + "/run.json is not as cprsim writes it");
  }
  throw std::runtime_error(folder + " holds no run of cprsim (no run.json)");
}

RecordedRun read_run(const std::string& folder) {
  const RunFiles files = read_run_files(folder);
  RecordedRun run{files.label, files.folder, {}, files.longest_rod};
  for (const std::string& name : recordings_of(files))
    run.recordings.push_back(read_series((fs::path(folder) / name).string()));
  if (run.recordings.empty())
    throw std::runtime_error(folder +
                             ": the run recorded neither CSV nor HDF5 files; its scene needs a "
                             "<cprsim:record> with <csv/> or <hdf5/> and the channels");
  return run;
}

}  // namespace cprsim
