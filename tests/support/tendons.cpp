// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/tendons.h"

namespace cprsim {

Profile constant_tension(double value) {
  Profile profile;
  ProfileTerm term;
  term.value = value;
  profile.terms.push_back(term);
  return profile;
}

TendonSpec& add_tendon(Scene& scene, double radius, double angle, double tension, double turns) {
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

void displace(Scene& scene, double by) {
  scene.drives.back().quantity = DriveQuantity::kDisplacement;
  scene.drives.back().profile = constant_tension(by);
}

}  // namespace cprsim
