// SPDX-License-Identifier: BSD-3-Clause
// The work-precision diagram: error over processor time and over section evaluations, a line for
// runs that differ in the refined setting only, rings round the cheapest ones.
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "tools/cprsim/gnuplot.h"
#include "tools/cprsim/sweep_result.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

constexpr std::array kColours{"#4e79a7", "#f28e2b", "#e15759", "#76b7b2", "#59a14f", "#edc948",
                              "#b07aa1", "#9c755f", "#111111", "#ff9da7", "#8c8c8c", "#1f9e89"};

struct Line {
  std::string name;
  long runs = 0;
};

std::vector<Line> lines_of(const SweepResult& result) {
  std::vector<Line> lines;
  for (std::size_t i = 0; i < result.runs.size(); ++i) {
    if (!result.runs[i].done()) continue;
    const std::string& name = result.plan.points[i].line;
    const auto known =
        std::find_if(lines.begin(), lines.end(), [&](const Line& l) { return l.name == name; });
    if (known == lines.end())
      lines.push_back({name, 1});
    else
      ++known->runs;
  }
  return lines;
}

/// Columns of sweep.csv, from 1.
struct Columns {
  std::size_t line, status, error, cheapest, cpu, evaluations;
};

Columns columns_of(const SweepPlan& plan) {
  const std::size_t axes = plan.axes.size(), measures = plan.measures.size();
  const std::size_t error = axes + 3, cpu = axes + 2 + measures + 3;
  return {axes + 1, axes + 2, error, cpu - 1, cpu, cpu + 4};
}

std::string panel(const SweepResult& result, const std::vector<Line>& lines, std::size_t x,
                  const std::string& label, bool key) {
  const Columns c = columns_of(result.plan);
  std::string text = fmt::format("set xlabel {}\n{}\nplot \\\n", gnuplot_quoted(label),
                                 key ? "set key at screen 0.735,0.98 left top vertical maxcols 1 "
                                       "Left reverse spacing 1.1 samplen 2 noenhanced"
                                     : "unset key");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += fmt::format(
        "  data skip 1 using (strcol({}) eq {} && strcol({}) eq 'done' ? ${} : NaN):{} with {} pt "
        "{} ps 0.5 lw 1.6 dt {} lc rgb '{}' title {}, \\\n",
        c.line, gnuplot_quoted(lines[i].name), c.status, x, c.error,
        lines[i].runs > 1 ? "linespoints" : "points", i / kColours.size() % 2 == 0 ? 7 : 5,
        1 + i / kColours.size() % 4, kColours[i % kColours.size()], gnuplot_quoted(lines[i].name));
  }
  return text +
         fmt::format(
             "  data skip 1 using (${} == 1 ? ${} : NaN):{} with points pt 6 ps 1.4 lw 1.4 lc "
             "rgb '#111111' title 'cheapest for its error'\n",
             c.cheapest, x, c.error);
}

std::string script_of(const SweepResult& result) {
  const auto lines = lines_of(result);
  const SweepMeasureName& measure = result.plan.measures[0];
  const int height = std::max(480, 80 + 21 * static_cast<int>(lines.size()));
  std::string text = gnuplot_head("sweep", 1620, height);
  text +=
      "data = folder.'/sweep.csv'\nset datafile missing NaN\nset logscale xy\n"
      "set format '10^{%T}'\nset multiplot\n";
  text += fmt::format("set ylabel {} noenhanced\n",
                      gnuplot_quoted("error of " + measure.name + " [" + measure.unit + "]"));
  text += "set lmargin screen 0.07\nset rmargin screen 0.36\n";
  const Columns c = columns_of(result.plan);
  text += panel(result, lines, c.cpu,
                result.plan.dynamic
                    ? fmt::format("CPU time for {:.4g} s simulated [s]", result.plan.duration)
                    : std::string("CPU time [s]"),
                false);
  text += "set lmargin screen 0.43\nset rmargin screen 0.72\nunset ylabel\n";
  text += panel(result, lines, c.evaluations, "section evaluations [1]", true);
  return text + "unset multiplot\n";
}

/// Without a reference: the first channel over the first varied number.
std::string value_script(const SweepResult& result) {
  const SweepPlan& plan = result.plan;
  const std::size_t axes = plan.axes.size();
  const std::size_t first = axes + 2 + plan.measures.size() + 9 + 1;
  std::string text = gnuplot_head("sweep", 900, 560) + "data = folder.'/sweep.csv'\n";
  text += fmt::format(
      "set xlabel {} noenhanced\nset ylabel {} noenhanced\nset key outside top center "
      "horizontal noenhanced\nplot \\\n",
      gnuplot_quoted(plan.axes[0]),
      gnuplot_quoted(plan.measures[0].name + " [" + plan.measures[0].unit + "]"));
  const auto channels = plan.measures[0].channels;
  for (std::size_t i = 0; i < channels.size(); ++i)
    text += fmt::format(
        "  data skip 1 using 1:(strcol({}) eq 'done' ? ${} : NaN) with linespoints pt 7 ps 0.5 lc "
        "rgb '{}' title {}{}\n",
        axes + 2, first + i, kColours[i], gnuplot_quoted(channels[i]),
        i + 1 < channels.size() ? ", \\" : "");
  return text;
}

}  // namespace

const std::vector<std::string>& sweep_files() {
  static const std::vector<std::string> files{"sweep.csv", "sweep.gp",   "sweep.svg",
                                              "sweep.png", "sweep.html", "sweep.journal"};
  return files;
}

void write_sweep(const SweepResult& result, const std::filesystem::path& folder,
                 const Console& console) {
  write_file(folder / "sweep.csv", to_csv(result));
  const bool anything = std::any_of(result.runs.begin(), result.runs.end(),
                                    [](const SweepRun& run) { return run.done(); });
  bool drawn = false;
  if (anything)
    drawn =
        draw_with_gnuplot(folder, "sweep",
                          result.plan.reference_kind == ReferenceKind::kNone ? value_script(result)
                                                                             : script_of(result),
                          console, {"png", "svg"});
  write_file(folder / "sweep.html", to_html(result, drawn ? (folder / "sweep.svg").string() : ""));
}

}  // namespace cprsim
