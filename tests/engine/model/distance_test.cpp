// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

ShapeSpec shape(ShapeKind kind, const Vec3& size) {
  ShapeSpec spec;
  spec.kind = kind;
  spec.size = size;
  spec.normal = Vec3(0.2, -0.3, 0.9).normalized();
  return spec;
}

const ShapeSpec kShapes[] = {
    shape(ShapeKind::kBox, {0.4, 0.6, 0.9}),        shape(ShapeKind::kSphere, {0.5, 0, 0}),
    shape(ShapeKind::kCapsule, {0.3, 0.8, 0}),      shape(ShapeKind::kCylinder, {0.4, 0.7, 0}),
    shape(ShapeKind::kCone, {0.5, 0.8, 0}),         shape(ShapeKind::kPlane, {1, 1, 0}),
    shape(ShapeKind::kEllipsoid, {0.7, 0.3, 0.45}), shape(ShapeKind::kEllipsoid, {0.4, 0.4, 0.8}),
    shape(ShapeKind::kTube, {1.2, 2.5, 0.8}),
};

class OutsidePoint {
 public:
  Vec3 next(const ShapeSpec& of) {
    while (true) {
      const Vec3 x(draw(), draw(), draw());
      if (distance_to(of, x).d > 0.05) return x;
    }
  }

 private:
  double draw() { return 3.0 * static_cast<double>(engine_()) / 4294967295.0 - 1.5; }

  std::mt19937 engine_{7};
};

TEST(Distance, ItsDerivativesAreThoseOfDifferences) {
  OutsidePoint points;
  for (const ShapeSpec& of : kShapes)
    for (int i = 0; i < 40; ++i) {
      const VecX x = points.next(of);
      const Distance at = distance_to(of, Vec3(x));
      const auto value = [&](const VecX& y) -> VecX {
        return VecX::Constant(1, distance_to(of, Vec3(y)).d);
      };
      const auto normal = [&](const VecX& y) -> VecX { return distance_to(of, Vec3(y)).n; };
      // away from where two features meet: there H jumps
      const MatX H = difference_jacobian(normal, x, 1e-5);
      if ((H - difference_jacobian(normal, x, 1e-3)).norm() > 1e-6) continue;
      EXPECT_TRUE(jacobians_agree(at.n.transpose(), difference_jacobian(value, x, 1e-5), 1e-8));
      EXPECT_LT((at.H - H).norm(), 1e-7) << static_cast<int>(of.kind) << " at " << x.transpose();
    }
}

// The point reached by going back along the normal lies on the surface, and nothing of the solid
// is nearer.
TEST(Distance, LeadsToTheSurface) {
  OutsidePoint points;
  for (const ShapeSpec& of : kShapes)
    for (int i = 0; i < 100; ++i) {
      const Vec3 x = points.next(of);
      const Distance at = distance_to(of, x);
      const Vec3 y = x - at.d * at.n;
      EXPECT_NEAR(distance_to(of, y).d, 0, 1e-12);
      EXPECT_NEAR(at.n.norm(), 1, 1e-14);
      // a distance never falls faster than one walks
      const Vec3 z = points.next(of);
      EXPECT_LE(std::abs(at.d - distance_to(of, z).d), (x - z).norm() + 1e-12);
    }
}

TEST(Distance, KnowsInsideFromOutside) {
  EXPECT_NEAR(distance_to(kShapes[0], Vec3(0.15, 0, 0)).d, -0.05, 1e-15);
  EXPECT_NEAR(distance_to(kShapes[1], Vec3(0.1, 0, 0)).d, -0.4, 1e-15);
  EXPECT_NEAR(distance_to(kShapes[3], Vec3(0, 0.1, 0.3)).d, -0.05, 1e-15);
  EXPECT_NEAR(distance_to(kShapes[4], Vec3(0, 0, -0.39)).d, -0.01, 1e-15);
  EXPECT_NEAR(distance_to(kShapes[4], Vec3(0, 0, 0.5)).d, 0.1, 1e-15);  // above the apex
  const ShapeSpec& tube = kShapes[8];
  EXPECT_NEAR(distance_to(tube, Vec3(0, -0.3, 0.9)).d, 0.5, 1e-15);  // in the hole
  EXPECT_NEAR(distance_to(tube, Vec3(0, -0.3, 0.9)).n.y(), 1, 1e-15);
  EXPECT_NEAR(distance_to(tube, Vec3(0.9, 0, 0)).d, -0.1, 1e-15);
  EXPECT_NEAR(distance_to(tube, Vec3(0, 0, 2)).d, std::hypot(0.8, 0.75), 1e-15);
}

// On and off the planes of symmetry, in and out, near and far: the nearest of many points of the
// surface is no nearer, and the one found is on the surface.
TEST(Distance, OfAnEllipsoidIsThatOfItsNearestPoint) {
  const Vec3 axes(0.7, 0.3, 0.45);
  const ShapeSpec of = shape(ShapeKind::kEllipsoid, axes);
  std::vector<Vec3> surface;
  constexpr int kMany = 400;
  for (int i = 0; i <= kMany; ++i)
    for (int j = 0; j < 2 * kMany; ++j) {
      const double polar = std::acos(-1.0) * i / kMany, round = std::acos(-1.0) * j / kMany;
      surface.emplace_back(axes.cwiseProduct(Vec3(
          std::sin(polar) * std::cos(round), std::sin(polar) * std::sin(round), std::cos(polar))));
    }
  const Vec3 places[] = {
      {0, 0, 0},         {0.1, 0, 0},      {0, 0, 0.2},      {0, 0.1, 0},
      {0.69, 0, 0},      {0.5, 0, 0.1},    {0.3, 1e-9, 0.2}, {0.9, 0, 0},
      {0, -0.9, 0},      {0.3, 0.31, 0},   {3, -2, 1},       {1e3, 1, 0},
      {0.5, 0.2, -0.05}, {-0.1, 0.2, 0.1}, {0, 0.3, 0},      {1e-12, 0.31, 1e-12}};
  for (const Vec3& x : places) {
    double nearest = 1e9;
    for (const Vec3& y : surface)
      nearest = std::min(nearest, (x - y).norm());
    const Distance at = distance_to(of, x);
    const Vec3 y = x - at.d * at.n;
    const double level = x.cwiseQuotient(axes).squaredNorm() - 1;
    EXPECT_NEAR(y.cwiseQuotient(axes).squaredNorm(), 1, 1e-11) << x.transpose();
    EXPECT_NEAR(std::abs(at.d), nearest, 4e-3) << x.transpose();
    EXPECT_LE(std::abs(at.d), nearest + 1e-12) << x.transpose();
    EXPECT_TRUE(level == 0 || level * at.d >= 0) << x.transpose();
  }
}

TEST(Distance, OfARoundEllipsoidIsThatOfASphere) {
  const ShapeSpec round = shape(ShapeKind::kEllipsoid, {0.5, 0.5, 0.5});
  OutsidePoint points;
  for (int i = 0; i < 100; ++i) {
    const Vec3 x = points.next(round);
    const Distance a = distance_to(round, x), b = distance_to(kShapes[1], x);
    EXPECT_NEAR(a.d, b.d, 1e-14);
    EXPECT_LT((a.n - b.n).norm(), 1e-14);
    EXPECT_LT((a.H - b.H).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace cprsim
