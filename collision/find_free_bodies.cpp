// SPDX-License-Identifier: BSD-3-Clause
#include "collision/bullet_world.h"

namespace cprsim {

std::vector<int> find_free_bodies(const Scene& scene) {
  std::vector<bool> held(scene.bodies.size());
  const auto hold = [&](int body) {
    if (body != kWorld) held.at(static_cast<std::size_t>(body)) = true;
  };
  for (const JointSpec& joint : scene.joints) {
    hold(joint.parent);
    hold(joint.child);
  }
  for (const RodSpec& rod : scene.rods) {
    if (rod.base.joint != EndJoint::kFree) hold(rod.base.at.body);
    if (rod.tip.joint != EndJoint::kFree) hold(rod.tip.at.body);
  }
  std::vector<int> free_bodies;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k)
    if (!held[k] && !scene.bodies[k].is_static) free_bodies.push_back(static_cast<int>(k));
  return free_bodies;
}

}  // namespace cprsim
