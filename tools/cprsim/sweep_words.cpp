// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/cprsim/sweep_result.h"
#include "tools/cprsim/version.h"
#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;

/// "0.04 s", "1.2 ms"
std::string seconds_text(double seconds) {
  if (seconds >= 0.1) return fmt::format("{:.3g} s", seconds);
  return seconds >= 1e-4 ? fmt::format("{:.3g} ms", 1e3 * seconds)
                         : fmt::format("{:.3g} us", 1e6 * seconds);
}

double cost(const SweepResult& result, const SweepRun& run) {
  return result.plan.dynamic && run.end_time > 0 ? run.cpu_seconds / run.end_time : run.cpu_seconds;
}

std::string power_text(double bound) {
  return fmt::format("1e{}", std::lround(std::log10(bound)));
}

std::string status_of(const SweepRun& run) {
  if (!run.known) return "open";
  return !run.refusal.empty() ? "refused" : !run.failure.empty() ? "failed" : "done";
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text)
    out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

std::string setting_of(const SweepPoint& point, const std::string& name) {
  for (const auto& [key, value] : point.settings)
    if (key == name) return value;
  return "";
}

const char* norm_name(Norm norm) {
  return norm == Norm::kRms ? "rms" : norm == Norm::kFinal ? "final" : "max";
}

long count(const SweepResult& result, const std::string& status) {
  return std::count_if(result.runs.begin(), result.runs.end(),
                       [&](const SweepRun& run) { return status_of(run) == status; });
}

Json run_json(const SweepResult& result, std::size_t i) {
  const SweepPoint& point = result.plan.points[i];
  const SweepRun& run = result.runs[i];
  Json settings = Json::object();
  for (const auto& [name, value] : point.settings)
    settings[name] = value;
  Json json = {{"settings", settings}, {"line", point.line}, {"status", status_of(run)}};
  if (!run.refusal.empty()) json["reason"] = run.refusal;
  if (!run.failure.empty()) json["reason"] = run.failure;
  if (!run.done()) return json;
  json["errors"] = run.errors;
  if (run.order) json["order"] = *run.order;
  json["cheapest"] = run.cheapest;
  json["cpu_seconds"] = run.cpu_seconds;
  json["steps"] = run.statistics.steps;
  json["iterations"] = run.statistics.iterations + run.statistics.start_iterations;
  json["section_evaluations"] = run.statistics.section_evaluations;
  json["last"] = run.last;
  return json;
}

std::string decades_text(const SweepResult& result) {
  const auto list = decades(result);
  if (list.empty()) return "";
  const SweepMeasureName& measure = result.plan.measures[0];
  std::string text = fmt::format("  {:>10} {:>12} {:>14}  {}\n", "error [" + measure.unit + "]",
                                 result.plan.dynamic ? "CPU / sim. s" : "CPU", "section evals",
                                 "cheapest setting");
  for (const Decade& d : list) {
    const SweepRun& run = result.runs[d.run];
    text += fmt::format("  {:>10.1e} {:>12} {:>14}  {}\n", run.errors[0],
                        seconds_text(cost(result, run)), run.statistics.section_evaluations,
                        settings_text(result.plan.points[d.run].settings));
  }
  return text;
}

/// Runs without a reference: just what came out.
std::string values_text(const SweepResult& result) {
  std::string text;
  const auto channels = result.plan.channels();
  for (std::size_t i = 0; i < result.runs.size() && i < 40; ++i) {
    if (!result.runs[i].done()) continue;
    text += "  " + settings_text(result.plan.points[i].settings) + ": ";
    for (std::size_t c = 0; c < channels.size(); ++c)
      text += fmt::format("{} = {:.6g}{}", channels[c], result.runs[i].last[c],
                          c + 1 < channels.size() ? ", " : "\n");
  }
  return text;
}

}  // namespace

std::string cost_in_words(const SweepResult& result) {
  const auto list = decades(result);
  if (list.empty()) return "";
  const std::string unit = result.plan.measures[0].unit;
  std::string text;
  double last = 0;
  for (const Decade& d : list) {
    const SweepRun& run = result.runs[d.run];
    if (text.empty()) {
      text = fmt::format("{} {} costs {} of one core{} with {}", power_text(d.bound), unit,
                         seconds_text(cost(result, run)),
                         result.plan.dynamic ? " per simulated second" : "",
                         settings_text(result.plan.points[d.run].settings));
    } else {
      text += fmt::format("; {} {} costs {:.2g} times more", power_text(d.bound), unit,
                          run.cpu_seconds / last);
    }
    last = run.cpu_seconds;
  }
  return text + ".";
}

