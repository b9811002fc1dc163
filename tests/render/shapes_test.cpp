// SPDX-License-Identifier: BSD-3-Clause
#include "render/shapes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace cprsim {
namespace {

constexpr double kPi = std::numbers::pi;

ShapeSpec shape(ShapeKind kind, const Vec3& size) {
  ShapeSpec spec;
  spec.kind = kind;
  spec.size = size;
  return spec;
}

/// By the divergence theorem: right only if the surface is closed and wound outwards.
double volume(const TriMesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return mesh.vertices[mesh.indices[i + k]].position.cast<double>();
    };
    sum += Vec3(at(0)).dot(Vec3(at(1)).cross(Vec3(at(2)))) / 6;
  }
  return sum;
}

Eigen::AlignedBox3d box_of(const TriMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vertex& vertex : mesh.vertices)
    box.extend(vertex.position.cast<double>());
  return box;
}

struct Case {
  const char* name;
  ShapeSpec spec;
  double volume;
  Vec3 half;
};

TEST(Shapes, AreClosedAndHaveTheirVolumeAndSize) {
  const std::vector<Case> cases{
      {"box", shape(ShapeKind::kBox, {0.2, 0.4, 0.6}), 0.048, {0.1, 0.2, 0.3}},
      {"sphere", shape(ShapeKind::kSphere, {0.5, 0, 0}), kPi / 6, {0.5, 0.5, 0.5}},
      {"cylinder", shape(ShapeKind::kCylinder, {0.5, 2, 0}), kPi / 2, {0.5, 0.5, 1}},
      {"capsule", shape(ShapeKind::kCapsule, {0.5, 2, 0}), kPi / 2 + kPi / 6, {0.5, 0.5, 1.5}},
      {"cone", shape(ShapeKind::kCone, {0.5, 3, 0}), kPi / 4, {0.5, 0.5, 1.5}},
      {"tube", shape(ShapeKind::kTube, {1, 2, 0.5}), 1.5 * kPi, {1, 1, 1}},
      {"ellipsoid", shape(ShapeKind::kEllipsoid, {1, 2, 3}), 8 * kPi, {1, 2, 3}}};
  for (const Case& c : cases) {
    const TriMesh mesh = make_shape(c.spec, {}, {});
    // 1.5 %: rounded edges and 72 sides
    EXPECT_NEAR(volume(mesh) / c.volume, 1, 0.015) << c.name;
    EXPECT_LT((box_of(mesh).max() - c.half).norm(), 2e-3 * c.half.norm()) << c.name;
    EXPECT_LT((box_of(mesh).min() + c.half).norm(), 2e-3 * c.half.norm()) << c.name;
  }
}

TEST(Shapes, NormalsAreUnitAndOnTheFacesSide) {
  for (ShapeKind kind :
       {ShapeKind::kBox, ShapeKind::kSphere, ShapeKind::kCylinder, ShapeKind::kCapsule,
        ShapeKind::kCone, ShapeKind::kEllipsoid, ShapeKind::kTube, ShapeKind::kPlane}) {
    const TriMesh mesh = make_shape(shape(kind, {0.6, 0.4, 0.5}), {}, {});
    ASSERT_FALSE(mesh.indices.empty());
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const Vertex &a = mesh.vertices[mesh.indices[i]], &b = mesh.vertices[mesh.indices[i + 1]],
                   &c = mesh.vertices[mesh.indices[i + 2]];
      const Eigen::Vector3f n = (b.position - a.position).cross(c.position - a.position);
      EXPECT_NEAR(a.normal.norm(), 1, 1e-5);
      EXPECT_GE(n.dot(a.normal + b.normal + c.normal), 0) << static_cast<int>(kind);
    }
  }
}

TEST(Shapes, MeshKeepsItsColoursUnlessTheSceneGivesOne) {
  MeshSpec spec;
  spec.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  spec.normals.assign(3, Eigen::Vector3f::UnitZ());
  spec.colors.assign(3, Eigen::Vector3f(1, 0, 0));
  spec.triangles = {{0, 1, 2}};
  ShapeSpec s = shape(ShapeKind::kMesh, Vec3::Zero());
  s.mesh = 0;
  Look look;
  look.diffuse = {0, 0, 1};
  EXPECT_EQ(make_shape(s, look, {spec}).vertices[0].color[0], 255);
  look.set = true;
  EXPECT_EQ(make_shape(s, look, {spec}).vertices[0].color[0], 0);
  s.mesh = 3;
  EXPECT_TRUE(make_shape(s, look, {spec}).indices.empty())
      << "an index beyond the meshes draws nothing";
}

}  // namespace
}  // namespace cprsim
