// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/plot_heat.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/cprsim/gnuplot.h"
#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

constexpr std::array kQuantities{
    SectionQuantity{"curvature", "curvature [1/m]",
                    [](const RodPoint& p, double) { return p.curvature.head<2>().norm(); }},
    SectionQuantity{"twist", "twist [rad/m]",
                    [](const RodPoint& p, double) { return p.curvature.z(); }},
    // of the fibre farthest from the axis, bending alone
    SectionQuantity{"strain", "bending strain [1]",
                    [](const RodPoint& p, double radius) {
                      return radius * (p.curvature - p.rest_curvature).head<2>().norm();
                    }},
    SectionQuantity{"moment", "internal moment [N m]",
                    [](const RodPoint& p, double) { return p.moment.norm(); }},
    SectionQuantity{"force", "axial force, tension positive [N]",
                    [](const RodPoint& p, double) { return p.force.dot(p.rotation.col(2)); }},
};

}  // namespace

const SectionQuantity* find_section_quantity(const std::string& name) {
  const auto* const found =
      std::find_if(kQuantities.begin(), kQuantities.end(),
                   [&](const SectionQuantity& quantity) { return name == quantity.name; });
  return found == kQuantities.end() ? nullptr : found;
}

std::string section_quantities() {
  std::string names;
  for (const SectionQuantity& quantity : kQuantities)
    names += (names.empty() ? "" : ", ") + std::string(quantity.name);
  return names;
}

void add_heat(const std::vector<std::string>& rods, const Snapshot& snapshot, double time,
              const SectionQuantity& quantity, std::vector<HeatMap>& maps) {
  maps.resize(snapshot.rods.size());
  for (std::size_t r = 0; r < snapshot.rods.size(); ++r) {
    const RodSample& rod = snapshot.rods[r];
    maps[r].rod = rods[r];
    maps[r].time.push_back(time);
    std::vector<double>& row = maps[r].values.emplace_back();
    for (int k = 0; k < kHeatPoints; ++k)
      row.push_back(
          quantity.value(point_at(rod, static_cast<double>(k) / (kHeatPoints - 1)), rod.radius));
  }
}

std::string heat_script(const std::vector<HeatMap>& maps, const SectionQuantity& quantity) {
  double least = 0, most = 0;
  for (const HeatMap& map : maps)
    for (const auto& row : map.values)
      for (const double value : row) {
        least = std::min(least, value);
        most = std::max(most, value);
      }
  if (most <= least) most = least + 1;
  const std::size_t columns = maps.size() > 3 ? 2 : 1, rows = (maps.size() + columns - 1) / columns;
  std::string text =
      gnuplot_head("plot", columns > 1 ? 1300 : 900, static_cast<int>(60 + 280 * rows));
  // white is zero, whatever the sign
  const double reach = std::max(-least, most);
  text += least < 0 ? fmt::format(
                          "set cbrange [{}:{}]\nset palette defined (-1 '#053061', -0.5 "
                          "'#4393c3', 0 '#f7f7f7', 0.5 '#d6604d', 1 '#67001f')\n",
                          -reach, reach)
                    : fmt::format(
                          "set cbrange [0:{}]\nset palette defined (0 '#fcfdbf', 0.25 "
                          "'#fe9f6d', 0.5 '#de4968', 0.75 '#8c2981', 1 '#150e37')\n",
                          most);
  text += fmt::format(
      "unset key\nunset grid\nset cblabel '{}'\nset yrange [0:1]\n"
      "set multiplot layout {},{}\n",
      quantity.label, rows, columns);
  for (std::size_t r = 0; r < maps.size(); ++r)
    text += fmt::format(
        "set title {} noenhanced\nset xlabel 'time [s]'\nset ylabel 's / length, base to tip'\n"
        "set xrange [{}:{}]\n"
        "plot folder.'/heat.csv' index {} using 2:3:4 with image\n",
        gnuplot_quoted(maps[r].rod), maps[r].time.front(), maps[r].time.back(), r);
  return text + "unset multiplot\n";
}

// A block for each rod, two empty lines between them.
std::string table_of(const std::vector<HeatMap>& maps, const SectionQuantity& quantity) {
  std::string text = fmt::format("#rod,time [s],s [1],{}\n", quantity.label);
  for (const HeatMap& map : maps) {
    for (std::size_t i = 0; i < map.time.size(); ++i)
      for (std::size_t k = 0; k < map.values[i].size(); ++k)
        text += fmt::format("{},{},{},{}\n", map.rod, shortest(map.time[i]),
                            shortest(static_cast<double>(k) / (kHeatPoints - 1)),
                            shortest(map.values[i][k]));
    text += "\n\n";
  }
  return text;
}

}  // namespace cprsim
