// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/start_table.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>

#include "scenes/loader/suggest.h"
#include "scenes/loader/table.h"

namespace cprsim {
namespace {

/// Chords are shorter than the arcs between their ends, and a rod may be stretched.
constexpr double kShortest = 0.9, kLongest = 1.1;

/// Columns of x, y, z.
using Columns = std::array<std::optional<std::size_t>, 3>;

/// Which columns are whose, by the name of the rod; or what is wrong with them.
std::string list_rods(const Table& table, std::size_t s, std::map<std::string, Columns>& rods) {
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    if (i == s) continue;
    const std::string name = table.names[i].substr(0, table.names[i].find(" ["));
    const std::size_t dot = name.rfind('.');
    const std::string axis = dot == std::string::npos ? "" : name.substr(dot + 1);
    if (axis != "x" && axis != "y" && axis != "z")
      return "column '" + name + "' is none: they are s, <rod>.x, <rod>.y, <rod>.z";
    rods[name.substr(0, dot)][static_cast<std::size_t>(axis[0] - 'x')] = i;
  }
  return rods.empty() ? "it has the shape of no rod" : "";
}

std::string take(const Table& table, std::size_t s, const Columns& columns, RodSpec& rod) {
  double along = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    CurveSample sample;
    sample.s = table.rows[i][s];
    for (int axis = 0; axis < 3; ++axis)
      sample.position[axis] = table.rows[i][*columns[static_cast<std::size_t>(axis)]];
    if (!rod.start.empty()) {
      const double chord = (sample.position - rod.start.back().position).norm();
      if (!(chord > 0))
        return "line " + std::to_string(table.lines[i]) + ": " + rod.name +
               " is where it was in the line before";
      along += chord;
    }
    rod.start.push_back(sample);
  }
  if (along >= kShortest * rod.length && along <= kLongest * rod.length) return "";
  char text[160];
  std::snprintf(text, sizeof text, " is %.4g m long there, and has a <length> of %.4g m", along,
                rod.length);
  return rod.name + text;
}

std::string take(Reading& r, const Table& table) {
  const std::optional<std::size_t> s = table.names.empty() ? std::nullopt : table.column("s");
  if (!s) return "it has no column 's'";
  std::map<std::string, Columns> columns;
  std::string problem =
      table.rows.size() < 4 ? "fewer than four lines" : check_fractions(table, *s);
  if (problem.empty()) problem = list_rods(table, *s, columns);
  for (const auto& [name, of] : columns) {
    if (!problem.empty()) return problem;
    auto& rods = r.scene.rods;
    // clang 14 captures no structured binding
    const auto rod = std::find_if(
        rods.begin(), rods.end(),
        [&wanted = name](const RodSpec& candidate) { return candidate.name == wanted; });
    if (rod == rods.end()) {
      std::vector<std::string> known;
      for (const RodSpec& candidate : rods)
        known.push_back(candidate.name);
      const std::string near = nearest_name(name, known);
      return "there is no rod '" + name + "'" + (near.empty() ? "" : ": '" + near + "'?");
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!of[axis]) return "it has no column '" + name + "." + "xyz"[axis] + "'";
    problem = take(table, *s, of, *rod);
  }
  return problem;
}

}  // namespace

void read_start_table(Reading& r, const Node& initial) {
  const Attribute* file = initial.attribute("file");
  if (!file) return;
  const auto table = read_table(r, initial, file);
  if (!table) return;
  const std::string problem = take(r, *table);
  if (!problem.empty()) complain_of_table(r, initial, file, problem);
}

}  // namespace cprsim
