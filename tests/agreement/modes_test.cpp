// SPDX-License-Identifier: BSD-3-Clause
// Small vibrations about an equilibrium of every method: what its field() tells the studies.
#include "engine/study/modes.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "engine/section/section.h"
#include "tests/support/methods.h"
#include "tests/support/tendons.h"

namespace cprsim {
namespace {

std::vector<double> frequencies(const Scene& scene) {
  StaticStudy study(scene);
  EXPECT_TRUE(study.solve().converged());
  std::vector<double> omegas;
  for (const VibrationMode& mode : natural_modes(study, 4))
    omegas.push_back(std::sqrt(mode.omega_squared));
  return omegas;
}

std::vector<double> all_frequencies(const Scene& scene) {
  StaticStudy study(finely(scene, Method::kShooting));
  EXPECT_TRUE(study.solve().converged());
  std::vector<double> omegas;
  for (const VibrationMode& mode : natural_modes(study, 40))
    omegas.push_back(std::sqrt(mode.omega_squared));
  return omegas;
}

double nearest(const std::vector<double>& all, double wanted) {
  double best = all.front();
  for (double omega : all)
    if (std::abs(omega - wanted) < std::abs(best - wanted)) best = omega;
  return best;
}

TEST(Modes, OfABentRodAreThoseOfEveryMethod) {
  Scene scene;
  scene.rods.push_back(steel_rod(0.4, 1e-3));
  switch_on(scene, {Effect::kGravity, Effect::kExtension});
  scene.gravity = {4, -5, -3};
  scene.rods[0].tip = scene.rods[0].base;
  scene.rods[0].tip.at = {kWorld, {exp_so3({0.5, 0.3, -0.4}), {0.12, -0.05, 0.33}}};
  add_load(scene, 0.3, {0.2, 0.5, -0.3});
  const std::vector<double> expected = frequencies(finely(scene, Method::kShooting));
  ASSERT_EQ(expected.size(), 4u);
  for (Method method : {Method::kStrain, Method::kCollocation}) {
    const std::vector<double> found = frequencies(finely(scene, method));
    ASSERT_EQ(found.size(), expected.size()) << method_name(method);
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_NEAR(found[k] / expected[k], 1, 2e-6) << method_name(method) << ", mode " << k;
  }
}

TEST(Modes, OfARodBentByTendonsAreThoseOfEveryMethod) {
  Scene scene;
  scene.rods.push_back(steel_rod(0.4, 1e-3));
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear});
  scene.gravity = {4, -5, -3};
  add_tendon(scene, 0.015, 0.4, 20, 0.7);
  add_tendon(scene, 0.01, 2, 30).termination = 0.6;
  const std::vector<double> expected = frequencies(finely(scene, Method::kShooting));
  ASSERT_EQ(expected.size(), 4u);
  for (Method method : {Method::kStrain, Method::kCollocation}) {
    const std::vector<double> found = frequencies(finely(scene, method));
    ASSERT_EQ(found.size(), expected.size()) << method_name(method);
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_NEAR(found[k] / expected[k], 1, 2e-6) << method_name(method) << ", mode " << k;
  }
}

// A tendon that is held is stiffer than one that is pulled, and every method says by how much.
TEST(Modes, OfARodHeldByTendonsAreThoseOfEveryMethod) {
  Scene scene;
  scene.rods.push_back(steel_rod(0.4, 1e-3));
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear});
  scene.gravity = {4, -5, -3};
  add_tendon(scene, 0.015, 0.4, 10, 0.2);
  const double pulled = frequencies(finely(scene, Method::kShooting))[0];
  displace(scene, 0.01);
  const std::vector<double> expected = frequencies(finely(scene, Method::kShooting));
  ASSERT_EQ(expected.size(), 4u);
  EXPECT_GT(expected[1], 1.5 * pulled);
  for (Method method : {Method::kStrain, Method::kCollocation}) {
    const std::vector<double> found = frequencies(finely(scene, method));
    ASSERT_EQ(found.size(), expected.size()) << method_name(method);
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_NEAR(found[k] / expected[k], 1, 2e-6) << method_name(method) << ", mode " << k;
  }
}

// Tendons all around press a straight rod as hard as they like: they follow it, so that it neither
// buckles nor bends more softly. Against twist their tension is a stiffness, sum T r^2 beside GJ.
TEST(Modes, OfARodPressedByTendonsAreStifferOnlyInTwist) {
  Scene scene;
  scene.rods.push_back(steel_rod(0.4, 1e-3));
  switch_on(scene, {Effect::kRotaryInertia});
  const double buckling = std::pow(std::numbers::pi / 0.8, 2) * bending_stiffness(scene.rods[0]);
  const std::vector<double> alone = all_frequencies(scene);
  const double GJ = section_properties(scene.rods[0]).K_bt.z(), T = 20 * buckling, r = 0.02;
  for (int k = 0; k < 4; ++k)
    add_tendon(scene, r, k * std::numbers::pi / 2, T);
  const std::vector<double> pressed = all_frequencies(scene);
  const double twist = std::numbers::pi / 0.8 * std::sqrt(80e9 / 8000),
               stiffer = twist * std::sqrt(1 + 4 * T * r * r / GJ);
  ASSERT_GT(stiffer, 1.2 * twist);
  EXPECT_NEAR(nearest(alone, twist) / twist, 1, 1e-6);
  EXPECT_NEAR(nearest(pressed, stiffer) / stiffer, 1, 1e-6);
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(pressed[static_cast<std::size_t>(k)] / alone[static_cast<std::size_t>(k)], 1, 1e-6);
}

}  // namespace
}  // namespace cprsim
