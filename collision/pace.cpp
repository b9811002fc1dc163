// SPDX-License-Identifier: BSD-3-Clause
#include "collision/pace.h"

#include <algorithm>
#include <cmath>

namespace cprsim {
namespace {

constexpr double kLongestSubstep = 1e-3;  // s; the order of contact forces is one
constexpr double kLargestTurn = 0.02;     // rad
constexpr int kMostSubsteps =
    2000;  // bounds the cost; beyond it fast small bodies may sink in first

double distance(const Vec3& centre, const Barrier& barrier) {
  if (barrier.is_plane) return barrier.normal.dot(centre) - barrier.level;
  return (centre - centre.cwiseMax(barrier.low).cwiseMin(barrier.high)).norm();
}

/// Fastest approach of `mover` to anything it may reach; negative if there is nothing.
double approach(double step, std::size_t self, const std::vector<Mover>& movers,
                const std::vector<Barrier>& barriers) {
  const auto fastest = [&](const Mover& m) {
    return m.speed + m.spin * m.radius + m.acceleration * step;
  };
  const Mover& mover = movers[self];
  const double own = fastest(mover);
  double result = -1;
  for (const Barrier& barrier : barriers)
    if (distance(mover.centre, barrier) < mover.radius + (own + barrier.speed) * step)
      result = std::max(result, own + barrier.speed);
  for (std::size_t k = 0; k < movers.size(); ++k) {
    if (k == self || !movers[k].touches) continue;
    const double both = own + fastest(movers[k]);
    const double gap = (mover.centre - movers[k].centre).norm() - mover.radius - movers[k].radius;
    if (gap < both * step) result = std::max(result, both);
  }
  return result;
}

}  // namespace

int count_substeps(double step, const std::vector<Mover>& movers,
                   const std::vector<Barrier>& barriers, double notice) {
  double longest = kLongestSubstep;
  for (std::size_t k = 0; k < movers.size(); ++k) {
    if (movers[k].spin > 0) longest = std::min(longest, kLargestTurn / movers[k].spin);
    if (!movers[k].touches) continue;
    const double speed = approach(step, k, movers, barriers);
    if (speed > 0) longest = std::min(longest, notice / 2 / speed);
  }
  // a step of 1 ms that differs by round-off is one substep, not two
  const double count = std::ceil(step / longest * (1 - 1e-12));
  return static_cast<int>(std::clamp(count, 1.0, static_cast<double>(kMostSubsteps)));
}

}  // namespace cprsim
