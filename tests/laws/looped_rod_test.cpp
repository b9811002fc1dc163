// SPDX-License-Identifier: BSD-3-Clause
// A rod that touches itself, against three rods that are joined end to end, of which the first and
// the last touch each other: the same curve, the same cells, by contact between rods.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "engine/run/simulation.h"
#include "scenes/loader/load.h"

namespace cprsim {
namespace {

constexpr double kRadius = 0.1;  // m, of the ring

/// The frame of the section of the ring at rest, z along it, that lies `angle` behind its base.
Pose on_the_ring(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Pose X;
  X.p = {kRadius * s, kRadius * (1 - c), 0};
  X.R.col(0) = -Vec3::UnitZ();
  X.R.col(1) = Vec3(-s, c, 0);
  X.R.col(2) = Vec3(c, s, 0);
  return X;
}

/// Three rods of a third of the length on light bodies instead of one.
Scene in_three_parts(Scene scene) {
  const RodSpec whole = scene.rods.front();
  scene.effects.set(Effect::kSelfContact, false);
  scene.effects.set(Effect::kContact, true);
  *scene.solver.points /= 3;
  scene.rods.clear();
  const auto first_body = static_cast<int>(scene.bodies.size());
  for (int i = 0; i < 3; ++i) {
    RodSpec part = whole;
    part.name += std::to_string(i);
    part.length = whole.length / 3;
    part.surface.category_bitmask = part.surface.collide_bitmask = i == 1 ? 2 : 1;
    if (i > 0) {
      BodySpec joint;
      joint.name = "joint" + std::to_string(i);
      joint.X_WB = on_the_ring(i * whole.length / 3 / kRadius);
      joint.mass = 0.01;
      joint.inertia = 1e-6 * Mat3::Identity();
      scene.bodies.push_back(joint);
      part.base.joint = EndJoint::kFixed;
      part.base.at = {first_body + i - 1, {}};
    }
    if (i < 2) {
      part.tip.joint = EndJoint::kFixed;
      part.tip.at = {first_body + i, {}};
    }
    scene.rods.push_back(part);
  }
  return scene;
}

void compare(const Scene& scene) {
  Simulation whole(scene), parts(in_three_parts(scene));
  whole.start();
  parts.start();
  int touching = 0;
  while (whole.status() == RunStatus::kRunning) {
    whole.advance();
    // a step may be taken in two
    while (parts.status() == RunStatus::kRunning && parts.time() < whole.time() - 1e-9)
      parts.advance();
    ASSERT_EQ(parts.status(), whole.status()) << parts.failure() << whole.failure();
    ASSERT_NEAR(parts.time(), whole.time(), 1e-12);
    const ContactSample &a = whole.now().contact, &b = parts.now().contact;
    EXPECT_EQ(a.count, b.count) << whole.time();
    if (a.count == 0) continue;
    ++touching;
    EXPECT_NEAR(a.force / b.force, 1, 1e-6) << whole.time();
    EXPECT_NEAR(a.friction, b.friction, 1e-6 * b.force) << whole.time();
    EXPECT_NEAR(a.slip, b.slip, 1e-9) << whole.time();
    EXPECT_LT(a.penetration, 2e-6);
    const Vec3 m_a = whole.now().rods[0].points.front().moment,
               m_b = parts.now().rods[0].points.front().moment;
    EXPECT_LT((m_a - m_b).norm(), 1e-6 * m_b.norm()) << whole.time();
  }
  EXPECT_EQ(whole.status(), RunStatus::kDone);
  EXPECT_GT(touching, 30);
}

LoadResult loop() {
  return load_scene(std::string(CPRSIM_SOURCE_DIR) + "/scenes/contact/loop.xml");
}

TEST(LoopedRod, TouchesItselfAsThreeRodsTouch) {
  const LoadResult loaded = loop();
  ASSERT_TRUE(loaded.scene);
  Scene scene = *loaded.scene;
  scene.effects.set(Effect::kFriction, false);
  compare(scene);
}

TEST(LoopedRod, RubsItselfAsThreeRodsRub) {
  const LoadResult loaded = loop();
  ASSERT_TRUE(loaded.scene);
  compare(*loaded.scene);
}

/// What each part has of an effect it has as a part of the whole, too; not weight, which the bodies
/// between the parts have as well.
std::vector<std::pair<const char*, std::function<void(Scene&)>>> other_effects() {
  const auto listed = [](Effect effect) {
    return [effect](Scene& scene) { scene.effects.set(effect, true); };
  };
  return {{"extension", listed(Effect::kExtension)},
          {"shear", listed(Effect::kShear)},
          {"rotary inertia", listed(Effect::kRotaryInertia)},
          {"fluid", [](Scene& scene) {
             scene.effects.set(Effect::kDrag, true);
             scene.wind = {0.5, 0, 1};
             DragSpec water;
             water.normal = 0.5;
             water.fluid_density = 500;
             water.added_mass = 1;
             scene.rods[0].drag = water;
           }}};
}

TEST(LoopedRod, TouchesItselfWithOtherEffectsToo) {
  const LoadResult loaded = loop();
  ASSERT_TRUE(loaded.scene);
  for (const auto& [name, add] : other_effects()) {
    SCOPED_TRACE(name);
    Scene scene = *loaded.scene;
    scene.effects.set(Effect::kFriction, false);
    add(scene);
    compare(scene);
  }
}

// Without the effect it passes through itself, and costs nothing.
TEST(LoopedRod, PassesThroughItselfOtherwise) {
  const LoadResult loaded = loop();
  ASSERT_TRUE(loaded.scene);
  Scene scene = *loaded.scene;
  for (Effect effect : {Effect::kSelfContact, Effect::kFriction})
    scene.effects.set(effect, false);
  Simulation simulation(scene);
  simulation.start();
  while (simulation.status() == RunStatus::kRunning)
    simulation.advance();
  EXPECT_EQ(simulation.status(), RunStatus::kDone);
  EXPECT_EQ(simulation.now().contact.count, 0);
}

}  // namespace
}  // namespace cprsim
