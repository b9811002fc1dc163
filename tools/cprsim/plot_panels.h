// SPDX-License-Identifier: BSD-3-Clause
// Pictures of trajectories: panels over time, paths in a plane, shapes of rods.
#pragma once

#include <string>
#include <vector>

#include "tools/series/series.h"

namespace cprsim {

/// A run, or any other trajectory, as one of several that are drawn over each other.
struct PlotSource {
  std::string label;
  Series series;
};

/// A rod at an instant: 3×N centreline in W, column k is node k.
struct RodShape {
  std::string rod;
  double time = 0;
  MatX points;
};

/// One panel over time: columns of one unit.
struct TimePanel {
  std::string label;                 ///< of the axis, with the unit
  std::vector<std::string> columns;  ///< channel names
  bool logarithmic = false;
};

/// Panels for the quantities named; those of energy.* share one, the balance apart from it.
/// @param names as in a scene; each names a quantity or a channel of some source
std::vector<TimePanel> time_panels(const std::vector<PlotSource>& sources,
                                   const std::vector<std::string>& names);

/// The two axes along which the positions extend most: "xz".
std::string widest_plane(const MatX& points);

/// gnuplot scripts that read source_1.csv, source_2.csv, ..., or shapes.csv.
std::string time_script(const std::vector<PlotSource>& sources,
                        const std::vector<TimePanel>& panels);
std::string path_script(const std::vector<PlotSource>& sources,
                        const std::vector<std::string>& positions, std::string plane);
std::string shape_script(const std::vector<RodShape>& shapes, std::string plane);

/// The files they read.
std::string table_of(const Series& series);
std::string table_of(const std::vector<RodShape>& shapes);

}  // namespace cprsim
