// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/plot_panels.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <set>

#include "tools/cprsim/command_line.h"
#include "tools/cprsim/gnuplot.h"
#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

constexpr std::array kColours{"#4e79a7", "#e15759", "#59a14f", "#f28e2b", "#b07aa1",
                              "#9c755f", "#76b7b2", "#edc948", "#111111", "#ff9da7"};

std::string colour(std::size_t i) {
  return kColours[i % kColours.size()];
}

std::size_t column_of(const Series& series, const std::string& name) {
  for (std::size_t i = 0; i < series.columns.size(); ++i)
    if (series.columns[i].name == name) return i + 2;  // gnuplot counts from 1, time first
  return 0;
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return name + " [" + (unit.empty() ? "1" : unit) + "]";
}

/// "robot::platform.position.x" is "x" beside its label, other names are what comes last.
std::string short_name(const std::string& column) {
  return column.substr(column.rfind('.') + 1);
}

std::string quoted_cell(const std::string& text) {
  return text.find(',') == std::string::npos ? text : "\"" + text + "\"";
}

const char* kMarginless = "set key outside top center horizontal samplen 2 noenhanced\n";

}  // namespace

std::vector<TimePanel> time_panels(const std::vector<PlotSource>& sources,
                                   const std::vector<std::string>& names) {
  std::vector<TimePanel> panels;
  std::set<std::string> taken;
  TimePanel energy{"energy [J]", {}, false};
  for (const PlotSource& source : sources) {
    for (const SeriesQuantity& quantity : quantities_of(source.series)) {
      const bool wanted =
          names.empty() || std::any_of(names.begin(), names.end(), [&](const std::string& name) {
            const std::string stem = name.ends_with("*") ? name.substr(0, name.size() - 1) : name;
            return quantity.name == name || name.starts_with(quantity.name + ".") ||
                   (name.ends_with("*") && quantity.name.starts_with(stem));
          });
      if (!wanted || !taken.insert(quantity.name).second) continue;
      if (quantity.name.starts_with("energy.") && quantity.name != "energy.balance") {
        energy.columns.push_back(quantity.name);
        continue;
      }
      const std::string unit = source.series.columns[quantity.columns[0]].unit;
      TimePanel panel{with_unit(quantity.name, unit), {}, quantity.name == "solver.residual"};
      for (std::size_t i = 0; i < quantity.width(); ++i)
        panel.columns.push_back(source.series.columns[quantity.columns[i]].name);
      panels.push_back(std::move(panel));
    }
  }
  if (!energy.columns.empty()) panels.insert(panels.begin(), energy);
  return panels;
}

std::string widest_plane(const MatX& points) {
  std::array<double, 3> extent{};
  if (points.cols() > 0)
    for (int i = 0; i < 3; ++i)
      extent[static_cast<std::size_t>(i)] = points.row(i).maxCoeff() - points.row(i).minCoeff();
  const auto least = std::min_element(extent.begin(), extent.end()) - extent.begin();
  // of two that are equally narrow y goes: upright robots are drawn upright
  if (extent[1] <= extent[static_cast<std::size_t>(least)] + 1e-12) return "xz";
  return least == 0 ? "yz" : least == 1 ? "xz" : "xy";
}

std::string time_script(const std::vector<PlotSource>& sources,
                        const std::vector<TimePanel>& panels) {
  const std::size_t columns = panels.size() > 3 ? 2 : 1;
  const std::size_t rows = (panels.size() + columns - 1) / columns;
  std::string text =
      gnuplot_head("plot", columns > 1 ? 1300 : 900, static_cast<int>(40 + 300 * rows));
  text += "set datafile missing NaN\nset xlabel 'time [s]'\n" + std::string(kMarginless);
  text += fmt::format("set multiplot layout {},{}\n", rows, columns);
  for (const TimePanel& panel : panels) {
    text += fmt::format("set ylabel {} noenhanced\n{}\nplot \\\n", gnuplot_quoted(panel.label),
                        panel.logarithmic ? "set logscale y\nset format y '10^{%T}'"
                                          : "unset logscale y\nset format y '%g'");
    std::string curves;
    for (std::size_t s = 0; s < sources.size(); ++s) {
      for (std::size_t i = 0; i < panel.columns.size(); ++i) {
        const std::size_t column = column_of(sources[s].series, panel.columns[i]);
        if (column == 0) continue;
        const std::string name =
            (panel.columns.size() > 1 ? short_name(panel.columns[i]) : std::string()) +
            (sources.size() > 1 ? (panel.columns.size() > 1 ? ", " : "") + sources[s].label : "");
        // a curve of nothing but zeros cannot be drawn on a logarithmic axis
        curves += fmt::format(
            "{}  folder.'/source_{}.csv' skip 1 using 1:({}) with lines lw 1.6 dt {} lc rgb '{}' "
            "{}",
            curves.empty() ? "" : ", \\\n", s + 1,
            panel.logarithmic ? fmt::format("${0} > 0 ? ${0} : NaN", column)
                              : fmt::format("${}", column),
            1 + s % 4, colour(sources.size() > 1 && panel.columns.size() == 1 ? s : i),
            name.empty() ? "notitle" : "title " + gnuplot_quoted(name));
      }
    }
    text += curves + "\n";
  }
  return text + "unset multiplot\n";
}

