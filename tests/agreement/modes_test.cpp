// SPDX-License-Identifier: BSD-3-Clause
// Small vibrations about an equilibrium of every method: what its field() tells the studies.
#include "engine/study/modes.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"

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

}  // namespace
}  // namespace cprsim
