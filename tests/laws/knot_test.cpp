// SPDX-License-Identifier: BSD-3-Clause
// A knot that is pulled together stays the knot that it was. Where a strand passes through another
// the writhe
//   Wr = 1 / (4 pi) int int (x - y) . (dx × dy) / |x - y|^3                              (1)
// jumps by 2. And the determinant of a knot, 3 of an overhand knot and 1 of none, is that of its
// colouring matrix: in a projection every crossing has 2 for the arc above and -1 for each that
// ends below; one row and one column are left out (Livingston, Knot Theory, 1993, chapter 3).
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/run/simulation.h"
#include "scenes/loader/load.h"

namespace cprsim {
namespace {

using Curve = std::vector<Vec3>;

Curve curve_of(const Snapshot& now) {
  Curve curve;
  for (const RodPoint& point : now.rods[0].points)
    curve.push_back(point.position);
  return curve;
}

double writhe(const Curve& c) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < c.size(); ++i)
    for (std::size_t j = i + 2; j + 1 < c.size(); ++j) {
      const Vec3 gap = 0.5 * (c[i] + c[i + 1] - c[j] - c[j + 1]);
      sum += gap.dot((c[i + 1] - c[i]).cross(c[j + 1] - c[j])) / std::pow(gap.norm(), 3);
    }
  return sum / (2 * 3.14159265358979323846);
}

/// Of the curve whose ends go on to where they are joined far away. Seen from across the line
/// between them, along which they are the outermost points.
int determinant(const Curve& c) {
  const Vec3 along = (c.back() - c.front()).normalized(),
             eye = along.cross(Vec3(0.31, 0.87, 0.12)).normalized(), up = eye.cross(along);

  struct Crossing {
    double above, below;  // places along the curve
  };

  std::vector<Crossing> crossings;
  for (std::size_t i = 0; i + 1 < c.size(); ++i)
    for (std::size_t j = i + 2; j + 1 < c.size(); ++j) {
      const auto flat = [&](const Vec3& v) { return Vec2(along.dot(v), up.dot(v)); };
      Eigen::Matrix2d A;
      A << flat(c[i + 1] - c[i]), -flat(c[j + 1] - c[j]);
      const Vec2 at = A.inverse() * flat(c[j] - c[i]);
      if (!(at.minCoeff() >= 0 && at.maxCoeff() < 1)) continue;
      const double a = static_cast<double>(i) + at[0], b = static_cast<double>(j) + at[1];
      const double height =
          eye.dot(c[i] + at[0] * (c[i + 1] - c[i]) - c[j] - at[1] * (c[j + 1] - c[j]));
      crossings.push_back(height > 0 ? Crossing{a, b} : Crossing{b, a});
    }
  // arcs run from one place below to the next; the last goes on as the first
  std::sort(crossings.begin(), crossings.end(),
            [](const Crossing& a, const Crossing& b) { return a.below < b.below; });
  const auto n = static_cast<Eigen::Index>(crossings.size());
  if (n < 3) return 1;
  MatX colours = MatX::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto arc = std::count_if(crossings.begin(), crossings.end(), [&](const Crossing& x) {
      return x.below < crossings[static_cast<std::size_t>(k)].above;
    });
    colours(k, arc % n) += 2;
    colours(k, k) -= 1;
    colours(k, (k + 1) % n) -= 1;
  }
  return static_cast<int>(std::lround(std::abs(colours.topLeftCorner(n - 1, n - 1).determinant())));
}

TEST(Knot, ItsDeterminantTellsItFromNone) {
  Curve knot, none;
  for (int i = 0; i <= 300; ++i) {
    const double t = -2.4 + 4.8 * i / 300;
    knot.emplace_back(t * t * t - 3 * t, t * t * t * t - 4 * t * t,
                      0.25 * (std::pow(t, 5) - 10 * t));
    none.emplace_back(t * t * t - 3 * t, t * t * t * t - 4 * t * t, t);
  }
  EXPECT_EQ(determinant(knot), 3);
  EXPECT_EQ(determinant(none), 1);
}

TEST(Knot, ARodNeverPassesThroughItselfWhileItIsPulledTogether) {
  const LoadResult loaded = load_scene(std::string(CPRSIM_SOURCE_DIR) + "/scenes/contact/knot.xml");
  ASSERT_TRUE(loaded.scene);
  Simulation simulation(*loaded.scene);
  simulation.start();
  double last = writhe(curve_of(simulation.now())), most = 0, deepest = 0;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    const Curve curve = curve_of(simulation.now());
    const double now = writhe(curve);
    most = std::max(most, std::abs(now - last));
    last = now;
    deepest = std::max(deepest, simulation.now().contact.penetration);
    ASSERT_EQ(determinant(curve), 3) << simulation.time();
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_LT(most, 0.2);
  EXPECT_LT(deepest, 1e-3 * 0.002);
  EXPECT_GE(simulation.now().contact.count, 3);
}

}  // namespace
}  // namespace cprsim
