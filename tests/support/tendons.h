// SPDX-License-Identifier: BSD-3-Clause
// Tendons for scenes built in code.
#pragma once

#include "tests/support/robots.h"

namespace cprsim {

inline Profile constant_tension(double value) {
  Profile profile;
  ProfileTerm term;
  term.value = value;
  profile.terms.push_back(term);
  return profile;
}

/// A tendon along rod 0 beside its centreline, or wound around it, with its drive.
inline TendonSpec& add_tendon(Scene& scene, double radius, double angle, double tension,
                              double turns = 0) {
  TendonSpec tendon;
  tendon.name = "tendon_" + std::to_string(scene.tendons.size() + 1);
  tendon.rod = 0;
  tendon.radius = radius;
  tendon.angle = angle;
  tendon.turns = turns;
  if (turns != 0) tendon.route = TendonRoute::kHelical;
  DriveSpec drive;
  drive.tendon = static_cast<int>(scene.tendons.size());
  drive.quantity = DriveQuantity::kTension;
  drive.profile = constant_tension(tension);
  scene.drives.push_back(drive);
  scene.tendons.push_back(tendon);
  return scene.tendons.back();
}

/// The last tendon is pulled in by so many metres instead.
inline void displace(Scene& scene, double by) {
  scene.drives.back().quantity = DriveQuantity::kDisplacement;
  scene.drives.back().profile = constant_tension(by);
}

}  // namespace cprsim
