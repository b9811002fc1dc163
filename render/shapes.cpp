// SPDX-License-Identifier: BSD-3-Clause
// Every round shape is one profile curve turned about z; only box, plane and mesh are not.
#include "render/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/math/so3.h"

namespace cprsim {

namespace {

constexpr double kPi = std::numbers::pi;

/// A point of a profile: distance from the axis and height, with the normal there.
struct ProfilePoint {
  double r, z, nr, nz;
};

using Profile2 = std::vector<ProfilePoint>;

void add_triangle(TriMesh& mesh, std::size_t a, std::size_t b, std::size_t c) {
  for (std::size_t i : {a, b, c})
    mesh.indices.push_back(static_cast<std::uint32_t>(i));
}

void add_vertex(TriMesh& mesh, const Vec3& p, const Vec3& n, std::array<std::uint8_t, 4> color) {
  mesh.vertices.push_back({p.cast<float>(), n.cast<float>(), color});
}

/// A quarter or less of a circle about (r, z), from angle a to b measured from the radial
/// direction.
void add_arc(Profile2& profile, double r, double z, double radius, double a, double b, int cells) {
  for (int i = 0; i <= cells; ++i) {
    const double t = a + (b - a) * i / cells;
    profile.push_back(
        {r + radius * std::cos(t), z + radius * std::sin(t), std::cos(t), std::sin(t)});
  }
}

/// Turns a profile, given from the bottom up, about z.
TriMesh revolve(const Profile2& profile, int sides, std::array<std::uint8_t, 4> color) {
  TriMesh mesh;
  const auto ring = static_cast<std::size_t>(sides) + 1;
  for (const ProfilePoint& q : profile) {
    for (int k = 0; k <= sides; ++k) {
      const double a = 2 * kPi * k / sides, c = std::cos(a), s = std::sin(a);
      add_vertex(mesh, {q.r * c, q.r * s, q.z}, {q.nr * c, q.nr * s, q.nz}, color);
    }
  }
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    for (std::size_t k = 0; k + 1 < ring; ++k) {
      const std::size_t a = i * ring + k, b = a + ring;
      if (profile[i].r > 0) add_triangle(mesh, a, a + 1, b + 1);
      if (profile[i + 1].r > 0) add_triangle(mesh, a, b + 1, b);
    }
  }
  return mesh;
}

/// Flat bottom, rounded rim, straight side, rounded rim, flat top.
Profile2 cylinder_profile(double radius, double length) {
  const double bevel = 0.3 * std::min(0.25 * radius, 0.5 * length);
  const double h = 0.5 * length;
  Profile2 profile{{0, -h, 0, -1}};
  add_arc(profile, radius - bevel, -h + bevel, bevel, -0.5 * kPi, 0, 2);
  add_arc(profile, radius - bevel, h - bevel, bevel, 0, 0.5 * kPi, 2);
  profile.push_back({0, h, 0, 1});
  return profile;
}

Profile2 capsule_profile(double radius, double length) {
  Profile2 profile;
  add_arc(profile, 0, -0.5 * length, radius, -0.5 * kPi, 0, 12);
  add_arc(profile, 0, 0.5 * length, radius, 0, 0.5 * kPi, 12);
  profile.front().r = profile.back().r = 0;
  return profile;
}

Profile2 cone_profile(double radius, double length) {
  const double slope = std::hypot(radius, length), h = 0.5 * length;
  const double nr = length / slope, nz = radius / slope;
  return {{0, -h, 0, -1}, {radius, -h, 0, -1}, {radius, -h, nr, nz}, {0, h, nr, nz}};
}

/// A box whose faces, edges and corners are the images of a subdivided cube's: each face is a 4 × 4
/// grid of points, the outer ones on the rounding.
TriMesh make_box(const Vec3& size, std::array<std::uint8_t, 4> color) {
  TriMesh mesh;
  const Vec3 half = 0.5 * size;
  const double bevel = 0.08 * half.minCoeff();
  const Vec3 core = half - Vec3::Constant(bevel);
  // positions along an edge as {side, lean}: lean is the normal's share along that axis
  constexpr std::array<std::array<double, 2>, 6> kStops{
      {{-1, -1}, {-1, -0.41}, {-1, 0}, {1, 0}, {1, 0.41}, {1, 1}}};
  for (int axis = 0; axis < 3; ++axis) {
    for (int sign : {-1, 1}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const std::size_t first = mesh.vertices.size();
      for (const auto& a : kStops) {
        for (const auto& b : kStops) {
          Vec3 n = Vec3::Zero(), p;
          n[axis] = sign;
          n[u] = a[1];
          n[v] = b[1];
          n.normalize();
          p[axis] = sign * core[axis];
          p[u] = a[0] * core[u];
          p[v] = b[0] * core[v];
          add_vertex(mesh, p + bevel * n, n, color);
        }
      }
      for (std::size_t i = 0; i < 5; ++i) {
        for (std::size_t j = 0; j < 5; ++j) {
          const std::size_t a = first + 6 * i + j, b = a + 6;
          if (sign > 0) {
            add_triangle(mesh, a, b, b + 1);
            add_triangle(mesh, a, b + 1, a + 1);
          } else {
            add_triangle(mesh, a, b + 1, b);
            add_triangle(mesh, a, a + 1, b + 1);
          }
        }
      }
    }
  }
  return mesh;
}

/// Inner side, bottom, outer side, top: corners are sharp.
Profile2 tube_profile(double radius, double inner, double length) {
  const double h = 0.5 * length;
  return {{inner, h, -1, 0},  {inner, -h, -1, 0}, {inner, -h, 0, -1}, {radius, -h, 0, -1},
          {radius, -h, 1, 0}, {radius, h, 1, 0},  {radius, h, 0, 1},  {inner, h, 0, 1}};
}

TriMesh make_plane(const ShapeSpec& shape, std::array<std::uint8_t, 4> color) {
  TriMesh mesh;
  const Vec3 n = shape.normal.norm() > 0 ? Vec3(shape.normal.normalized()) : Vec3::UnitZ();
  const Mat3 turn = rotation_between(Vec3::UnitZ(), n);
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    add_vertex(mesh, turn * Vec3(0.5 * x * shape.size.x(), 0.5 * y * shape.size.y(), 0), n, color);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

TriMesh make_ellipsoid(const Vec3& axes, int sides, std::array<std::uint8_t, 4> color) {
  TriMesh mesh = revolve(capsule_profile(1, 0), sides, color);
  const Eigen::Vector3f scale = axes.cast<float>();
  for (Vertex& vertex : mesh.vertices) {
    vertex.position = vertex.position.cwiseProduct(scale);
    vertex.normal = vertex.normal.cwiseQuotient(scale).normalized();
  }
  return mesh;
}

TriMesh copy_mesh(const MeshSpec& spec, const Look& look, std::array<std::uint8_t, 4> color) {
  TriMesh mesh;
  const bool own_colors = !look.set && spec.colors.size() == spec.positions.size();
  mesh.vertices.reserve(spec.positions.size());
  for (std::size_t i = 0; i < spec.positions.size(); ++i) {
    mesh.vertices.push_back({spec.positions[i],
                             i < spec.normals.size() ? spec.normals[i] : Eigen::Vector3f::UnitZ(),
                             own_colors ? to_bytes(spec.colors[i], look.opacity) : color});
  }
  mesh.indices.reserve(3 * spec.triangles.size());
  for (const auto& triangle : spec.triangles) {
    mesh.indices.insert(mesh.indices.end(), triangle.begin(), triangle.end());
  }
  return mesh;
}

}  // namespace

std::array<std::uint8_t, 4> to_bytes(const Eigen::Vector3f& color, double opacity) {
  const auto byte = [](double x) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
  };
  return {byte(color.x()), byte(color.y()), byte(color.z()), byte(opacity)};
}

