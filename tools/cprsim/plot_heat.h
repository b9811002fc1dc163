// SPDX-License-Identifier: BSD-3-Clause
// Pictures of a quantity along rods and over time: a panel for each rod, colours for the values.
#pragma once

#include <string>
#include <vector>

#include "engine/run/snapshot.h"

namespace cprsim {

/// A number that every section of a rod has.
struct SectionQuantity {
  const char* name;
  const char* label;  ///< of the scale, with the unit
  double (*value)(const RodPoint& point, double radius);
};

/// curvature, twist, strain, moment, force. nullptr if there is no such quantity
const SectionQuantity* find_section_quantity(const std::string& name);

/// All names, separated by commas.
std::string section_quantities();

/// Values of one rod: over time, then along it.
struct HeatMap {
  std::string rod;
  std::vector<double> time;                 ///< s, evenly spaced
  std::vector<std::vector<double>> values;  ///< kHeatPoints of them at each instant, base to tip
};

constexpr int kHeatPoints = 41;

/// Of all rods of the snapshot at its own time; `maps` has one for each rod, or none yet.
void add_heat(const std::vector<std::string>& rods, const Snapshot& snapshot, double time,
              const SectionQuantity& quantity, std::vector<HeatMap>& maps);

/// A gnuplot script that reads heat.csv, which is table_of(maps).
std::string heat_script(const std::vector<HeatMap>& maps, const SectionQuantity& quantity);
std::string table_of(const std::vector<HeatMap>& maps, const SectionQuantity& quantity);

}  // namespace cprsim
