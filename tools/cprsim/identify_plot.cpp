// SPDX-License-Identifier: BSD-3-Clause
// The residual plot: measured against computed, and what is left, one row of pictures a channel.
// gnuplot draws it from a script that stays beside it.
#include <fmt/core.h>

#include <algorithm>

#include "tools/cprsim/gnuplot.h"
#include "tools/cprsim/identify_result.h"

namespace cprsim {

namespace {

constexpr std::size_t kMostChannels = 8;

std::string script_of(const Study& study) {
  const std::size_t count = std::min(study.matches.size(), kMostChannels);
  const std::string axis = study.dynamic() ? "time [s]" : "row of the table";
  std::string text =
      "# gnuplot identify.gp, in the folder of residuals.csv; -e \"folder='X'\" for another "
      "folder\n"
      "if (!exists(\"folder\")) folder = '.'\n"
      "set datafile separator ','\nset datafile missing NaN\n";
  text +=
      fmt::format("set terminal svg size 1000,{} font 'DejaVu Sans,11' background rgb 'white'\n",
                  60 + 300 * count);
  text += "set output folder.'/identify.svg'\ndata = folder.'/residuals.csv'\n";
  text +=
      "set border 3\nset tics nomirror\nset grid lt 1 lc rgb '#e4e4e4'\nset key outside top center "
      "horizontal\n";
  text += fmt::format("set multiplot layout {},2\nset xlabel {}\n", count, gnuplot_quoted(axis));
  const std::string points = study.dynamic() ? "points pt 7 ps 0.25" : "points pt 7 ps 0.9";
  const std::string lines = study.dynamic() ? "lines lw 1.2" : "points pt 6 ps 1.6 lw 1.5";
  if (!study.dynamic()) text += "set offsets 0.5, 0.5, 0, 0\nset xtics 1\n";
  for (std::size_t m = 0; m < count; ++m) {
    const Channel& channel = study.matches[m].channel;
    const auto pick = [&](int column, const std::string& factor) {
      return fmt::format("2:(strcol(3) eq {} ? ${}{} : NaN)", gnuplot_quoted(channel.name), column,
                         factor);
    };
    text += fmt::format("set ylabel {} noenhanced\n",
                        gnuplot_quoted(channel.name + " [" + channel.unit + "]"));
    text += fmt::format(
        "plot data skip 1 using {} with {} lc rgb '#bbbbbb' title 'at the start', \\\n"
        "  data skip 1 using {} with {} lc rgb '#4e79a7' title 'measured', \\\n"
        "  data skip 1 using {} with {} lc rgb '#e15759' title 'computed'\n",
        pick(6, ""), lines, pick(5, ""), points, pick(7, ""), lines);
    text += fmt::format("set ylabel {}\n",
                        gnuplot_quoted("computed - measured [" + channel.unit + "]"));
    text += fmt::format(
        "plot 0 with lines lc rgb '#888888' notitle, \\\n"
        "  data skip 1 using {} with {} lc rgb '#4e79a7' notitle\n",
        pick(8, ""), study.dynamic() ? points : "impulses lw 3");
  }
  return text + "unset multiplot\n";
}

}  // namespace

bool draw_residuals(const Study& study, const std::filesystem::path& folder,
                    const Console& console) {
  if (study.matches.size() > kMostChannels)
    console.warn(
        fmt::format("the plot shows {} of {} channels", kMostChannels, study.matches.size()));
  return draw_with_gnuplot(folder, "identify", script_of(study), console);
}

}  // namespace cprsim
