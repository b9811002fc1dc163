// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/resolution.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/cprsim/build_simulation.h"

namespace cprsim {

namespace {

constexpr int kGaussOrder = 6;  // of the integrator that shooting takes unless it is told another

/// Errors fall with this power of the number of pieces.
int order_of(const Resolution& rod) {
  if (rod.method == Method::kCollocation) return rod.order + rod.order % 2;
  return kGaussOrder;
}

}  // namespace

std::vector<Resolution> resolution_of(const Scene& scene) {
  std::vector<Resolution> all;
  const auto simulation = build_simulation(scene);
  for (const RodFacts& rod : simulation->facts().rods)
    all.push_back({rod.method, rod.elements, rod.order});
  return all;
}

Scene cut(Scene scene, const std::vector<Resolution>& rods, double times) {
  const bool finer = times > 1;
  // a degree is a power of ten on what is smooth, and its pieces help where it is not
  const int degrees = std::max(1, static_cast<int>(std::lround(std::abs(std::log10(times)))));
  for (std::size_t i = 0; i < rods.size(); ++i) {
    const Resolution& rod = rods[i];
    const double wanted = rod.elements * std::pow(times, 1.0 / order_of(rod));
    scene.rods[i].method = rod.method;
    scene.rods[i].cut = {finer ? std::max(rod.elements + 1, static_cast<int>(std::ceil(wanted)))
                               : std::max(1, static_cast<int>(wanted)),
                         std::max(1, rod.order + (finer ? degrees : -degrees))};
  }
  return scene;
}

double times_smaller(const std::vector<Resolution>& coarse, const std::vector<Resolution>& fine) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(coarse.size(), fine.size()); ++i) {
    if (coarse[i] == fine[i]) continue;
    const double pieces =
        static_cast<double>(fine[i].elements) / static_cast<double>(coarse[i].elements);
    const double times = fine[i].method == Method::kStrain
                             ? std::pow(10., fine[i].order - coarse[i].order) * pieces
                             : std::pow(pieces, order_of(fine[i]));
    least = std::min(least, times);
  }
  return std::isfinite(least) ? least : 1;
}

}  // namespace cprsim
