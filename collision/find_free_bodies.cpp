// SPDX-License-Identifier: BSD-3-Clause
#include "collision/bullet_world.h"
#include "engine/model/flight.h"

namespace cprsim {

std::vector<int> find_free_bodies(const Scene& scene) {
  const std::vector<char> flying = flying_bodies(scene), among_rods = bodies_among_rods(scene);
  std::vector<int> free_bodies;
  for (std::size_t k = 0; k < flying.size(); ++k)
    if (flying[k] && !among_rods[k]) free_bodies.push_back(static_cast<int>(k));
  return free_bodies;
}

}  // namespace cprsim
