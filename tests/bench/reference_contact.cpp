// SPDX-License-Identifier: BSD-3-Clause
// Rods that touch, from the scenes of the gallery, whose expectations say where the numbers are
// from. Rods touch where their pieces meet: they are cut finely, not of high order.
#include <algorithm>
#include <cmath>
#include <string>

#include "tests/bench/reference_cases.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

/// Rods that touch are cut finely, not of high order.
CaseAnswer by_scene(const std::string& name, Method method, int elements, double duration,
                    const std::function<double(const Snapshot&)>& measure,
                    const std::function<void(Scene&)>& change = {}) {
  Scene scene = gallery_scene("contact/" + name, method, elements);
  if (change) change(scene);
  if (duration > 0) scene.simulation.duration = duration;
  return run_scene(scene, measure);
}

ReferenceCase touchdown() {
  return {"C01",
          "heavy rod that hangs down onto a floor",
          "moment of the clamp",
          kClosedForm,
          [](Method m) {
            return by_scene("touchdown", m, 60, 0, [](const Snapshot& s) {
              return std::abs(s.rods[0].points.front().moment.norm() / 0.316227766017 - 1);
            });
          },
          1e-4,
          true};
}

ReferenceCase cylinder() {
  return {"C02",
          "rod pressed onto a cylinder",
          "force between them",
          kShootingRk8,
          [](Method m) {
            return by_scene("over_a_cylinder", m, 40, 1.05, [](const Snapshot& s) {
              return std::abs(s.contact.force / 1.40478077682 - 1);
            });
          },
          1e-5};
}

ReferenceCase crossing() {
  return {"C05",
          "clamped rods that cross, 1 mm each",
          "force between them",
          "independent shooting of a half rod",
          [](Method m) {
            return by_scene("crossing", m, 20, 2.5, [](const Snapshot& s) {
              return std::abs(s.contact.force / 0.5833886494 - 1);
            });
          },
          1e-5};
}

ReferenceCase slope() {
  return {"C07",
          "rods that stick, slide and roll on a slope",
          "way of the one that slides",
          kClosedForm,
          [](Method m) {
            return by_scene("slope", m, 8, 0.5, [](const Snapshot& s) {
              return std::abs(point_at(s.rods[1], 0.5).position.x() / 0.104504379 - 1);
            });
          },
          1e-5};
}

// Places of the pegs from the middle: height of the middle under the pegs and of the tip, over
// w L⁴ / EI, and the moment there, over w L².
ReferenceCase two_pegs() {
  return {"C09",
          "heavy rod on two pegs 0.4 to 0.78 L apart, by halves",
          "middle, tip and moment",
          kClosedForm,
          [](Method m) {
            constexpr double kPlaces[][4] = {
                {0.2, 5.66666666667e-4, -2.9125e-3, 0.025},
                {0.27, -1.4306625e-4, -4.8331625e-4, -0.01},
                {0.38985, -4.35125479381e-3, 1.89657457522e-3, -0.069925}};
            constexpr double kWeight = 0.1;  // of 1 m, EI = 1
            CaseAnswer worst;
            worst.found = true;
            for (const auto& at : kPlaces) {
              const CaseAnswer one = by_scene(
                  "resting_on_pegs", m, 20, 0,
                  [&](const Snapshot& s) {
                    const auto& points = s.rods[0].points;
                    return std::max({std::abs(points.front().position.z() / kWeight - at[1]),
                                     std::abs(points.back().position.z() / kWeight - at[2]),
                                     std::abs(points.front().moment.y() / kWeight - at[3])});
                  },
                  [&](Scene& scene) { scene.bodies[0].X_WB.p.x() = at[0]; });
              worst.error = std::max(worst.error, one.error);
              worst.unknowns = one.unknowns;
              worst.found = worst.found && one.found;
            }
            return worst;
          },
          1e-5};
}

/// Of a uniform rod, by the trapezoidal rule.
double middle_x(const RodSample& rod) {
  double sum = 0;
  for (std::size_t k = 1; k < rod.points.size(); ++k)
    sum += 0.5 * (rod.points[k].s - rod.points[k - 1].s) *
           (rod.points[k].position.x() + rod.points[k - 1].position.x());
  return sum / rod.points.back().s;
}

// Pushed to twice the wall's speed v = 1 m/s while a wave runs there and back, T = 2 L / c, from
// t_1 = 6 ms on: v T + 2 v (t - t_1 - T).
ReferenceCase end_on() {
  return {"C12",
          "rod that a wall meets end on: a wave down and back",
          "way of its centre after 50 ms",
          kClosedForm,
          [](Method m) {
            return by_scene(
                "end_on", m, 20, 0,
                [](const Snapshot& s) {
                  constexpr double kTouch = 0.0296647939484, kFlight = 0.05 - 0.006 - kTouch;
                  const double way = 0.5 - middle_x(s.rods[0]);
                  return std::abs(way / (kTouch + 2 * kFlight) - 1);
                },
                // a wave is to pass most of an element within a step
                [&](Scene& scene) {
                  if (m != Method::kShooting) scene.max_step_size = 5e-4;
                });
          },
          0.03};
}

}  // namespace

std::vector<ReferenceCase> contact_cases() {
  return {touchdown(), cylinder(), crossing(), slope(), two_pegs(), end_on()};
}

}  // namespace cprsim
