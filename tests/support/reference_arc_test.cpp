// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/reference_arc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cprsim {
namespace {

constexpr double kPi = std::numbers::pi;
// global error of CVODE at its tightest tolerance
constexpr double kClose = 1e-13;

TEST(ReferenceArc, EndMomentMakesAFullCircle) {
  ReferenceRod rod;
  rod.length = 0.7;
  rod.C_bt = Vec3(1 / 3.0, 1 / 2.0, 1).asDiagonal();
  ReferenceSection base;
  base.m = Vec3(0, 2.0 * 2 * kPi / rod.length, 0);
  const ReferenceSection half = integrate_reference_arc(rod, base, 0.5);
  const ReferenceSection full = integrate_reference_arc(rod, base);
  EXPECT_NEAR((half.X_WS.p - Vec3(rod.length / kPi, 0, 0)).norm(), 0, kClose);
  EXPECT_NEAR(full.X_WS.p.norm(), 0, kClose);
  EXPECT_NEAR((full.X_WS.R - Mat3::Identity()).norm(), 0, 5 * kClose);
  EXPECT_NEAR((full.m - base.m).norm(), 0, kClose);
}

TEST(ReferenceArc, ConstantStrainsMakeAHelix) {
  // isotropic section, u_ref constant and no load: R(s) = exp(s û), axis along u
  ReferenceRod rod;
  rod.length = 1.3;
  rod.u_ref = Vec3(2, -3, 5);
  const double turn = rod.u_ref.norm();
  const Vec3 axis = rod.u_ref / turn;
  const ReferenceSection end = integrate_reference_arc(rod, {});
  const double a = turn * rod.length;
  const Vec3 z = Vec3::UnitZ();
  // ∫ exp(s û) z ds
  const Vec3 p = rod.length * axis * axis.dot(z) + std::sin(a) / turn * (z - axis * axis.dot(z)) +
                 (1 - std::cos(a)) / turn * axis.cross(z);
  EXPECT_NEAR((end.X_WS.p - p).norm(), 0, kClose);
  EXPECT_NEAR((end.X_WS.R - Eigen::AngleAxisd(a, axis).toRotationMatrix()).norm(), 0, 5 * kClose);
}

TEST(ReferenceArc, BalancesForcesAndMoments) {
  ReferenceRod rod;
  rod.C_bt = Vec3(0.5, 0.5, 0.7).asDiagonal();
  rod.C_se = Vec3(1e-2, 2e-2, 1e-3).asDiagonal();
  rod.f = Vec3(0.3, -0.2, 1.1);
  rod.l = Vec3(0.1, 0.4, -0.3);
  ReferenceSection base;
  base.X_WS.p = Vec3(1, 2, 3);
  base.X_WS.R = Eigen::AngleAxisd(0.8, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  base.n = Vec3(1, -2, 0.5);
  base.m = Vec3(0.2, 0.3, 2);
  const ReferenceSection end = integrate_reference_arc(rod, base);
  EXPECT_NEAR((end.n - (base.n - rod.f * rod.length)).norm(), 0, kClose);
  // moment of f about the base, by Simpson's rule on the integrated centreline
  const int panels = 64;
  Vec3 moment = Vec3::Zero();
  for (int i = 0; i <= 2 * panels; ++i) {
    const double weight = (i == 0 || i == 2 * panels ? 1 : i % 2 == 1 ? 4 : 2) / (6.0 * panels);
    const Vec3 arm = integrate_reference_arc(rod, base, i / (2.0 * panels)).X_WS.p - base.X_WS.p;
    moment += weight * rod.length * arm.cross(rod.f);
  }
  const Vec3 sum =
      end.m + (end.X_WS.p - base.X_WS.p).cross(end.n) + moment + rod.l * rod.length - base.m;
  EXPECT_NEAR(sum.norm(), 0, 1e-9);  // Simpson's error
}

TEST(ReferenceArc, TensionStretchesAndShearSlides) {
  ReferenceRod rod;
  rod.length = 2;
  rod.C_bt.setZero();
  rod.C_se = Vec3(0.1, 0.2, 0.01).asDiagonal();
  ReferenceSection base;
  base.n = Vec3(1, 2, 3);
  const ReferenceSection end = integrate_reference_arc(rod, base);
  EXPECT_NEAR((end.X_WS.p - Vec3(0.2, 0.8, 2.06)).norm(), 0, kClose);
  EXPECT_NEAR((end.X_WS.R - Mat3::Identity()).norm(), 0, 1e-15);
}

}  // namespace
}  // namespace cprsim
