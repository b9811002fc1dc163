// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/released_rod.h"

namespace cprsim {

Scene released_rod_scene() {
  Scene scene;
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear, Effect::kRotaryInertia,
                    Effect::kDamping});
  scene.gravity = {-9.81, 0, 0};
  scene.rods.push_back(steel_rod(0.4, 1e-3));
  damp(scene.rods[0], 1e-3);
  add_load(scene, 1, {-1, 0, 0}, Vec3::Zero(), true);
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 1;
  return scene;
}

}  // namespace cprsim