std::string path_script(const std::vector<PlotSource>& sources,
                        const std::vector<std::string>& positions, std::string plane) {
  std::string curves;
  std::size_t count = 0;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const Series& series = sources[s].series;
    for (const std::string& position : positions) {
      const std::size_t x = column_of(series, position + ".x");
      if (x == 0) continue;
      MatX points(3, series.size());
      for (std::size_t k = 0; k < series.size(); ++k)
        for (std::size_t i = 0; i < 3; ++i)
          points(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
              series.columns[x - 2 + i].values[k];
      if (plane.empty()) plane = widest_plane(points);
      curves += fmt::format(
          "{}  folder.'/source_{}.csv' skip 1 using {}:{} with lines lw 1.6 lc rgb '{}' title {}, "
          "\\\n"
          "  folder.'/source_{}.csv' skip 1 every ::0::0 using {}:{} with points pt 7 ps 0.8 lc "
          "rgb "
          "'{}' notitle",
          curves.empty() ? "" : ", \\\n", s + 1, x + static_cast<std::size_t>(plane[0] - 'x'),
          x + static_cast<std::size_t>(plane[1] - 'x'), colour(count),
          gnuplot_quoted(position + (sources.size() > 1 ? ", " + sources[s].label : "")), s + 1,
          x + static_cast<std::size_t>(plane[0] - 'x'),
          x + static_cast<std::size_t>(plane[1] - 'x'), colour(count));
      ++count;
    }
  }
  if (curves.empty()) throw UsageError("--path: none of the sources has such a position");
  return gnuplot_head("plot", 900, 800) + "set datafile missing NaN\nset size ratio -1\n" +
         kMarginless +
         fmt::format("set xlabel '{} [m]'\nset ylabel '{} [m]'\nplot \\\n", plane[0], plane[1]) +
         curves + "\n";
}

std::string shape_script(const std::vector<RodShape>& shapes, std::string plane) {
  if (plane.empty()) {
    MatX all(3, 0);
    for (const RodShape& shape : shapes) {
      const Eigen::Index before = all.cols();
      all.conservativeResize(3, before + shape.points.cols());
      all.rightCols(shape.points.cols()) = shape.points;
    }
    plane = widest_plane(all);
  }
  double end = 0;
  for (const RodShape& shape : shapes)
    end = std::max(end, shape.time);
  return gnuplot_head("plot", 1000, 800) +
         fmt::format(
             "set size ratio -1\nunset key\nset xlabel '{} [m]'\nset ylabel '{} [m]'\n"
             "set cblabel 'time [s]'\nset palette defined (0 '#c6dbef', 1 '#08306b')\n"
             "set cbrange [0:{}]\n{}plot folder.'/shapes.csv' skip 1 using {}:{}:2 with lines lw "
             "1.6 "
             "palette\n",
             plane[0], plane[1], end > 0 ? end : 1, end > 0 ? "" : "unset colorbox\n",
             3 + (plane[0] - 'x'), 3 + (plane[1] - 'x'));
}

std::string table_of(const Series& series) {
  std::string text = "time [s]";
  for (const SeriesColumn& column : series.columns)
    text += "," + quoted_cell(with_unit(column.name, column.unit));
  text += "\n";
  for (std::size_t k = 0; k < series.size(); ++k) {
    text += shortest(series.time[k]);
    for (const SeriesColumn& column : series.columns)
      text += "," + shortest(column.values[k]);
    text += "\n";
  }
  return text;
}

std::string table_of(const std::vector<RodShape>& shapes) {
  std::string text = "rod,time [s],x [m],y [m],z [m]\n";
  for (const RodShape& shape : shapes) {
    for (Eigen::Index k = 0; k < shape.points.cols(); ++k)
      text += quoted_cell(shape.rod) + "," + shortest(shape.time) + "," +
              shortest(shape.points(0, k)) + "," + shortest(shape.points(1, k)) + "," +
              shortest(shape.points(2, k)) + "\n";
    text += "\n";  // lifts the pen
  }
  return text;
}

}  // namespace cprsim
