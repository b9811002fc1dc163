// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/mass_properties.h"

#include <cmath>
#include <numbers>

#include "engine/model/mesh_distance.h"

namespace cprsim {
namespace {

using std::numbers::pi;

/// Moments about the axes of a solid with principal axes; com at height z.
MassProperties of_principal(double mass, double z, const Vec3& moments) {
  return {mass, Vec3(0, 0, z), moments.asDiagonal()};
}

MassProperties capsule(double r, double length, double density) {
  const double pipe = density * pi * r * r * length, caps = density * 4 / 3 * pi * r * r * r;
  const double across = pipe * (length * length / 12 + r * r / 4) +
                        caps * (0.4 * r * r + length * length / 4 + 0.375 * length * r);
  const double along = pipe * r * r / 2 + caps * 0.4 * r * r;
  return of_principal(pipe + caps, 0, {across, across, along});
}

Mat3 parallel_axes(double mass, const Vec3& d) {
  return mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
}

// Signed tetrahedra between a point of the mesh and its triangles. One with the corners 0, a, b, c
// and six volumes D = det(a, b, c): ∫ x = D / 24 (a + b + c), ∫ x x^T = D / 120 (a a^T + b b^T +
// c c^T + (a + b + c) (a + b + c)^T).
MassProperties solid(const MeshSpec& mesh, double density) {
  if (mesh.triangles.empty()) return {};
  const Vec3 origin = mesh.positions[mesh.triangles[0][0]].cast<double>();
  double six = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const auto& triangle : mesh.triangles) {
    Mat3 corners;
    for (int i = 0; i < 3; ++i)
      corners.col(i) =
          mesh.positions[triangle[static_cast<std::size_t>(i)]].cast<double>() - origin;
    const double D = corners.determinant();
    const Vec3 sum = corners.rowwise().sum();
    six += D;
    first += D * sum;
    second += D * (corners * corners.transpose() + sum * sum.transpose());
  }
  if (six == 0) return {};
  const double rho = six < 0 ? -density : density;
  MassProperties found;
  found.mass = rho * six / 6;
  const Vec3 com = rho / 24 * first / found.mass;
  const Mat3 about = rho / 120 * second - found.mass * com * com.transpose();
  found.com = origin + com;
  found.inertia = about.trace() * Mat3::Identity() - about;
  return found;
}

}  // namespace

bool encloses_solid(const MeshSpec& mesh) {
  return MeshDistance(mesh).closed();
}

MassProperties mass_properties(const ShapeSpec& shape, const std::vector<MeshSpec>& meshes,
                               double density) {
  const double r = shape.size[0], l = shape.size[1];
  switch (shape.kind) {
    case ShapeKind::kBox: {
      const double m = density * shape.size.prod();
      const Vec3 squares = shape.size.cwiseAbs2();
      return of_principal(m, 0, m / 12 * (Vec3::Constant(squares.sum()) - squares));
    }
    case ShapeKind::kSphere: {
      const double m = density * 4 / 3 * pi * r * r * r;
      return of_principal(m, 0, Vec3::Constant(0.4 * m * r * r));
    }
    case ShapeKind::kEllipsoid: {
      const double m = density * 4 / 3 * pi * shape.size.prod();
      const Vec3 squares = shape.size.cwiseAbs2();
      return of_principal(m, 0, m / 5 * (Vec3::Constant(squares.sum()) - squares));
    }
    case ShapeKind::kCylinder: {
      const double m = density * pi * r * r * l, across = m * (r * r / 4 + l * l / 12);
      return of_principal(m, 0, {across, across, m * r * r / 2});
    }
    case ShapeKind::kTube: {
      const double i = shape.size[2], m = density * pi * (r * r - i * i) * l;
      const double squares = r * r + i * i, across = m * (squares / 4 + l * l / 12);
      return of_principal(m, 0, {across, across, m * squares / 2});
    }
    case ShapeKind::kCapsule:
      return capsule(r, l, density);
    case ShapeKind::kCone: {
      const double m = density * pi * r * r * l / 3, across = m * 3 / 80 * (4 * r * r + l * l);
      return of_principal(m, -l / 4, {across, across, 0.3 * m * r * r});
    }
    case ShapeKind::kMesh:
      if (shape.mesh >= 0) return solid(meshes[static_cast<std::size_t>(shape.mesh)], density);
      break;
    case ShapeKind::kPlane:
    case ShapeKind::kEmpty:
      break;
  }
  return {};
}

MassProperties seen_from(const Pose& X, const MassProperties& body) {
  return {body.mass, X * body.com, X.R * body.inertia * X.R.transpose()};
}

MassProperties joined(const MassProperties& a, const MassProperties& b) {
  const double mass = a.mass + b.mass;
  if (mass <= 0) return {};
  const Vec3 com = (a.mass * a.com + b.mass * b.com) / mass;
  return {mass, com,
          a.inertia + parallel_axes(a.mass, a.com - com) + b.inertia +
              parallel_axes(b.mass, b.com - com)};
}

}  // namespace cprsim
