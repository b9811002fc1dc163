// SPDX-License-Identifier: BSD-3-Clause
// A sweep as one page that can be mailed: words, picture, tables; no script, nothing from
// elsewhere.
#include <fmt/core.h>

#include <algorithm>

#include "scenes/loader/files.h"
#include "tools/cprsim/sweep_result.h"

namespace cprsim {

namespace {

constexpr const char* kStyle =
    "body{font:15px/1.45 'DejaVu Sans',sans-serif;max-width:1400px;margin:2em auto;padding:0 1em;"
    "color:#222}table{border-collapse:collapse;margin:1em 0}th,td{padding:.25em .8em;text-align:"
    "right;border-bottom:1px solid #ddd}td:first-child,th:first-child{text-align:left}"
    "svg{width:100%;height:auto}tr.best{background:#eef5ea}p.words{font-size:1.15em}";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

/// The picture itself, without the lines before <svg>.
std::string picture(const std::string& file) {
  if (file.empty()) return "<p>(gnuplot drew no picture)</p>";
  const std::string text = read_file(file).text;
  const std::size_t at = text.find("<svg");
  return at == std::string::npos ? "" : text.substr(at);
}

std::string table(const SweepResult& result) {
  const bool compared = result.plan.reference_kind != ReferenceKind::kNone;
  std::string text = "<table><tr><th>settings</th>";
  if (compared)
    for (const SweepMeasureName& measure : result.plan.measures)
      text += "<th>error of " + escaped(measure.name + " [" + measure.unit + "]") + "</th>";
  else
    for (const std::string& channel : result.plan.channels())
      text += "<th>" + escaped(channel) + "</th>";
  if (compared) text += "<th>order</th>";
  text += "<th>CPU [s]</th><th>steps</th><th>iterations</th><th>section evaluations</th></tr>\n";
  for (std::size_t i = 0; i < result.runs.size(); ++i) {
    const SweepRun& run = result.runs[i];
    if (!run.known || !run.refusal.empty()) continue;
    text += run.cheapest ? "<tr class=best>" : "<tr>";
    text += "<td>" + escaped(settings_text(result.plan.points[i].settings)) + "</td>";
    if (!run.done()) {
      text += "<td colspan=9>" + escaped(run.failure) + "</td></tr>\n";
      continue;
    }
    for (const double value : compared ? run.errors : run.last)
      text +=
          compared ? fmt::format("<td>{:.2e}</td>", value) : fmt::format("<td>{:.8g}</td>", value);
    if (compared) text += "<td>" + (run.order ? fmt::format("{:.1f}", *run.order) : "") + "</td>";
    text += fmt::format("<td>{:.4f}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", run.cpu_seconds,
                        run.statistics.steps,
                        run.statistics.iterations + run.statistics.start_iterations,
                        run.statistics.section_evaluations);
  }
  return text + "</table>\n";
}

}  // namespace

std::string to_html(const SweepResult& result, const std::string& svg) {
  const SweepPlan& plan = result.plan;
  std::string text = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                     escaped(plan.label) + ": what accuracy costs</title><style>" + kStyle +
                     "</style></head><body>\n<h1>" + escaped(plan.label) + "</h1>\n";
  const std::string words = cost_in_words(result);
  if (!words.empty()) text += "<p class=words>" + escaped(words) + "</p>\n";
  if (plan.reference_kind != ReferenceKind::kNone) {
    text += "<p>Errors are those of " + escaped(plan.measures[0].name) + " against " +
            escaped(result.reference_text);
    if (!result.reference_spread.empty())
      text += fmt::format(", which is itself known to about {:.1e} {}", result.reference_spread[0],
                          plan.measures[0].unit);
    text +=
        ". CPU time is that of one core for building, starting and stepping, without files and "
        "pictures; it depends on the machine and on what else it does. Section evaluations, the "
        "number of times that the equations of a cross-section were evaluated, do not. Rings, "
        "and green rows, are runs that nothing cheaper matches.</p>\n";
  }
  return text + picture(svg) + table(result) + "</body></html>\n";
}

}  // namespace cprsim
