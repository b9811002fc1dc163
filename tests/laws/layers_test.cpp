// SPDX-License-Identifier: BSD-3-Clause
// Rods of several materials around each other.
#include <gtest/gtest.h>

#include "engine/section/section.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"
#include "tests/support/tendons.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.3;

LayerSpec layer(double inner, double outer, double density, double E, double G) {
  LayerSpec out;
  out.section.shape = SectionShape::kAnnulus;
  out.section.size = {outer, inner};
  out.material.density = density;
  out.material.youngs_modulus = E;
  out.material.shear_modulus = G;
  return out;
}

// A coated wire: the core's and the coat's parts, by the formulas of circles.
TEST(LayeredSection, AddsUpWhatItIsMadeOf) {
  RodSpec rod = steel_rod(kLength, 1e-3);
  rod.layers = {layer(1e-3, 2e-3, 1100, 3e9, 1e9)};
  const SectionProperties s = section_properties(rod);
  constexpr double kPi = std::numbers::pi, kCore = kPi / 4 * 1e-12, kCoat = kPi / 4 * 15e-12;
  EXPECT_NEAR(s.K_bt.x(), 200e9 * kCore + 3e9 * kCoat, 1e-14 * s.K_bt.x());
  EXPECT_EQ(s.K_bt.y(), s.K_bt.x());
  EXPECT_NEAR(s.K_bt.z(), 2 * (80e9 * kCore + 1e9 * kCoat), 1e-14 * s.K_bt.z());
  EXPECT_NEAR(s.K_se.z(), kPi * (200e9 * 1e-6 + 3e9 * 3e-6), 1e-14 * s.K_se.z());
  EXPECT_NEAR(s.K_se.x(), kPi * (80e9 * 1e-6 + 1e9 * 3e-6), 1e-14 * s.K_se.x());
  EXPECT_NEAR(s.rhoA, kPi * (8000 * 1e-6 + 1100 * 3e-6), 1e-15 * s.rhoA);
  EXPECT_NEAR(s.rhoJ.x(), 8000 * kCore + 1100 * kCoat, 1e-14 * s.rhoJ.x());
  EXPECT_NEAR(s.rhoJ.z(), 2 * s.rhoJ.x(), 1e-15 * s.rhoJ.z());
  EXPECT_NEAR(s.area, kPi * 4e-6, 1e-15 * s.area);
  EXPECT_EQ(s.half_width, 2e-3);
}

// Cut into a core and shells of one material, a rod is what it was.
TEST(LayeredSection, OfOneMaterialIsTheWholeRod) {
  RodSpec whole = steel_rod(kLength, 3e-3), cut = steel_rod(kLength, 1e-3);
  cut.layers = {layer(1e-3, 2e-3, 8000, 200e9, 80e9), layer(2e-3, 3e-3, 8000, 200e9, 80e9)};
  const SectionProperties a = section_properties(whole), b = section_properties(cut);
  EXPECT_LT((a.K_bt - b.K_bt).norm(), 1e-14 * a.K_bt.norm());
  EXPECT_LT((a.K_se - b.K_se).norm(), 1e-14 * a.K_se.norm());
  EXPECT_LT((a.rhoJ - b.rhoJ).norm(), 1e-14 * a.rhoJ.norm());
  EXPECT_NEAR(a.rhoA, b.rhoA, 1e-14 * a.rhoA);
  EXPECT_EQ(a.half_width, b.half_width);
}

class LayeredRod : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, LayeredRod, ::testing::ValuesIn(kEveryMethod), test_name);

TEST_P(LayeredRod, BendsAsItsSumOfStiffnesses) {
  Scene layered;
  switch_on(layered, {Effect::kGravity, Effect::kExtension, Effect::kShear});
  layered.gravity = {3, 0, -9};
  RodSpec rod = steel_rod(kLength, 1e-3);
  rod.layers = {layer(1e-3, 2e-3, 1100, 3e9, 1e9)};
  layered.rods = {rod};
  add_load(layered, 1, {0.5, 0.2, 0});
  Scene direct = layered;
  const SectionProperties sum = section_properties(rod);
  RodSpec& other = direct.rods[0];
  other.layers.clear();
  other.material->density = sum.rhoA / section_properties(steel_rod(kLength, 1e-3)).area;
  other.stiffness = {
      sum.K_bt.x(), sum.K_bt.y(), sum.K_bt.z(), sum.K_se.z(), sum.K_se.x(), sum.K_se.y(), {}};
  const Equilibrium a(finely(layered, GetParam())), b(finely(direct, GetParam()));
  ASSERT_TRUE(a.report.converged() && b.report.converged());
  EXPECT_GT(a.rod().points.back().position.x(), 0.01);
  EXPECT_LT((a.rod().points.back().position - b.rod().points.back().position).norm(), 1e-13);
}

// Varying cores are coated, too: the coat's part is the same all along.
TEST(LayeredSection, VariesWithItsCore) {
  RodSpec rod = steel_rod(kLength, 1e-3);
  rod.sections.assign(2, rod.section);
  rod.sections[1].s = 1;
  rod.sections[1].size = {0.5e-3, 0};
  rod.layers = {layer(1e-3, 2e-3, 1100, 3e9, 1e9)};
  const SectionsAlong along(rod, false);
  RodSpec bare = rod;
  bare.layers.clear();
  const SectionsAlong core(bare, false);
  const double coat = along.at(0, 0).K_bt.x() - core.at(0, 0).K_bt.x();
  EXPECT_NEAR(coat, 3e9 * std::numbers::pi / 4 * 15e-12, 1e-13 * coat);
  EXPECT_NEAR(along.at(0.7, 0.7).K_bt.x() - core.at(0.7, 0.7).K_bt.x(), coat, 1e-12 * coat);
}

// Bonded, both grow by what makes their forces cancel; a gradient likewise, by stiffness in
// bending.
TEST(LayeredSection, ExpandsByTheAverageOfItsStiffnesses) {
  RodSpec rod = steel_rod(kLength, 1e-3);
  rod.material->thermal_expansion = 12e-6;
  EXPECT_EQ(thermal_expansion(rod).axial, 12e-6);
  EXPECT_EQ(thermal_expansion(rod).bending, 12e-6);
  rod.layers = {layer(1e-3, 2e-3, 1100, 3e9, 1e9)};
  rod.layers[0].material.thermal_expansion = 80e-6;
  const double steel = 200e9, coat = 3e9 * 3;  // E A / (pi mm2); E I / (pi / 4 mm4) is 5 coats
  EXPECT_NEAR(thermal_expansion(rod).axial, (steel * 12e-6 + coat * 80e-6) / (steel + coat), 1e-18);
  EXPECT_NEAR(thermal_expansion(rod).bending,
              (steel * 12e-6 + 5 * coat * 80e-6) / (steel + 5 * coat), 1e-18);
}

}  // namespace
}  // namespace cprsim
