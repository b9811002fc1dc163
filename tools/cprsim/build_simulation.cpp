// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/build_simulation.h"

#include "collision/bullet_world.h"

namespace cprsim {

std::unique_ptr<Simulation> build_simulation(const Scene& scene) {
  const std::vector<int> free_bodies = find_free_bodies(scene);
  if (free_bodies.empty()) return std::make_unique<Simulation>(scene);
  return std::make_unique<Simulation>(scene, make_bullet_world(scene, free_bodies));
}

}  // namespace cprsim
