// SPDX-License-Identifier: BSD-3-Clause
// Every law of a force by the place, against differences.
#include "engine/section/place_laws.h"

#include <gtest/gtest.h>

#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

/// A law in the middle of a rod, with values that fit any: 3.7, 2.9, ...; places and directions.
PlacedForce placed(int law) {
  PlacedForce force;
  force.law = law;
  force.strength = 1.3;
  double* x = force.values;
  for (const LawValue& value : kPlaceLaws[law].values) {
    if (!value.word) break;
    if (value.kind == LawValue::kPositive)
      *x = 3.7;
    else if (value.kind == LawValue::kPlace)
      Eigen::Map<Vec3>{x} = Vec3(0.2, -0.1, 0.4);
    else
      Eigen::Map<Vec3>{x} = Vec3(0.36, 0.48, -0.8);
    x += value.size();
  }
  return force;
}

PlaceForce at(const PlacedForce& force, double inside, const Vec3& p) {
  return placed_forces(&force, 1, inside, load(p.data()));
}

TEST(PlaceLaws, HaveTangentsThatAreExactAndSymmetric) {
  for (int law = 0; law < static_cast<int>(std::size(kPlaceLaws)); ++law) {
    SCOPED_TRACE(kPlaceLaws[law].word);
    const PlacedForce force = placed(law);
    const Vec3 p(-0.5, 0.7, -0.3);
    const MatX difference = difference_jacobian(
        [&](const Vec3& x) -> Vec3 {
          const V3 f = at(force, 0.5, x).f;
          return {f.x, f.y, f.z};
        },
        p, 3, [](const Vec3& x, const VecX& d) -> Vec3 { return x + d; },
        [](const Vec3& a, const Vec3& b) -> VecX { return a - b; });
    const PlaceForce here = at(force, 0.5, p);
    const Mat3 exact = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(here.f_p.a);
    EXPECT_GT(exact.norm(), 0);
    EXPECT_LT((exact - difference).norm(), 1e-9 * exact.norm());
    EXPECT_LT((exact - exact.transpose()).norm(), 1e-15 * exact.norm());
  }
}

TEST(PlaceLaws, ActOnTheirPartOfTheRod) {
  PlacedForce force = placed(0);
  force.from = 0.25;
  force.to = 0.5;
  const Vec3 p(-0.5, 0.7, -0.3);
  EXPECT_EQ(at(force, 0.2, p).f.x, 0);
  EXPECT_NE(at(force, 0.3, p).f.x, 0);
  EXPECT_EQ(at(force, 0.6, p).f.x, 0);
}

}  // namespace
}  // namespace cprsim