TriMesh make_shape(const ShapeSpec& shape, const Look& look, const std::vector<MeshSpec>& meshes) {
  constexpr int kSides = 72;
  const std::array<std::uint8_t, 4> color = to_bytes(look.diffuse.cast<float>(), look.opacity);
  const Vec3& size = shape.size;
  switch (shape.kind) {
    case ShapeKind::kEmpty:
      break;
    case ShapeKind::kBox:
      return make_box(size, color);
    case ShapeKind::kSphere:
      return make_ellipsoid(Vec3::Constant(size.x()), kSides, color);
    case ShapeKind::kCylinder:
      return revolve(cylinder_profile(size.x(), size.y()), kSides, color);
    case ShapeKind::kTube:
      return revolve(tube_profile(size.x(), size.z(), size.y()), kSides, color);
    case ShapeKind::kCapsule:
      return revolve(capsule_profile(size.x(), size.y()), kSides, color);
    case ShapeKind::kCone:
      return revolve(cone_profile(size.x(), size.y()), kSides, color);
    case ShapeKind::kEllipsoid:
      return make_ellipsoid(size, kSides, color);
    case ShapeKind::kPlane:
      return make_plane(shape, color);
    case ShapeKind::kMesh:
      if (shape.mesh >= 0 && static_cast<std::size_t>(shape.mesh) < meshes.size()) {
        return copy_mesh(meshes[static_cast<std::size_t>(shape.mesh)], look, color);
      }
      break;
  }
  return {};
}

}  // namespace cprsim
