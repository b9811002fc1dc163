// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/elastica.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/reference_arc.h"

namespace cprsim {
namespace {

TEST(Elastica, IntegralsAgreeWithTheStandardLibrary) {
  for (double k : {0.0, 0.3, 0.7071, 0.95})
    for (double psi : {0.01, 0.5, 1.2, 1.5}) {
      const double s = std::sin(psi), c = std::cos(psi), kc2 = 1 - k * k;
      // the library's own error is 2e-12
      EXPECT_NEAR(elliptic_F(s, c, kc2), std::ellint_1(k, psi), 5e-12);
      EXPECT_NEAR(elliptic_E(s, c, kc2), std::ellint_2(k, psi), 5e-12);
    }
}

TEST(Elastica, TendsToTheLinearBeam) {
  // next terms are of relative order load²
  const double load = 1e-6;
  const Elastica tip = solve_elastica(load);
  EXPECT_NEAR(tip.x, load / 3, 1e-13);
  EXPECT_NEAR(tip.angle, load / 2, 1e-13);
  EXPECT_NEAR(tip.z, 1, 1e-12);
}

TEST(Elastica, GivesTheTableOfMattiasson) {
  // K. Mattiasson, Int. J. Numer. Meth. Eng. 17 (1981) 145-153, five digits: load, 1 - z, x, angle
  const double table[][4] = {{1, 0.05643, 0.30172, 0.46135},
                             {2, 0.16064, 0.49346, 0.78175},
                             {5, 0.38763, 0.71379, 1.21537},
                             {10, 0.55500, 0.81061, 1.43029}};
  for (const auto& [load, shortening, deflection, angle] : table) {
    const Elastica tip = solve_elastica(load);
    EXPECT_NEAR(1 - tip.z, shortening, 5.1e-6);
    EXPECT_NEAR(tip.x, deflection, 5.1e-6);
    EXPECT_NEAR(tip.angle, angle, 5.1e-6);
  }
}

TEST(Elastica, GivesFifteenDigits) {
  // evaluated with 40 digits: load, x, z, angle
  const double table[][4] = {
      {1e-3, 0.00033333329523810338, 0.99999993333334603, 0.0004999999541666756},
      {1, 0.30172077379981353, 0.94356676371662312, 0.46135194971187896},
      {40, 0.9073709152064205, 0.22360482703390341, 1.5648588871875423},
      {1000, 0.98147580634662821, 0.044721359549995794, 1.5707963267948354}};
  for (const auto& [load, x, z, angle] : table) {
    const Elastica tip = solve_elastica(load);
    EXPECT_NEAR(tip.x, x, 2e-15);
    EXPECT_NEAR(tip.z, z, 2e-15);
    EXPECT_NEAR(tip.angle, angle, 2e-15);
  }
}

TEST(Elastica, SolvesTheCosseratEquations) {
  // the force that the tip carries is the internal force everywhere; C_bt = 1/EI
  for (double load : {1e-3, 0.5, 3.0, 10.0, 40.0}) {
    const Elastica tip = solve_elastica(load);
    ReferenceSection base;
    base.n = Vec3(load, 0, 0);
    base.m = Vec3(0, tip.clamp_moment, 0);
    const ReferenceSection end = integrate_reference_arc(ReferenceRod{}, base);
    // an error of the root wrench grows with exp(α L) to the tip: 600 at load 40
    const double tolerance = 1e-14 * std::exp(std::sqrt(load));
    EXPECT_NEAR(end.X_WS.p.x(), tip.x, tolerance) << load;
    EXPECT_NEAR(end.X_WS.p.z(), tip.z, tolerance) << load;
    EXPECT_NEAR(std::atan2(end.X_WS.R(0, 2), end.X_WS.R(2, 2)), tip.angle, tolerance) << load;
    EXPECT_LT(end.m.norm(), tolerance * (1 + load)) << load;
  }
}

}  // namespace
}  // namespace cprsim
