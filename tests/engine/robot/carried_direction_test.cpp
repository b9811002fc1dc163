// SPDX-License-Identifier: BSD-3-Clause
// Newton directions of rods that carry something along them, tendons or disks, against differences.
#include "tests/engine/robot/newton_direction.h"

namespace cprsim::newton_direction {
namespace {

/// One of each way, all on the rod in the middle; one ends before the tip.
Scene chain_with_tendons(EndJoint base) {
  Scene scene = chain_of_rods(base, EndJoint::kRevolute);
  for (int k = 0; k < 3; ++k) {
    TendonSpec tendon;
    tendon.name = "tendon_" + std::to_string(k);
    tendon.rod = 1;
    tendon.route = static_cast<TendonRoute>(k);
    tendon.radius = 0.2 + 0.05 * k;
    tendon.angle = 0.7 + k;
    tendon.turns = 0.6;
    tendon.points = {{0, 0.2, 0.1}, {0.4, -0.1, 0.15}, {1, 0, -0.2}};
    tendon.termination = k == 1 ? 0.7 : 1;
    scene.tendons.push_back(tendon);
    DriveSpec drive;
    drive.tendon = k;
    drive.quantity = DriveQuantity::kTension;
    drive.profile = constant_profile(0.8 + 0.4 * k);
    scene.drives.push_back(drive);
  }
  return scene;
}

TEST(NewtonDirection, IsExactWithTendons) {
  for (EndJoint base : {EndJoint::kFixed, EndJoint::kBall}) {
    Scene scene = chain_with_tendons(base);
    expect_exact(scene, {}, "statics");
    expect_exact(scene, {Rates::kBackwardEuler}, "dynamics");
    Setting setting;
    setting.softness = 2e-2;
    setting.relaxation = 2;
    setting.fraction = 0.4;
    expect_exact(scene, setting, "soft rods, drag, part of the tension");
    scene.effects.set(Effect::kExtension, true);
    expect_exact(scene, {}, "statics, extensible");
    set_all_effects(scene);
    expect_exact(scene, {}, "statics, all effects");
    expect_exact(scene, {Rates::kBackwardEuler}, "dynamics, all effects");
    expect_exact(scene, {Rates::kGeneralizedAlpha, 1. / 4000}, "dynamics, many segments");
  }
}

// Those whose displacement is given are found taut and slack among the states.
TEST(NewtonDirection, IsExactForTensionsThatAreUnknown) {
  for (EndJoint base : {EndJoint::kFixed, EndJoint::kBall}) {
    Scene scene = chain_with_tendons(base);
    for (const int k : {0, 2}) {
      scene.drives[static_cast<std::size_t>(k)].quantity = DriveQuantity::kDisplacement;
      scene.drives[static_cast<std::size_t>(k)].profile = constant_profile(0.03);
    }
    expect_exact(scene, {}, "statics");
    expect_exact(scene, {Rates::kBackwardEuler}, "dynamics");
    set_all_effects(scene);
    expect_exact(scene, {}, "statics, all effects");
    expect_exact(scene, {Rates::kGeneralizedAlpha}, "dynamics, all effects");
    expect_exact(scene, {Rates::kGeneralizedAlpha, 1. / 4000}, "dynamics, many segments");
  }
}

TEST(NewtonDirection, IsExactWithTendonsThatRub) {
  for (const bool displaced : {false, true}) {
    Scene scene = chain_with_tendons(EndJoint::kFixed);
    scene.effects.set(Effect::kTendonFriction, true);
    for (TendonSpec& tendon : scene.tendons)
      tendon.friction = 0.3;
    if (displaced) {
      scene.drives[0].quantity = DriveQuantity::kDisplacement;
      scene.drives[0].profile = constant_profile(0.03);
    }
    expect_exact(scene, {}, "statics");
    expect_exact(scene, {Rates::kBackwardEuler}, "dynamics");
    set_all_effects(scene);
    expect_exact(scene, {}, "statics, all effects");
    expect_exact(scene, {Rates::kGeneralizedAlpha}, "dynamics, all effects");
  }
}

TEST(NewtonDirection, IsExactWithDisks) {
  Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kRevolute);
  scene.rods[0].disks = {{1, 0.2, 0.3}};
  scene.rods[1].disks = {{0.3, 0.1, 0.2}, {0.3, 0.2, 0.1}, {0.7, 0.3, 0}, {1, 0.1, 0.4}};
  expect_exact(scene, {}, "statics");
  expect_exact(scene, {Rates::kBackwardEuler}, "dynamics");
  scene.loads.push_back(sample_load(true));
  scene.loads.back().rod = 1;
  scene.loads.back().rod_s = 0.7;
  set_all_effects(scene);
  expect_exact(scene, {}, "statics, all effects");
  expect_exact(scene, {Rates::kBackwardEuler}, "dynamics, all effects");
  expect_exact(scene, {Rates::kGeneralizedAlpha}, "dynamics without body rates");
  expect_exact(scene, {Rates::kGeneralizedAlpha, 1. / 4000}, "dynamics, many segments");
}

TEST(NewtonDirection, IsExactWithTendonsInAFluidUnderLoadsAlongTheRod) {
  Scene scene = chain_with_tendons(EndJoint::kFixed);
  scene.drives[0].quantity = DriveQuantity::kDisplacement;
  scene.drives[0].profile = constant_profile(0.03);
  scene.loads.push_back(sample_load(true));
  scene.loads.back().rod = 1;
  scene.loads.back().to = 0.6;
  scene.wind = {0.8, -0.4, 0.5};
  scene.rods[1].disks = {{0.5, 0.1, 0.2}, {1, 0.1, 0.2}};
  scene.effects.set(Effect::kDrag, true);
  expect_exact(scene, {}, "statics");
  expect_exact(scene, {Rates::kBackwardEuler}, "dynamics");
  set_all_effects(scene);
  expect_exact(scene, {Rates::kGeneralizedAlpha}, "dynamics, everything");
}

TEST(NewtonDirection, IsExactWithTies) {
  for (EndJoint base : {EndJoint::kFixed, EndJoint::kBall}) {
    Scene scene = chain_of_rods(base, EndJoint::kRevolute);
    tie_chain(scene);
    expect_exact(scene, {}, "statics");
    expect_exact(scene, {Rates::kBackwardEuler}, "dynamics");
    Setting setting;
    setting.softness = 2e-2;
    setting.relaxation = 2;
    expect_exact(scene, setting, "soft rods, drag");
    set_all_effects(scene);
    expect_exact(scene, {}, "statics, all effects");
    expect_exact(scene, {Rates::kGeneralizedAlpha, 1. / 4000}, "dynamics, many segments");
  }
}

}  // namespace
}  // namespace cprsim::newton_direction
