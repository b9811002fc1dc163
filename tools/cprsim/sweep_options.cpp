// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/core.h>

#include <cmath>

#include "scenes/loader/values.h"
#include "tools/cprsim/sweep_plan.h"

namespace cprsim {

namespace {

constexpr int kMostValues = 10000;

constexpr const char* kAbout =
    "Runs a scene with many settings, on all cores, and shows what accuracy costs: error against "
    "a\n"
    "tight solution over processor time and over section evaluations, with observed orders and "
    "the\n"
    "cheapest run for each accuracy. Without --vary: what the scene's <cprsim:sweep> asks for, or\n"
    "else all time schemes, steps, tolerances, methods and resolutions that make sense for it.\n"
    "NAME is a setting of the solver (scheme step tolerance points integrator method order degree\n"
    "elements accuracy residual) or any path as for --set; several --vary are a grid.\n\n"
    "Examples\n"
    "  cprsim sweep scene.xml\n"
    "  cprsim sweep scene.xml --vary scheme=esdirk43,bdf2 --vary step=1e-2:1e-4:5log\n"
    "  cprsim sweep scene.xml --vary robot::leg_1/length=0.3:0.5:21 --measure "
    "robot::platform.position";

/// FROM:TO:COUNT[log]; nothing if the text is no range.
std::optional<std::vector<std::string>> range_of(const std::string& text) {
  const std::vector<std::string> parts = split(text, ':');
  if (parts.size() != 3) return std::nullopt;
  const bool log = parts[2].ends_with("log");
  const auto from = parse_number(parts[0]), to = parse_number(parts[1]);
  const auto count = parse_integer(log ? parts[2].substr(0, parts[2].size() - 3) : parts[2]);
  if (!from || !to || !count) return std::nullopt;
  if (*count < 1 || *count > kMostValues)
    throw UsageError("'" + parts[2] + "' is not a number of values");
  if (log && (*from <= 0 || *to <= 0))
    throw UsageError("'" + text + "': logarithmic ranges lie above 0");
  std::vector<std::string> values;
  for (long long i = 0; i < *count; ++i) {
    const double f = *count == 1 ? 0 : static_cast<double>(i) / static_cast<double>(*count - 1);
    const double value = log ? *from * std::pow(*to / *from, f) : (1 - f) * *from + f * *to;
    // six digits are enough for a name and for a value that nobody asked for exactly
    values.push_back(fmt::format("{:.6g}", value));
  }
  return values;
}

SweepAxis axis_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw UsageError("'" + text + "' is not of the form NAME=a,b,c or NAME=FROM:TO:COUNT[log]");
  SweepAxis axis;
  axis.name = text.substr(0, equals);
  const std::string values = text.substr(equals + 1);
  axis.values = range_of(values).value_or(split(values, ','));
  for (const std::string& value : axis.values)
    if (value.empty()) throw UsageError("'" + text + "' has an empty value");
  return axis;
}

}  // namespace

std::variant<SweepOptions, int> parse_sweep_options(const Words& words) {
  SweepOptions options;
  CommandLine line("cprsim sweep", kAbout);
  line.scene(options.path);
  line.each("--vary", "NAME=VALUES", "What to vary, a,b,c or FROM:TO:COUNT or FROM:TO:COUNTlog",
            [&options](const std::string& text) { options.vary.push_back(axis_of(text)); });
  line.texts("--measure", options.measure, "CHANNEL",
             "What is compared (default: the link that most rods hold, or a tip)");
  line.one("--norm", "WHICH", "Errors over time as max (default), rms or final",
           [&options](const std::string& word) {
             if (word != "max" && word != "rms" && word != "final")
               throw UsageError("'" + word + "' is none of max, rms, final");
             options.norm = word;
           });
  line.text("--reference", options.reference, "WHICH",
            "tight (default), ida, none, settings like points=48,tolerance=1e-9, or a CSV, HDF5, "
            "TUM file");
  line.text("--sweep", options.sweep, "NAME",
            "Which <cprsim:sweep> of the scene; all: none of them, but all schemes and methods");
  line.flag("--quick", options.quick, "Without --vary: fewer settings");
  line.count("--repeat", options.repetitions, 1, "Short runs are timed so often; the best counts");
  line.text("-o,--output", options.output, "DIR", "Folder (default out/<scene>_sweep)");
  line.flag("--resume", options.resume, "Go on where an interrupted one stopped");
  line.count("-j,--jobs", options.jobs, 1, "Threads (default: all cores)");
  add_scene_options(line, options.scene);
  add_console_options(line, options.console);
  if (const auto code = line.parse(words)) return *code;
  return options;
}

std::vector<std::pair<std::string, std::string>> SweepOptions::given() const {
  auto list = cprsim::given(scene);
  for (const SweepAxis& axis : vary) {
    std::string values;
    for (const std::string& value : axis.values)
      values += (values.empty() ? "" : ",") + value;
    list.emplace_back("--vary", axis.name + "=" + values);
  }
  for (const std::string& channel : measure)
    list.emplace_back("--measure", channel);
  if (!norm.empty()) list.emplace_back("--norm", norm);
  if (!reference.empty()) list.emplace_back("--reference", reference);
  if (!sweep.empty()) list.emplace_back("--sweep", sweep);
  if (quick) list.emplace_back("--quick", "");
  list.emplace_back("--repeat", std::to_string(repetitions));
  return list;
}

}  // namespace cprsim
