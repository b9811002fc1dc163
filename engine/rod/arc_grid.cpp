// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/arc_grid.h"

#include <algorithm>
#include <cmath>

namespace cprsim {
namespace {

constexpr double kSegmentGrowth = 6;  // e^6 eps stays far below any tolerance; design section 5

}  // namespace

std::vector<double> arc_grid(int cells, std::vector<double> stations) {
  std::sort(stations.begin(), stations.end());
  std::vector<double> ends{0};
  for (double s : stations)
    if (s > ends.back() + 1e-9 && s < 1 - 1e-9) ends.push_back(s);
  ends.push_back(1);
  std::vector<double> grid{0};
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const double piece = ends[i] - ends[i - 1];
    const int n = std::max(1, static_cast<int>(std::lround(cells * piece)));
    for (int k = 1; k <= n; ++k)
      grid.push_back(k == n ? ends[i] : ends[i - 1] + piece * k / n);
  }
  return grid;
}

std::vector<double> all_stations(std::vector<double> stations, const SectionsAlong* along) {
  if (along) stations.insert(stations.end(), along->breaks().begin(), along->breaks().end());
  return stations;
}

std::vector<double> arc_grid(int cells, std::vector<double> stations, const SectionsAlong* along) {
  return arc_grid(cells, all_stations(std::move(stations), along));
}

std::vector<std::size_t> nodes_at(const std::vector<double>& grid,
                                  const std::vector<double>& stations) {
  std::vector<std::size_t> nodes;
  for (double s : stations) {
    const auto at = std::min_element(grid.begin(), grid.end(), [s](double a, double b) {
      return std::abs(a - s) < std::abs(b - s);
    });
    nodes.push_back(static_cast<std::size_t>(at - grid.begin()));
  }
  return nodes;
}

int wanted_segments(double growth_exponent, int cells, int now) {
  // of a state that makes no sense the exponent may be any number, or none
  const double asked = std::ceil(growth_exponent / kSegmentGrowth);
  const int wanted = !(asked < cells) ? cells : asked > 1 ? static_cast<int>(asked) : 1;
  return wanted < now && 2 * wanted > now ? now : wanted;
}

std::vector<std::size_t> segment_starts(int segments, int cells) {
  std::vector<std::size_t> first;
  for (int g = 0; g <= segments; ++g)
    first.push_back(static_cast<std::size_t>(cells * g / segments));
  return first;
}

}  // namespace cprsim
