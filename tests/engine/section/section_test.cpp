// SPDX-License-Identifier: BSD-3-Clause
#include "engine/section/section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cprsim {
namespace {

constexpr double kPi = std::numbers::pi;

struct Geometry {
  double area;
  Vec3 I;
};

Geometry geometry(SectionShape shape, double x, double y) {
  SectionSpec spec;
  spec.shape = shape;
  spec.size = {x, y};
  Geometry g{};
  section_geometry(spec, g.area, g.I);
  return g;
}

/// To round-off.
void expect_equal(double value, double expected) {
  EXPECT_NEAR(value, expected, 1e-15 * std::abs(expected));
}

TEST(Section, CircleHasItsTextbookMoments) {
  const Geometry g = geometry(SectionShape::kCircle, 0.002, 0);
  expect_equal(g.area, kPi * 4e-6);
  expect_equal(g.I.x(), kPi / 4 * 16e-12);
  expect_equal(g.I.y(), g.I.x());
  expect_equal(g.I.z(), 2 * g.I.x());
}

TEST(Section, AnnulusIsACircleWithoutACircle) {
  const Geometry whole = geometry(SectionShape::kCircle, 0.003, 0),
                 hole = geometry(SectionShape::kCircle, 0.002, 0),
                 ring = geometry(SectionShape::kAnnulus, 0.003, 0.002);
  EXPECT_NEAR(ring.area, whole.area - hole.area, 1e-20);
  EXPECT_LT((ring.I - (whole.I - hole.I)).norm(), 1e-25);  // round-off of 1e-10
  expect_equal(geometry(SectionShape::kAnnulus, 0.003, 0).I.z(), whole.I.z());
}

TEST(Section, RectangleHasItsTextbookMoments) {
  const Geometry g = geometry(SectionShape::kRectangle, 3, 2);
  expect_equal(g.area, 6);
  expect_equal(g.I.x(), 3. * 8 / 12);
  expect_equal(g.I.y(), 2. * 27 / 12);
}

// Timoshenko & Goodier, table of k_1 in art. 109: J = k_1 a b³, to the digits it gives.
TEST(Section, RectangleTorsionIsTheTabulatedOne) {
  const double table[][3] = {{1, 0.1406, 5e-5}, {1.2, 0.166, 5e-4}, {1.5, 0.196, 5e-4},
                             {2, 0.229, 5e-4},  {2.5, 0.249, 5e-4}, {3, 0.263, 5e-4},
                             {4, 0.281, 5e-4},  {5, 0.291, 5e-4},   {10, 0.312, 5e-4}};
  for (const auto& [ratio, k1, digits] : table) {
    const double b = 0.7, a = ratio * b;
    EXPECT_NEAR(geometry(SectionShape::kRectangle, a, b).I.z() / (a * b * b * b), k1, digits)
        << ratio;
    EXPECT_EQ(geometry(SectionShape::kRectangle, a, b).I.z(),
              geometry(SectionShape::kRectangle, b, a).I.z());
  }
  // the first to all digits: the series in 40 digits
  expect_equal(geometry(SectionShape::kRectangle, 1, 1).I.z(), 0.14057701495515372);
}

// J → a b³ (1/3 - 62 zeta(5) b / pi^5 a): the strip, less what its two ends take.
TEST(Section, ThinRectangleTwistsLikeAStrip) {
  const double ends = 62 * 1.0369277551433699 / std::pow(kPi, 5);
  for (double ratio : {20., 100., 1e4}) {
    const double J = geometry(SectionShape::kRectangle, ratio, 1).I.z();
    expect_equal(J, ratio * (1. / 3 - ends / ratio));
  }
}

TEST(Section, EllipseHasItsTextbookMomentsAndMeetsTheCircle) {
  const double a = 0.3, b = 0.2;
  const Geometry g = geometry(SectionShape::kEllipse, a, b);
  expect_equal(g.area, kPi * a * b);
  expect_equal(g.I.x(), kPi / 4 * a * b * b * b);
  expect_equal(g.I.y(), kPi / 4 * a * a * a * b);
  expect_equal(g.I.z(), kPi * a * a * a * b * b * b / (a * a + b * b));
  const Geometry round = geometry(SectionShape::kEllipse, a, a),
                 circle = geometry(SectionShape::kCircle, a, 0);
  expect_equal(round.I.z(), circle.I.z());
  expect_equal(round.I.x(), circle.I.x());
}

// Saint-Venant: no section is stiffer in torsion than its polar moment, only the circle as stiff.
TEST(Section, TorsionConstantIsBelowThePolarMoment) {
  for (SectionShape shape : {SectionShape::kRectangle, SectionShape::kEllipse})
    for (double ratio : {1.01, 2., 7.}) {
      const Geometry g = geometry(shape, ratio, 1);
      EXPECT_LT(g.I.z(), g.I.x() + g.I.y());
    }
}

RodSpec steel_rod() {
  RodSpec rod;
  rod.section.shape = SectionShape::kEllipse;
  rod.section.size = {0.003, 0.002};
  rod.material = MaterialSpec{7800, 200e9, 77e9, {}};
  return rod;
}

TEST(Section, StiffnessAndMassFollowFromShapeAndMaterial) {
  const RodSpec rod = steel_rod();
  const SectionProperties s = section_properties(rod);
  const Geometry g = geometry(SectionShape::kEllipse, 0.003, 0.002);
  expect_equal(s.K_bt.x(), 200e9 * g.I.x());
  expect_equal(s.K_bt.y(), 200e9 * g.I.y());
  expect_equal(s.K_bt.z(), 77e9 * g.I.z());
  expect_equal(s.K_se.x(), 77e9 * g.area);
  expect_equal(s.K_se.z(), 200e9 * g.area);
  expect_equal(s.rhoA, 7800 * g.area);
  // inertia against turning is polar; the torsion constant is not
  expect_equal(s.rhoJ.z(), 7800 * (g.I.x() + g.I.y()));
  expect_equal(s.half_width, 0.003);
}

TEST(Section, DirectStiffnessReplacesOnlyWhatItNames) {
  RodSpec rod = steel_rod();
  const SectionProperties before = section_properties(rod);
  rod.stiffness.bending_y = 3.5;
  rod.stiffness.axial = 120;
  const SectionProperties s = section_properties(rod);
  EXPECT_EQ(s.K_bt, Vec3(before.K_bt.x(), 3.5, before.K_bt.z()));
  EXPECT_EQ(s.K_se, Vec3(before.K_se.x(), before.K_se.y(), 120));
  EXPECT_EQ(s.rhoA, before.rhoA);
  rod.material.reset();
  EXPECT_EQ(section_properties(rod).K_bt, Vec3(0, 3.5, 0));
  EXPECT_EQ(section_properties(rod).rhoA, 0);
}

TEST(Section, DampingGoesToItsAxes) {
  RodSpec rod = steel_rod();
  EXPECT_EQ(section_properties(rod).B_bt, Vec3(0, 0, 0));
  rod.damping = DampingSpec{1, 2, 3, 4, {}};
  EXPECT_EQ(section_properties(rod).B_bt, Vec3(1, 1, 2));
  EXPECT_EQ(section_properties(rod).B_se, Vec3(4, 4, 3));
}

}  // namespace
}  // namespace cprsim
