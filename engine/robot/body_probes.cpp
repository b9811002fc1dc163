// SPDX-License-Identifier: BSD-3-Clause
// The features of shapes that may touch a solid first.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "engine/robot/body_contacts.h"

namespace cprsim {
namespace {

using Kind = BodyProbe::Kind;

// of a shape's thickness: edges are this round, which leaves faces where they are and gives what
// touches at a corner a normal
constexpr double kRounding = 1e-3;

class ProbeList {
 public:
  ProbeList(const Pose& X_BC, double round) : X_BC_(X_BC), round_(round) {}

  double round() const { return round_; }

  void point(const Vec3& p, double radius = 0) { add(Kind::kPoint, p, Vec3::Zero(), radius); }

  void edge(const Vec3& a, const Vec3& b, double radius = 0) { add(Kind::kEdge, a, b, radius); }

  /// Eight points and the lowest one of a circle about z.
  void rim(double z, double outer) {
    const double radius = outer - round_;
    constexpr int kPoints = 8;
    for (int i = 0; i < kPoints; ++i) {
      const double turn = 2 * std::numbers::pi * i / kPoints;
      point({radius * std::cos(turn), radius * std::sin(turn), z}, round_);
    }
    add(Kind::kRim, {0, 0, z}, {radius, 0, 0}, round_);
  }

  void ellipsoid(const Vec3& semi_axes) { add(Kind::kEllipsoid, semi_axes, Vec3::Zero(), round_); }

  std::vector<BodyProbe> take() { return std::move(probes_); }

 private:
  void add(Kind kind, const Vec3& a, const Vec3& b, double radius) {
    BodyProbe probe;
    probe.kind = kind;
    probe.X_BC = X_BC_;
    probe.a = a;
    probe.b = b;
    probe.radius = radius;
    probes_.push_back(probe);
  }

  Pose X_BC_;
  double round_;
  std::vector<BodyProbe> probes_;
};

void add_box(const Vec3& outer, ProbeList& list) {
  const double r = list.round();
  const Vec3 size = outer - Vec3::Constant(2 * r);
  const auto corner = [&](int i) {
    return Vec3((i & 1 ? 0.5 : -0.5) * size.x(), (i & 2 ? 0.5 : -0.5) * size.y(),
                (i & 4 ? 0.5 : -0.5) * size.z());
  };
  for (int i = 0; i < 8; ++i)
    list.point(corner(i), r);
  for (int i = 0; i < 8; ++i)
    for (const int bit : {1, 2, 4})
      if (!(i & bit)) list.edge(corner(i), corner(i | bit), r);
}

Eigen::AlignedBox3d bounds_of(const MeshSpec& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : mesh.positions)
    box.extend(p.cast<double>());
  return box;
}

const MeshSpec& mesh_of(const ShapeSpec& shape, const std::vector<MeshSpec>& meshes) {
  return meshes.at(static_cast<std::size_t>(shape.mesh));
}

}  // namespace

std::vector<BodyProbe> probes_of(const ColliderSpec& collider,
                                 const std::vector<MeshSpec>& meshes) {
  const Vec3& size = collider.shape.size;
  const double round = kRounding * thickness_of(collider.shape, meshes);
  ProbeList list(collider.X_BC, round);
  switch (collider.shape.kind) {
    case ShapeKind::kBox:
      add_box(size, list);
      break;
    case ShapeKind::kSphere:
      list.point(Vec3::Zero(), size.x());
      break;
    case ShapeKind::kCapsule: {
      const Vec3 end(0, 0, 0.5 * size.y());
      list.point(-end, size.x());
      list.point(end, size.x());
      list.edge(-end, end, size.x());
      break;
    }
    case ShapeKind::kCylinder:
      list.rim(-0.5 * size.y() + round, size.x());
      list.rim(0.5 * size.y() - round, size.x());
      break;
    case ShapeKind::kTube:
      for (const double radius : {size.x(), size.z()})
        for (const double side : {-1, 1})
          list.rim(side * (0.5 * size.y() - round), radius);
      break;
    case ShapeKind::kCone:
      list.rim(-0.5 * size.y() + round, size.x());
      list.point({0, 0, 0.5 * size.y()});
      break;
    case ShapeKind::kEllipsoid:
      list.ellipsoid(size);
      break;
    case ShapeKind::kMesh: {
      std::set<std::array<float, 3>> seen;  // seams repeat corners
      for (const Eigen::Vector3f& p : mesh_of(collider.shape, meshes).positions)
        if (seen.insert({p.x(), p.y(), p.z()}).second) list.point(p.cast<double>());
      break;
    }
    case ShapeKind::kPlane:  // everything else has the points
    case ShapeKind::kEmpty:
      break;
  }
  return list.take();
}

std::pair<Vec3, double> ball_around(const ColliderSpec& collider,
                                    const std::vector<MeshSpec>& meshes) {
  const ShapeSpec& shape = collider.shape;
  const Vec3& size = shape.size;
  double radius = 0;
  Vec3 centre = Vec3::Zero();
  switch (shape.kind) {
    case ShapeKind::kBox:
      radius = 0.5 * size.norm();
      break;
    case ShapeKind::kSphere:
      radius = size.x();
      break;
    case ShapeKind::kCapsule:
      radius = size.x() + 0.5 * size.y();
      break;
    case ShapeKind::kCylinder:
    case ShapeKind::kTube:
    case ShapeKind::kCone:
      radius = std::hypot(size.x(), 0.5 * size.y());
      break;
    case ShapeKind::kEllipsoid:
      radius = size.maxCoeff();
      break;
    case ShapeKind::kMesh: {
      const Eigen::AlignedBox3d box = bounds_of(mesh_of(shape, meshes));
      centre = box.center();
      radius = 0.5 * box.diagonal().norm();
      break;
    }
    case ShapeKind::kPlane:
      radius = std::numeric_limits<double>::infinity();
      break;
    case ShapeKind::kEmpty:
      break;
  }
  return {collider.X_BC * centre, radius};
}

double thickness_of(const ShapeSpec& shape, const std::vector<MeshSpec>& meshes) {
  const Vec3& size = shape.size;
  switch (shape.kind) {
    case ShapeKind::kBox:
      return size.minCoeff();
    case ShapeKind::kSphere:
    case ShapeKind::kCapsule:
      return 2 * size.x();
    case ShapeKind::kCylinder:
    case ShapeKind::kCone:
      return std::min(2 * size.x(), size.y());
    case ShapeKind::kTube:
      return std::min(size.x() - size.z(), size.y());
    case ShapeKind::kEllipsoid:
      return 2 * size.minCoeff();
    case ShapeKind::kMesh: {
      // a sheet has no inside: what is thin enough is not to be jumped over either
      constexpr double kSheet = 0.01;
      const Vec3 extent = bounds_of(mesh_of(shape, meshes)).sizes();
      return std::max(extent.minCoeff(), kSheet * extent.maxCoeff());
    }
    default:
      return std::numeric_limits<double>::infinity();
  }
}

}  // namespace cprsim
