// SPDX-License-Identifier: BSD-3-Clause
// What loads and tendons do to a rod at an instant.
#include "engine/robot/robot.h"

namespace cprsim {

PointLoad load_at(const LoadSpec& load, double t, bool before) {
  const double f = load.has_profile ? load.profile.evaluate(t, before).value : 1.0;
  return {load.rod_s, f * (load.R_expressed * load.force), f * (load.R_expressed * load.torque),
          load.follower};
}

LineLoad line_load_at(const LoadSpec& load, double t, bool before) {
  const PointLoad at = load_at(load, t, before);
  return {load.rod_s, *load.to, at.force, at.torque, at.follower};
}

TendonPull pull_at(const RobotTendon& tendon, double t, bool before) {
  if (!tendon.drive) return {};
  return {tendon.drive->profile.evaluate(t, before).value,
          tendon.drive->quantity == DriveQuantity::kDisplacement};
}

void pull_tendons(RobotRod& rod, double t, bool before, double share) {
  for (double s : rod.breaks) {
    rod.forcing.loads.emplace_back();
    rod.forcing.loads.back().s = s;
  }
  rod.forcing.tendons.clear();
  for (const RobotTendon& tendon : rod.tendons) {
    rod.forcing.tendons.push_back(pull_at(tendon, t, before));
    rod.forcing.tendons.back().value *= share;
  }
}

}  // namespace cprsim
