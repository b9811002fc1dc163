// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/mesh_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/support/box_mesh.h"
#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

/// A torus about z, hollow on its inner side; sizes that single precision has exactly.
MeshSpec torus(double R, double r, unsigned around, unsigned across) {
  MeshSpec mesh;
  const double turn = 2 * std::acos(-1.0);
  for (unsigned i = 0; i < around; ++i)
    for (unsigned j = 0; j < across; ++j) {
      const double a = turn * i / around, b = turn * j / across, rho = R + r * std::cos(b);
      mesh.positions.emplace_back(
          Vec3(rho * std::cos(a), rho * std::sin(a), r * std::sin(b)).cast<float>());
      const auto at = [&](unsigned k, unsigned l) { return (k % around) * across + l % across; };
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

class Points {
 public:
  Vec3 next() { return {draw(), draw(), draw()}; }

 private:
  double draw() { return 3.0 * static_cast<double>(engine_()) / 4294967295.0 - 1.5; }

  std::mt19937 engine_{7};
};

/// Without a tree: the nearest of all triangles, each by projection on what is nearest of it.
double brute_force(const MeshSpec& mesh, const Vec3& x) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles) {
    Vec3 p[3];
    for (std::size_t i = 0; i < 3; ++i)
      p[i] = mesh.positions[t[i]].cast<double>();
    Eigen::Matrix<double, 3, 2> sides;
    sides << p[1] - p[0], p[2] - p[0];
    const Vec2 at = sides.colPivHouseholderQr().solve(x - p[0]);
    if (at.minCoeff() >= 0 && at.sum() <= 1) best = std::min(best, (x - p[0] - sides * at).norm());
    for (int i = 0; i < 3; ++i) {
      const Vec3 side = p[(i + 1) % 3] - p[i];
      const double along = std::clamp(side.dot(x - p[i]) / side.squaredNorm(), 0.0, 1.0);
      best = std::min(best, (x - p[i] - along * side).norm());
    }
  }
  return best;
}

TEST(MeshDistance, OfABoxIsThatOfTheShape) {
  const Vec3 size(0.5, 0.75, 1.25);
  const MeshDistance mesh(box_mesh(size));
  ShapeSpec shape;
  shape.kind = ShapeKind::kBox;
  shape.size = size;
  EXPECT_TRUE(mesh.closed());
  Points points;
  const auto compare = [&](const Vec3& x, bool curvature) {
    const Distance a = mesh(x), b = distance_to(shape, x);
    EXPECT_NEAR(a.d, b.d, 1e-15) << x.transpose();
    EXPECT_LT((a.n - b.n).norm(), 1e-13) << x.transpose();
    if (curvature) {
      EXPECT_LT((a.H - b.H).norm(), 1e-12 / std::abs(b.d)) << x.transpose();
    }
  };
  for (int i = 0; i < 2000; ++i)
    compare(points.next(), true);
  // on the diagonals of the sides, where two triangles meet that are one face
  for (int i = 1; i < 20; ++i) {
    const double at = 0.05 * i - 0.5;
    for (const double other : {at, -at}) {
      compare({0.3, at * size.y(), other * size.z()}, true);
      compare({at * size.x(), -0.4, other * size.z()}, true);
      compare({at * size.x(), other * size.y(), 0.7}, true);
    }
  }
}

TEST(MeshDistance, IsThatOfAllTriangles) {
  const MeshSpec ring = torus(0.75, 0.25, 40, 24);
  const MeshDistance mesh(ring);
  EXPECT_TRUE(mesh.closed());
  Points points;
  for (int i = 0; i < 300; ++i) {
    const Vec3 x = points.next();
    const Distance at = mesh(x);
    EXPECT_NEAR(std::abs(at.d), brute_force(ring, x), 1e-13);
    EXPECT_NEAR(at.n.norm(), 1, 1e-14);
    const double exact = std::hypot(std::hypot(x.x(), x.y()) - 0.75, x.z()) - 0.25;
    EXPECT_NEAR(at.d, exact, 0.01);
    if (std::abs(exact) > 0.01) {
      EXPECT_EQ(at.d > 0, exact > 0);
    }
  }
}

TEST(MeshDistance, ItsDerivativesAreThoseOfDifferences) {
  const MeshDistance mesh(torus(0.75, 0.25, 20, 12));
  Points points;
  int compared = 0;
  for (int i = 0; i < 400; ++i) {
    const VecX x = points.next();
    const Distance at = mesh(Vec3(x));
    if (at.d < 0.05) continue;
    const auto value = [&](const VecX& y) -> VecX { return VecX::Constant(1, mesh(Vec3(y)).d); };
    const auto normal = [&](const VecX& y) -> VecX { return mesh(Vec3(y)).n; };
    const MatX H = difference_jacobian(normal, x, 1e-5);
    // where two features meet H jumps
    if ((H - difference_jacobian(normal, x, 1e-4)).norm() > 1e-6) continue;
    ++compared;
    EXPECT_TRUE(jacobians_agree(at.n.transpose(), difference_jacobian(value, x, 1e-5), 1e-8));
    EXPECT_LT((at.H - H).norm(), 1e-7) << x.transpose();
  }
  EXPECT_GT(compared, 100);
}

TEST(MeshDistance, OfASheetHasTwoSides) {
  MeshSpec sheet;
  for (const Vec3& p : {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)})
    sheet.positions.emplace_back(p.cast<float>());
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const MeshDistance mesh(sheet);
  EXPECT_FALSE(mesh.closed());
  for (const double side : {-1.0, 1.0}) {
    const Distance over = mesh({0.25, 0.5, 0.125 * side}), beside = mesh({1.5, 0.5, 0});
    EXPECT_EQ(over.d, 0.125);
    EXPECT_EQ(over.n, Vec3(0, 0, side));
    EXPECT_EQ(over.H, Mat3::Zero());
    EXPECT_EQ(beside.d, 0.5);
    EXPECT_EQ(beside.n, Vec3::UnitX());
    // round the border it bends, along it not
    EXPECT_LT((beside.H - Mat3(Vec3(0, 0, 2).asDiagonal())).norm(), 1e-14);
  }
}

// Triangles that are wound the other way enclose the same solid.
TEST(MeshDistance, KnowsASolidThatIsInsideOut) {
  MeshSpec turned = box_mesh({0.5, 0.75, 1.25});
  for (auto& t : turned.triangles)
    std::swap(t[0], t[1]);
  const MeshDistance mesh(box_mesh({0.5, 0.75, 1.25})), other(turned);
  Points points;
  for (int i = 0; i < 200; ++i) {
    const Vec3 x = points.next();
    EXPECT_NEAR(mesh(x).d, other(x).d, 1e-15);
    EXPECT_LT((mesh(x).n - other(x).n).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace cprsim
