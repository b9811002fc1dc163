// SPDX-License-Identifier: BSD-3-Clause
// Rods that touch, from the scenes of the gallery, whose expectations say where the numbers are
// from. Rods touch where their pieces meet: they are cut finely, not of high order.
#include <cmath>
#include <stdexcept>

#include "scenes/loader/load.h"
#include "tests/bench/reference_cases.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

/// Shooting as the scene says; the others in `elements` pieces.
CaseAnswer by_scene(const char* name, Method method, int elements, double duration,
                    const std::function<double(const Snapshot&)>& measure) {
  LoadResult loaded =
      load_scene(std::string(CPRSIM_SOURCE_DIR) + "/scenes/contact/" + name + ".xml");
  if (!loaded.scene) throw std::runtime_error(std::string("cannot read ") + name);
  Scene& scene = *loaded.scene;
  scene.solver.method = method;
  if (method != Method::kShooting) {
    scene.solver.points.reset();
    scene.solver.integrator.reset();
    scene.solver.elements = elements;
    scene.solver.order = 3;
    scene.solver.degree = 4;
  }
  if (duration > 0) scene.simulation.duration = duration;
  Simulation simulation(scene);
  CaseAnswer answer;
  answer.unknowns = unknowns_of(simulation.robot());
  const Snapshot end = run_to_end(simulation);
  answer.found = simulation.status() == RunStatus::kDone;
  if (answer.found) answer.error = measure(end);
  return answer;
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

}  // namespace

std::vector<ReferenceCase> contact_cases() {
  return {touchdown(), cylinder(), crossing(), slope()};
}

}  // namespace cprsim
