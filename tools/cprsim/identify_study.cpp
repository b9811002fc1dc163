// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/identify_study.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scenes/loader/files.h"
#include "scenes/loader/values.h"
#include "tools/cprsim/exit_code.h"

namespace cprsim {

namespace {

const MeasuredColumn& column_named(const MeasuredTable& table, const std::string& name) {
  if (const MeasuredColumn* column = table.find(name)) return *column;
  throw UsageError(
      table.path + " has no such column: " +
      not_one_of(name,
                 "among its columns (" + fmt::format("{}", fmt::join(table.names(), ", ")) + ")",
                 table.names()));
}

/// COLUMN=REST, split at the first = before which a column's name stands: names may hold =.
std::pair<const MeasuredColumn*, std::string> split(const MeasuredTable& table,
                                                    const std::string& text) {
  for (std::size_t at = text.find('='); at != std::string::npos; at = text.find('=', at + 1))
    if (const MeasuredColumn* column = table.find(text.substr(0, at)))
      return {column, text.substr(at + 1)};
  return {&column_named(table, text.substr(0, text.find('='))), ""};
}

std::vector<double> scaled(const std::vector<double>& values, double factor) {
  std::vector<double> all = values;
  for (double& value : all)
    value *= factor;
  return all;
}

/// Values of a column in the unit of a channel.
double factor_to(const MeasuredColumn& column, const Channel& channel) {
  if (column.unit.empty()) return 1;
  const SiUnit unit = *si_unit(column.unit);
  if (unit.name == channel.unit) return unit.factor;
  throw UsageError(fmt::format("column '{}' is in [{}], but {} is in [{}]", column.name,
                               column.unit, channel.name, channel.unit));
}

Channel channel_named(const Scene& scene, const std::string& name) {
  const std::vector<Channel> found = find_channels(scene, name);
  if (found.size() == 1) return found.front();
  if (found.size() > 1) {
    throw UsageError(fmt::format("'{}' is {} channels; name one, e.g. {}", name, found.size(),
                                 found.front().name));
  }
  const std::vector<std::string> nearest = nearest_channels(scene, name);
  throw UsageError(
      fmt::format("'{}' is no channel of this scene{}", name,
                  nearest.empty() ? "" : fmt::format("; near it: {}", fmt::join(nearest, ", "))));
}

void add_inputs(Study& study, const IdentifyOptions& options) {
  for (const std::string& text : options.input) {
    const auto [column, path] = split(study.table, text);
    const double factor = column->unit.empty() ? 1 : si_unit(column->unit)->factor;
    study.inputs.push_back({column->name, path, scaled(column->values, factor)});
  }
}

void add_matches(Study& study, const IdentifyOptions& options, const Scene& scene) {
  const auto add = [&](const MeasuredColumn& column, const Channel& channel) {
    const double factor = factor_to(column, channel);
    study.matches.push_back({column.name, channel, scaled(column.values, factor), std::nullopt});
  };
  for (const std::string& text : options.match) {
    const auto [column, name] = split(study.table, text);
    add(*column, channel_named(scene, name));
  }
  const auto used = [&](const std::string& name) {
    return std::any_of(study.inputs.begin(), study.inputs.end(),
                       [&](const InputColumn& c) { return c.column == name; });
  };
  if (options.match.empty()) {
    for (const MeasuredColumn& column : study.table.columns) {
      if (used(column.name)) continue;
      const std::vector<Channel> found = find_channels(scene, column.name);
      if (found.size() == 1 && found.front().name == column.name) add(column, found.front());
    }
  }
  if (study.matches.empty()) {
    throw UsageError("no column of " + study.table.path +
                     " is called like a channel of the scene; say which was measured with "
                     "--match COLUMN=CHANNEL");
  }
}

void add_sigmas(Study& study, const IdentifyOptions& options) {
  std::vector<std::string> names;
  for (const MatchedColumn& match : study.matches)
    names.push_back(match.column);
  for (const std::string& text : options.sigma) {
    const auto [column, number] = split(study.table, text);
    const auto value = parse_number(number);
    if (!value || !(*value > 0))
      throw UsageError("--sigma " + text + ": '" + number + "' is not a number greater than 0");
    bool measured = false;
    for (MatchedColumn& match : study.matches) {
      if (match.column != column->name) continue;
      match.sigma = *value * factor_to(*column, match.channel);
      measured = true;
    }
    if (!measured)
      throw UsageError("--sigma: " + not_one_of(column->name, "a measured column", names));
  }
  const MatchedColumn& first = study.matches.front();
  for (const MatchedColumn& match : study.matches) {
    if (match.sigma.has_value() != first.sigma.has_value())
      throw UsageError("--sigma for some columns but not for '" +
                       (match.sigma ? first : match).column + "': give all or none");
    if (!match.sigma && match.channel.unit != first.channel.unit) {
      throw UsageError(fmt::format(
          "'{}' is in [{}] and '{}' in [{}]: one standard deviation cannot be estimated for both, "
          "give each with --sigma COLUMN=VALUE",
          first.column, first.channel.unit, match.column, match.channel.unit));
    }
  }
}

void add_times(Study& study, const Scene& scene, double duration, bool shortened) {
  const MeasuredColumn* time = study.table.find("time");
  if (time == nullptr) {
    for (std::size_t row = 0; row < study.table.rows(); ++row)
      study.rows.push_back(row);
    return;
  }
  if (!study.inputs.empty()) {
    throw UsageError(
        "a table with a column 'time' is the record of one run; --input is for tables "
        "whose rows are equilibria");
  }
  if (scene.simulation.mode == Mode::kStatic)
    throw UsageError("the table has a column 'time', but the scene is static");
  const double factor = time->unit.empty() ? 1 : si_unit(time->unit)->factor;
  study.times = scaled(time->values, factor);
  double last = 0;
  for (std::size_t row = 0; row < study.times.size(); ++row) {
    const double t = study.times[row];
    const std::string place = fmt::format("{}:{}: ", study.table.path, study.table.lines[row]);
    if (std::isnan(t)) throw UsageError(place + "a row without a time");
    if (t < last) throw UsageError(place + fmt::format("time {} s after {} s", t, last));
    last = t;
    if (t <= duration * (1 + 1e-12))
      study.rows.push_back(row);
    else
      ++study.rows_after_end;
  }
  if (study.rows_after_end > 0 && !shortened) {
    throw UsageError(
        fmt::format("{} of {} rows lie after the end of the run at {} s; change it with --duration",
                    study.rows_after_end, study.times.size(), duration));
  }
}

void add_cells(Study& study) {
  std::vector<std::size_t> usable;
  for (const std::size_t row : study.rows) {
    const bool complete =
        std::none_of(study.inputs.begin(), study.inputs.end(),
                     [&](const InputColumn& input) { return std::isnan(input.values[row]); });
    study.rows_without_input += complete ? 0 : 1;
    const std::size_t before = study.cells.size();
    for (std::size_t m = 0; complete && m < study.matches.size(); ++m) {
      const double value = study.matches[m].values[row];
      if (std::isnan(value))
        ++study.missing;
      else
        study.cells.push_back({row, m, value});
    }
    if (study.cells.size() > before) usable.push_back(row);
  }
  study.rows = std::move(usable);
  if (study.cells.size() < study.values.size()) {
    throw UsageError(fmt::format("{} measured numbers cannot determine {} values",
                                 study.cells.size(), study.values.size()));
  }
}

void add_values(Study& study, const IdentifyOptions& options, const std::vector<std::string>& got) {
  std::size_t next = 0;
  for (const FitOption& option : options.fit) {
    const std::string& text = got[next];
    next += option.paths.size();
    FittedValue value;
    value.paths = option.paths;
    value.parameter.name = option.name();
    const auto start = option.start ? option.start : parse_number(text);
    if (!start) {
      throw UsageError("'" + option.paths.front() + "' is '" + text +
                       "' in the scene, which is not one number; pick one with #1, #2, ...");
    }
    value.parameter.start = *start;
    if (option.low) {
      value.parameter.low = *option.low;
      value.parameter.high = *option.high;
      if (*start < *option.low || *start > *option.high) {
        throw UsageError(fmt::format("{} is {} in the scene, outside the bounds {} to {}",
                                     option.name(), *start, *option.low, *option.high));
      }
    } else if (*start == 0) {
      throw UsageError(option.name() +
                       " starts at 0, which does not say how large it may be; give bounds: " +
                       option.name() + "=0:LOW:HIGH");
    }
    study.values.push_back(std::move(value));
  }
}

void load_table(Study& study, const IdentifyOptions& options) {
  try {
    study.table = read_measured_table(options.data);
  } catch (const TableError& error) {
    throw UsageError(error.what());
  }
}

/// The scene with what the command line changes, and the texts at the fitted paths.
LoadResult load_for_study(Study& study, const IdentifyOptions& options, const Console& console) {
  FileContent content = options.path == "-" ? read_standard_input() : read_file(options.path);
  study.load = load_options(options.scene);
  if (!content.code.empty()) {
    LoadResult result = load_scene(options.path, study.load);
    console.show(result.diagnostics);
    result.scene.reset();
    return result;
  }
  study.scene_text = std::move(content.text);
  study.scene_name = options.path == "-" ? "<stdin>" : options.path;
  LoadOptions ask = study.load;
  for (const FitOption& option : options.fit)
    ask.get.insert(ask.get.end(), option.paths.begin(), option.paths.end());
  for (const InputColumn& input : study.inputs)
    ask.get.push_back(input.path);
  LoadResult result = load_scene_text(study.scene_text, study.scene_name, ask);
  make_strict(result.diagnostics, options.scene);
  console.show(result.diagnostics);
  if (has_errors(result.diagnostics)) result.scene.reset();
  return result;
}

}  // namespace

std::variant<Study, int> prepare_study(const IdentifyOptions& options, const Console& console) {
  Study study;
  try {
    load_table(study, options);
    add_inputs(study, options);
    const LoadResult loaded = load_for_study(study, options, console);
    if (loaded.scene == nullptr) return kExitSceneInvalid;
    const Scene& scene = *loaded.scene;
    study.label = label_of(options.path, scene);
    study.hash = scene.hash;
    add_values(study, options, loaded.got);
    add_matches(study, options, scene);
    add_sigmas(study, options);
    add_times(study, scene, scene.simulation.duration, options.scene.duration.has_value());
    add_cells(study);
  } catch (const UsageError& error) {
    console.error(error.what());
    return kExitUsage;
  }
  return study;
}

}  // namespace cprsim
