// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/effects_report.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/cprsim/gnuplot.h"
#include "tools/cprsim/version.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;

std::string name_of(const EffectRow& row) {
  return (row.added ? "with " : "without ") + row.effect;
}

bool any_runs(const EffectsReport& report) {
  return std::any_of(report.rows.begin(), report.rows.end(),
                     [](const EffectRow& row) { return row.problem.empty(); });
}

std::string percent_of_length(const EffectsReport& report, double change) {
  if (report.unit != "m" || report.length <= 0) return "";
  return fmt::format("{:.3g} %", 100 * change / report.length);
}

std::string to_csv(const EffectsReport& report) {
  std::string text = fmt::format(
      "scene,change of {0} [{1}],rms [{1}],CPU [s],section evaluations,time factor,problem\n"
      "as it is,0,0,{2:.6f},{3},1,\n",
      report.measure, report.unit, report.cpu_seconds, report.evaluations);
  for (const EffectRow& row : report.rows) {
    if (row.problem.empty())
      text += fmt::format("{},{:.6e},{:.6e},{:.6f},{},{:.3f},\n", name_of(row), row.change, row.rms,
                          row.cpu_seconds, row.evaluations, report.time_factor(row));
    else
      text += fmt::format("{},,,,,,\"{}\"\n", name_of(row), row.problem);
  }
  return text;
}

std::string script_of(const EffectsReport& report) {
  const auto count = std::count_if(report.rows.begin(), report.rows.end(),
                                   [](const EffectRow& row) { return row.problem.empty(); });
  std::string text = gnuplot_head("effects", 1100, static_cast<int>(150 + 45 * count));
  text +=
      "data = folder.'/effects.csv'\nset datafile missing NaN\nunset key\nset multiplot\n"
      "set style fill solid\nset boxwidth 0.6\n"
      "unset ytics\nset border 1\nset grid noytics xtics\nset bmargin screen 0.24\nset tmargin "
      "screen 0.95\n";
  text += fmt::format("set yrange [{}:-0.6]\n", static_cast<double>(count) - 0.4);
  // bars, then their names and numbers; NaN rows are not run
  std::string names, first = "set lmargin screen 0.20\nset rmargin screen 0.60\n";
  double least = 1e300, most = 0;
  long at = 0;
  std::string bars, costs;
  for (const EffectRow& row : report.rows) {
    if (!row.problem.empty()) continue;
    const double shown = std::max({row.change, report.numerical_error / 10, 1e-16});
    least = std::min(least, shown);
    most = std::max(most, shown);
    names += fmt::format("set label {} {} at screen 0.19, first {} right noenhanced\n", at + 1,
                         gnuplot_quoted(name_of(row)), at);
    bars += fmt::format("{} {:.6e}\n", at, shown);
    costs += fmt::format("{} {:.4f}\n", at, report.time_factor(row));
    ++at;
  }
  // a bar of nothing at all has no logarithm: none is drawn for less than a tenth of the error
  const double floor = std::max({least / 3, report.numerical_error / 10, 1e-9 * most});
  text += "$bars << END\n" + bars + "END\n$costs << END\n" + costs + "END\n";
  text += "set datafile separator whitespace\n" + first + names;
  text += fmt::format(
      "set logscale x\nset format x '10^{{%T}}'\nset xrange [{:.3e}:{:.3e}]\nset xlabel {} "
      "noenhanced\n"
      "set arrow 1 from {:.3e}, graph 0 to {:.3e}, graph 1 nohead dt 2 lc rgb '#888888'\n"
      "set label 100 'error of the runs themselves' at {:.3e}, screen 0.04 center tc rgb "
      "'#888888'\n"
      "plot $bars using ($2/2+{:.3e}/2):1:(0.5*($2-{:.3e})):(0.3) with boxxyerror lc rgb "
      "'#4e79a7'\n",
      floor, most * 3, gnuplot_quoted("change of " + report.measure + " [" + report.unit + "]"),
      report.numerical_error, report.numerical_error, std::max(report.numerical_error, floor),
      floor, floor);
  double slowest = 1;
  for (const EffectRow& row : report.rows)
    if (row.problem.empty()) slowest = std::max(slowest, report.time_factor(row));
  text += fmt::format(
      "unset label\nunset arrow\nunset logscale x\nset format x '%g'\nset lmargin screen 0.66\n"
      "set rmargin screen 0.97\nset xrange [0:{:.3f}]\nset xlabel 'section evaluations, relative "
      "to the scene as it is [1]'\n"
      "set arrow 1 from 1, graph 0 to 1, graph 1 nohead dt 2 lc rgb '#888888'\n"
      "plot $costs using ($2/2):1:($2/2):(0.3) with boxxyerror lc rgb '#f28e2b'\nunset multiplot\n",
      slowest * 1.1);
  return text;
}

}  // namespace

