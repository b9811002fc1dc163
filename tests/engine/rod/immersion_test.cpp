// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/immersion.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"

namespace cprsim {
namespace {

// The slope of the energy's slope, by differences alone: in exponential coordinates it is
// symmetric.
TEST(Immersion, MagneticStiffnessIsTheSecondDerivativeOfTheEnergy) {
  Immersion around(1);
  around.place({0.5}, {{0, 1, {0.5, -0.2, 0.8}}});
  RodForcing forcing;
  forcing.field.uniform = {0.3, -0.1, 0.2};
  forcing.field.dipoles = {{{0.1, 0.2, 0.3}, {2e6, -1e6, 3e6}}};
  around.prepare({}, {}, StageRates{}, forcing, Track{});
  const MagneticField field = view_of(forcing.field);
  const Mat3 R = exp_so3({0.3, -0.7, 1.1});
  const Vec3 p(0.3, -0.2, 0.5);
  const auto energy = [&](const Vec6& x) {
    return around.magnetic_energy(0, exp_so3(x.head<3>()) * R, p + x.tail<3>(), field);
  };
  constexpr double kStep = 1e-3;
  Mat6 differences;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const Vec6 a = kStep * Vec6::Unit(i), b = kStep * Vec6::Unit(j);
      differences(i, j) =
          (energy(a + b) - energy(a - b) - energy(b - a) + energy(-a - b)) / (4 * kStep * kStep);
    }
  const Mat6 K = around.outer_stiffness(0.5, R, p);
  EXPECT_GT(K.topRightCorner(3, 3).norm(), 0.01 * K.norm());
  EXPECT_LT((K - differences).norm(), 1e-3 * K.norm());
  EXPECT_LT((K - K.transpose()).norm(), 1e-14 * K.norm());
}

}  // namespace
}  // namespace cprsim
