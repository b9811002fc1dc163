// SPDX-License-Identifier: BSD-3-Clause
// A row of two pictures for each quantity: reference and run, and the error over time.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "tools/cprsim/compare_report.h"
#include "tools/cprsim/gnuplot.h"
#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

constexpr std::size_t kMostQuantities = 8;
constexpr std::array kLetters{"x", "y", "z", "w"};
constexpr std::array kColours{"#4e79a7", "#e15759", "#59a14f", "#9c755f"};

std::string cell(const std::string& text) {
  return text.find(',') == std::string::npos ? text : "\"" + text + "\"";
}

/// Long form: quantity, time, error, then value and reference of every component.
void write_table(const CompareReport& report, const std::filesystem::path& file) {
  OutputFile out(file);
  out.write("quantity,time [s],error,error unit,x,y,z,w,x ref,y ref,z ref,w ref\n");
  for (const QuantityComparison& c : report.quantities) {
    const double factor = shown_factor(c);
    for (std::size_t k = 0; k < c.time.size(); ++k) {
      std::string line = cell(c.quantity.name) + "," + shortest(c.time[k]) + "," +
                         shortest(factor * c.error[k]) + "," + shown_unit(c);
      for (const QuantityValue* v : {&c.value[k], &c.expected[k]})
        for (std::size_t i = 0; i < 4; ++i)
          line +=
              "," + (i < c.quantity.width() ? shortest((*v)[static_cast<Eigen::Index>(i)]) : "");
      out.write(line + "\n");
    }
  }
  out.commit();
}

/// Points for the reference, lines for the run, a colour a component.
std::string overlay(const QuantityComparison& c, const std::string& only) {
  std::string text;
  const bool several = c.quantity.width() > 1;
  for (std::size_t i = 0; i < c.quantity.width(); ++i) {
    const std::string letter = several ? std::string(kLetters[i]) + " " : "";
    const auto curve = [&](std::size_t column, const char* style, const char* whose) {
      return fmt::format("data skip 1 using 2:({} ? ${} : NaN) with {} lc rgb '{}' title '{}{}'",
                         only, column, style, kColours[i], letter, whose);
    };
    text += (i > 0 ? ", \\\n  " : "  ") + curve(9 + i, "points pt 7 ps 0.35", "reference") +
            ", \\\n  " + curve(5 + i, "lines lw 1.6", "run");
  }
  return text;
}

std::string script_of(const CompareReport& report) {
  const std::size_t count = std::min(report.quantities.size(), kMostQuantities);
  std::string text = gnuplot_head("compare", 1100, static_cast<int>(60 + 300 * count)) +
                     "data = folder.'/compare.csv'\nset datafile missing NaN\n"
                     "set key outside top center horizontal samplen 2\nset xlabel 'time [s]'\n" +
                     fmt::format("set multiplot layout {},2\n", count);
  for (std::size_t q = 0; q < count; ++q) {
    const QuantityComparison& c = report.quantities[q];
    const std::string only = fmt::format("strcol(1) eq {}", gnuplot_quoted(c.quantity.name));
    const std::string unit = c.quantity.kind == QuantityKind::kAttitude ? "1" : shown_unit(c);
    text += fmt::format("set ylabel {} noenhanced\nplot \\\n",
                        gnuplot_quoted(c.quantity.name + " [" + unit + "]"));
    text += overlay(c, only) + "\n";
    text += fmt::format(
        "set ylabel {} noenhanced\n"
        "plot data skip 1 using 2:({} ? $3 : NaN) with lines lw 1.6 lc rgb '#4e79a7' title {}, \\\n"
        "  {} with lines dt 2 lc rgb '#888888' title {}\n",
        gnuplot_quoted("error [" + shown_unit(c) + "]"), only, gnuplot_quoted("error"),
        shortest(shown_factor(c) * c.numbers.rms), gnuplot_quoted("RMS"));
  }
  return text + "unset multiplot\n";
}

}  // namespace

std::vector<std::string> write_comparison(const CompareReport& report,
                                          const std::filesystem::path& folder,
                                          const Console& console) {
  write_table(report, folder / "compare.csv");
  if (report.quantities.size() > kMostQuantities)
    console.warn(fmt::format("the plot shows {} of {} quantities", kMostQuantities,
                             report.quantities.size()));
  std::vector<std::string> files{"compare.csv", "compare.gp"};
  if (draw_with_gnuplot(folder, "compare", script_of(report), console))
    files.emplace_back("compare.svg");
  return files;
}

}  // namespace cprsim