double EffectsReport::time_factor(const EffectRow& row) const {
  return evaluations > 0 ? static_cast<double>(row.evaluations) / static_cast<double>(evaluations)
                         : 1;
}

std::string to_json(const EffectsReport& report) {
  Json json = {{"schema", "cprsim-effects/1"},
               {"scene", report.scene_path},
               {"version", {{"number", version().number}, {"revision", version().revision}}},
               {"options", Json::array()},
               {"effects", report.effects},
               {"measure", report.measure},
               {"unit", report.unit},
               {"longest_rod", report.length},
               {"duration", report.duration},
               {"numerical_error", report.numerical_error},
               {"cpu_seconds", report.cpu_seconds},
               {"section_evaluations", report.evaluations},
               {"rows", Json::array()},
               {"files", Json::array()}};
  for (const auto& [name, value] : report.options)
    json["options"].push_back({{"name", name}, {"value", value}});
  for (const EffectRow& row : report.rows) {
    Json entry = {{"effect", row.effect}, {"added", row.added}};
    if (row.problem.empty()) {
      entry.update({{"change", row.change},
                    {"rms", row.rms},
                    {"cpu_seconds", row.cpu_seconds},
                    {"section_evaluations", row.evaluations}});
    } else {
      entry["problem"] = row.problem;
    }
    json["rows"].push_back(entry);
  }
  for (const char* name : {"effects.csv", "effects.gp", "effects.svg", "effects.png"})
    json["files"].push_back({{"name", name}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_summary(const EffectsReport& report, const std::string& folder) {
  std::string text =
      fmt::format("{}: bending torsion {}; {} s of CPU time, {} section evaluations\n",
                  report.label, fmt::join(report.effects, " "),
                  fmt::format("{:.3g}", report.cpu_seconds), report.evaluations);
  text += fmt::format("  {:<24} {:>13} {:>11} {:>11} {:>13}\n", "", "change [" + report.unit + "]",
                      "of length", "CPU [s]", "evaluations");
  for (const EffectRow& row : report.rows) {
    if (!row.problem.empty()) {
      text += fmt::format("  {:<24} not run: {}\n", name_of(row), row.problem);
      continue;
    }
    const bool nothing = row.change <= 3 * report.numerical_error;
    text += fmt::format("  {:<24} {:>13} {:>11} {:>11.3g} {:>12.2f}x\n", name_of(row),
                        nothing ? "no more" : fmt::format("{:.3g}", row.change),
                        nothing ? "than error" : percent_of_length(report, row.change),
                        row.cpu_seconds, report.time_factor(row));
  }
  text += fmt::format(
      "  change: largest distance of {} from the scene as it is; these runs themselves err by "
      "about "
      "{:.1g} {}\n",
      report.measure, report.numerical_error, report.unit);
  return text +
         fmt::format("  wrote {}/{{effects.json,effects.csv,effects.svg,effects.png}}\n", folder);
}

void write_effects(const EffectsReport& report, const std::filesystem::path& folder,
                   const Console& console) {
  write_file(folder / "effects.csv", to_csv(report));
  if (any_runs(report))
    draw_with_gnuplot(folder, "effects", script_of(report), console, {"png", "svg"});
}

}  // namespace cprsim
