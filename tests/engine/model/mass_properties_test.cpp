// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/mass_properties.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "engine/math/legendre.h"
#include "engine/math/so3.h"
#include "tests/support/box_mesh.h"

namespace cprsim {
namespace {

constexpr double kDensity = 2700;

/// What a solid of revolution of radius a(z) has, from thin discs: a witness for the closed forms.
MassProperties of_discs(const std::function<double(double)>& a, const std::vector<double>& pieces) {
  const GaussRule rule = gauss_rule(24);
  double m = 0, mz = 0, across = 0, along = 0;
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i)
    for (Eigen::Index k = 0; k < rule.points.size(); ++k) {
      const double h = pieces[i + 1] - pieces[i], z = pieces[i] + h * rule.points[k];
      const double r = a(z), dm = kDensity * std::numbers::pi * r * r * h * rule.weights[k];
      m += dm;
      mz += dm * z;
      along += dm * r * r / 2;
      across += dm * (r * r / 4 + z * z);
    }
  MassProperties found;
  found.mass = m;
  found.com = Vec3(0, 0, mz / m);
  across -= mz * mz / m;
  found.inertia = Vec3(across, across, along).asDiagonal();
  return found;
}

void expect_same(const MassProperties& a, const MassProperties& b, double tolerance) {
  EXPECT_NEAR(a.mass, b.mass, tolerance * b.mass);
  const double size = std::sqrt(b.inertia.norm() / b.mass);
  EXPECT_LT((a.com - b.com).norm(), tolerance * size);
  EXPECT_LT((a.inertia - b.inertia).norm(), tolerance * b.inertia.norm());
}

ShapeSpec solid_of(ShapeKind kind, const Vec3& size) {
  ShapeSpec spec;
  spec.kind = kind;
  spec.size = size;
  return spec;
}

TEST(MassProperties, SolidsOfRevolutionAreTheSumOfTheirDiscs) {
  const double r = 0.03, l = 0.2;
  expect_same(mass_properties(solid_of(ShapeKind::kCylinder, {r, l, 0}), {}, kDensity),
              of_discs([&](double) { return r; }, {-l / 2, l / 2}), 1e-12);
  const MassProperties whole =
                           mass_properties(solid_of(ShapeKind::kCylinder, {r, l, 0}), {}, kDensity),
                       hole = mass_properties(solid_of(ShapeKind::kCylinder, {r / 3, l, 0}), {},
                                              kDensity),
                       tube =
                           mass_properties(solid_of(ShapeKind::kTube, {r, l, r / 3}), {}, kDensity);
  EXPECT_NEAR(tube.mass, whole.mass - hole.mass, 1e-12 * whole.mass);
  EXPECT_LT((tube.inertia - whole.inertia + hole.inertia).norm(), 1e-12 * whole.inertia.norm());
  expect_same(mass_properties(solid_of(ShapeKind::kCone, {r, l, 0}), {}, kDensity),
              of_discs([&](double z) { return r * (0.5 - z / l); }, {-l / 2, l / 2}), 1e-12);
  const auto ball = [](double radius, double z) {
    return std::sqrt(std::max(0.0, radius * radius - z * z));
  };
  expect_same(mass_properties(solid_of(ShapeKind::kSphere, {r, 0, 0}), {}, kDensity),
              of_discs([&](double z) { return ball(r, z); }, {-r, r}), 1e-12);
  expect_same(mass_properties(solid_of(ShapeKind::kEllipsoid, {r, r, l}), {}, kDensity),
              of_discs([&](double z) { return r / l * ball(l, z); }, {-l, l}), 1e-12);
  expect_same(mass_properties(solid_of(ShapeKind::kCapsule, {r, l, 0}), {}, kDensity),
              of_discs(
                  [&](double z) {
                    const double beyond = std::abs(z) - l / 2;
                    return beyond > 0 ? ball(r, beyond) : r;
                  },
                  {-l / 2 - r, -l / 2, l / 2, l / 2 + r}),
              1e-12);
}

TEST(MassProperties, AMeshOfABoxIsTheBox) {
  const Vec3 size(0.25, 0.5, 1), at(2, -1, 0.5);  // numbers that a float holds
  MassProperties box = mass_properties(solid_of(ShapeKind::kBox, size), {}, kDensity);
  box.com += at;
  ShapeSpec spec = solid_of(ShapeKind::kMesh, Vec3::Ones());
  spec.mesh = 0;
  MeshSpec mesh = box_mesh(size, at);
  EXPECT_TRUE(encloses_solid(mesh));
  expect_same(mass_properties(spec, {mesh}, kDensity), box, 1e-12);
  for (auto& triangle : mesh.triangles)
    std::swap(triangle[0], triangle[1]);
  expect_same(mass_properties(spec, {mesh}, kDensity), box, 1e-12);
  mesh.triangles.pop_back();
  EXPECT_FALSE(encloses_solid(mesh));
}

TEST(MassProperties, HalvesJoinToTheWhole) {
  const Vec3 size(0.25, 0.5, 1);
  const MassProperties whole = mass_properties(solid_of(ShapeKind::kBox, size), {}, kDensity);
  const MassProperties half =
      mass_properties(solid_of(ShapeKind::kBox, {0.25, 0.25, 1}), {}, kDensity);
  Pose left, right;
  left.p = Vec3(0, -0.125, 0);
  right.p = Vec3(0, 0.125, 0);
  expect_same(joined(seen_from(left, half), seen_from(right, half)), whole, 1e-14);
  Pose turned;
  turned.R = exp_so3(Vec3(0.3, -0.7, 0.4));
  turned.p = Vec3(1, 2, 3);
  const MassProperties seen =
      seen_from(turned, joined(seen_from(left, half), seen_from(right, half)));
  EXPECT_LT((seen.com - turned.p).norm(), 1e-15);
  EXPECT_LT((seen.inertia - turned.R * whole.inertia * turned.R.transpose()).norm(),
            1e-13 * whole.inertia.norm());
}

}  // namespace
}  // namespace cprsim