std::string to_summary(const SweepResult& result, const std::string& folder) {
  std::string text = fmt::format("{}: {} runs in {:.3g} s on {} threads", result.plan.label,
                                 count(result, "done"), result.seconds, result.jobs);
  for (const char* status : {"failed", "refused", "open"})
    if (count(result, status) > 0) text += fmt::format(", {} {}", count(result, status), status);
  text += "\n";
  if (result.plan.reference_kind == ReferenceKind::kNone) {
    text += values_text(result);
  } else {
    const SweepMeasureName& measure = result.plan.measures[0];
    text += fmt::format("  error      {} of {} against {}\n", norm_name(measure.norm), measure.name,
                        result.reference_text);
    if (!result.reference_spread.empty())
      text += fmt::format("             which is known to about {:.1e} {}\n",
                          result.reference_spread[0], measure.unit);
    text += decades_text(result);
    const std::string words = cost_in_words(result);
    if (!words.empty()) text += "  " + words + "\n";
  }
  return text +
         fmt::format("  wrote      {}/{{sweep.json,sweep.csv,sweep.html,sweep.svg,sweep.png}}\n",
                     folder);
}

std::string to_json(const SweepResult& result) {
  const SweepPlan& plan = result.plan;
  Json json = {{"schema", "cprsim-sweep/1"},
               {"status", result.status},
               {"label", plan.label},
               {"scene", {{"path", result.scene_path}, {"hash", plan.scene_hash}}},
               {"version",
                {{"number", version().number},
                 {"revision", version().revision},
                 {"build", version().build}}},
               {"options", Json::array()},
               {"duration", plan.duration},
               {"longest_rod", plan.length},
               {"reference", result.reference_text},
               {"reference_spread", result.reference_spread},
               {"measures", Json::array()},
               {"words", cost_in_words(result)},
               {"decades", Json::array()},
               {"runs", Json::array()},
               {"seconds", result.seconds},
               {"jobs", result.jobs},
               {"files", Json::array()}};
  for (const auto& [name, value] : result.options)
    json["options"].push_back({{"name", name}, {"value", value}});
  for (const SweepMeasureName& measure : plan.measures)
    json["measures"].push_back({{"name", measure.name},
                                {"unit", measure.unit},
                                {"norm", norm_name(measure.norm)},
                                {"channels", measure.channels}});
  for (const Decade& d : decades(result))
    json["decades"].push_back({{"bound", d.bound}, {"run", d.run}});
  for (std::size_t i = 0; i < result.runs.size(); ++i)
    json["runs"].push_back(run_json(result, i));
  for (const std::string& name : sweep_files())
    json["files"].push_back({{"name", name}});
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_csv(const SweepResult& result) {
  const SweepPlan& plan = result.plan;
  std::string text;
  for (const std::string& axis : plan.axes)
    text += quoted(axis) + ",";
  text += "line,status";
  for (const SweepMeasureName& measure : plan.measures)
    text += "," + quoted(fmt::format("{} error of {} [{}]", norm_name(measure.norm), measure.name,
                                     measure.unit));
  text +=
      ",order,cheapest,CPU [s],steps,rejected,iterations,section evaluations,factorizations,worst "
      "residual";
  for (const std::string& channel : plan.channels())
    text += "," + quoted("last " + channel);
  text += ",reason\n";
  for (std::size_t i = 0; i < result.runs.size(); ++i) {
    const SweepRun& run = result.runs[i];
    for (const std::string& axis : plan.axes)
      text += quoted(setting_of(plan.points[i], axis)) + ",";
    text += quoted(plan.points[i].line) + "," + status_of(run);
    for (std::size_t m = 0; m < plan.measures.size(); ++m)
      text += "," + (m < run.errors.size() ? fmt::format("{:.6e}", run.errors[m]) : "");
    text += "," + (run.order ? fmt::format("{:.2f}", *run.order) : "") + "," +
            (run.cheapest ? "1" : "0");
    const RunStatistics& s = run.statistics;
    text += run.done() ? fmt::format(",{:.6f},{},{},{},{},{},{:.1e}", run.cpu_seconds, s.steps,
                                     s.rejected + s.retried, s.iterations + s.start_iterations,
                                     s.section_evaluations, s.factorizations, s.worst_residual)
                       : std::string(",,,,,,,");
    for (std::size_t c = 0; c < plan.channels().size(); ++c)
      text += "," + (c < run.last.size() ? shortest(run.last[c]) : "");
    text += "," + quoted(run.refusal + run.failure) + "\n";
  }
  return text;
}

}  // namespace cprsim
