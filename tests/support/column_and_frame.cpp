// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/column_and_frame.h"

#include <utility>

namespace cprsim {

Scene lees_frame() {
  Scene scene;
  switch_on(scene, {Effect::kExtension, Effect::kShear});
  BodySpec corner;
  corner.name = "corner";
  corner.X_WB.p = {0, 0, 120};
  scene.bodies.push_back(corner);
  RodSpec leg = steel_rod(120, 1);
  leg.section.shape = SectionShape::kRectangle;
  leg.section.size = {2, 3};
  leg.material->youngs_modulus = 7.2e6;
  leg.material->shear_modulus = 7.2e6 / 2.6;
  const Mat3 along_x = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()).toRotationMatrix();
  leg.base.joint = EndJoint::kRevolute;
  leg.base.axis = Vec3::UnitY();
  leg.tip.joint = EndJoint::kFixed;
  leg.tip.at.body = 0;
  scene.rods.push_back(leg);
  std::swap(leg.base, leg.tip);
  leg.base.at.X_BF.R = along_x;
  leg.tip.at.X_BF = {along_x, {120, 0, 120}};
  leg.name = "beam";
  scene.rods.push_back(leg);
  add_load(scene, 0.2, Vec3::Zero()).rod = 1;
  return scene;
}

DriveSpec& turn_base(Scene& scene) {
  const int motor = static_cast<int>(scene.bodies.size());
  scene.bodies.emplace_back().name = "motor";
  scene.rods[0].base.at = {motor, Pose{}};
  JointSpec axle;
  axle.name = "axle";
  axle.kind = JointKind::kContinuous;
  axle.child = motor;
  scene.joints.push_back(axle);
  DriveSpec drive;
  drive.joint = static_cast<int>(scene.joints.size()) - 1;
  scene.drives.push_back(drive);
  return scene.drives.back();
}

}  // namespace cprsim
