// SPDX-License-Identifier: BSD-3-Clause
// Where a rod's cells begin and end, and how many segments they are cut into.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/section/along.h"

namespace cprsim {

/// Node positions s / L, ascending from 0 to 1: nodes at the stations, and between them cells as
/// equal as the count allows.
std::vector<double> arc_grid(int cells, std::vector<double> stations);

/// With those where a rod's sections are not smooth. @param along may be null.
std::vector<double> all_stations(std::vector<double> stations, const SectionsAlong* along);

/// The same with nodes also where a rod's sections are not smooth. @param along may be null.
std::vector<double> arc_grid(int cells, std::vector<double> stations, const SectionsAlong* along);

/// The node nearest to each station.
std::vector<std::size_t> nodes_at(const std::vector<double>& grid,
                                  const std::vector<double>& stations);

/// Segments that keep the growth of each below e^6, at most one a cell; `now` where that is still
/// enough and not clearly too many, which keeps warm starts.
int wanted_segments(double growth_exponent, int cells, int now);

/// The first cell of each segment, as equal as they can be, and the number of cells.
std::vector<std::size_t> segment_starts(int segments, int cells);

}  // namespace cprsim
