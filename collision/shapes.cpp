// SPDX-License-Identifier: BSD-3-Clause
#include "collision/shapes.h"

#include <LinearMath/btConvexHullComputer.h>
#include <btBulletCollisionCommon.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "collision/convert.h"

namespace cprsim {
namespace {

// above this many vertices the face lists of a hull cost more to build than their contacts are
// worth
constexpr int kMostHullVerticesWithFaces = 256;

btVector3 scaled(const Vec3& v) {
  return to_bullet(kUnitsPerMetre * v);
}

btVector3 scaled(const Eigen::Vector3f& v) {
  return scaled(Vec3(v.cast<double>()));
}

/// x²/a² + y²/b² + z²/c² <= 1. The point with outward normal d is A²d / |A d|, A = diag(a, b, c).
class Ellipsoid : public btConvexInternalShape {
 public:
  explicit Ellipsoid(const btVector3& semi_axes) : semi_axes_(semi_axes) {
    m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
    btConvexInternalShape::setMargin(0);
  }

  btVector3 localGetSupportingVertexWithoutMargin(const btVector3& d) const override {
    const btVector3 Ad = semi_axes_ * d;
    const btScalar length = Ad.length();
    if (length <= 0) return {0, 0, semi_axes_.z()};
    return semi_axes_ * Ad / length;
  }

  btVector3 localGetSupportingVertex(const btVector3& d) const override {
    return localGetSupportingVertexWithoutMargin(d);
  }

  void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3* directions,
                                                         btVector3* vertices,
                                                         int count) const override {
    for (int i = 0; i < count; ++i)
      vertices[i] = localGetSupportingVertexWithoutMargin(directions[i]);
  }

  void getAabb(const btTransform& X, btVector3& low, btVector3& high) const override {
    btVector3 half;
    for (int i = 0; i < 3; ++i)
      half[i] = (semi_axes_ * X.getBasis()[i]).length();
    low = X.getOrigin() - half;
    high = X.getOrigin() + half;
  }

  void calculateLocalInertia(btScalar mass, btVector3& inertia) const override {
    const btVector3 q = semi_axes_ * semi_axes_ * (mass / 5);
    inertia.setValue(q.y() + q.z(), q.z() + q.x(), q.x() + q.y());
  }

  void setMargin(btScalar) override {}

  const char* getName() const override { return "ellipsoid"; }

 private:
  btVector3 semi_axes_;
};

/// Corners of the hull only, so that support queries and faces do not see interior vertices.
std::unique_ptr<btConvexHullShape> make_hull(const MeshSpec& mesh) {
  std::vector<btVector3> points;
  points.reserve(mesh.positions.size());
  for (const Eigen::Vector3f& p : mesh.positions)
    points.push_back(scaled(p));
  btConvexHullComputer computer;
  computer.compute(&points[0].m_floats[0], sizeof(btVector3), static_cast<int>(points.size()), 0,
                   0);
  auto hull = std::make_unique<btConvexHullShape>();
  for (int i = 0; i < computer.vertices.size(); ++i)
    hull->addPoint(computer.vertices[i], false);
  hull->setMargin(0);
  hull->recalcLocalAabb();
  if (computer.vertices.size() <= kMostHullVerticesWithFaces) hull->initializePolyhedralFeatures();
  return hull;
}

std::unique_ptr<btCollisionShape> make_convex(const ShapeSpec& spec) {
  const Vec3 size = kUnitsPerMetre * spec.size;
  switch (spec.kind) {
    case ShapeKind::kBox: {
      auto box = std::make_unique<btBoxShape>(to_bullet(size / 2));
      box->setMargin(0);
      box->initializePolyhedralFeatures();
      return box;
    }
    case ShapeKind::kSphere:
      return std::make_unique<btSphereShape>(size[0]);
    case ShapeKind::kCylinder: {
      auto cylinder = std::make_unique<btCylinderShapeZ>(btVector3(size[0], size[0], size[1] / 2));
      cylinder->setMargin(0);
      return cylinder;
    }
    case ShapeKind::kCapsule:
      return std::make_unique<btCapsuleShapeZ>(size[0], size[1]);
    case ShapeKind::kCone: {
      auto cone = std::make_unique<btConeShapeZ>(size[0], size[1]);
      cone->setMargin(0);
      return cone;
    }
    case ShapeKind::kEllipsoid:
      return std::make_unique<Ellipsoid>(to_bullet(size));
    default:
      return std::make_unique<btEmptyShape>();
  }
}

}  // namespace

struct Shapes::Store {
  std::vector<std::unique_ptr<btTriangleMesh>> triangles;  // outlive the shapes that read them
  std::vector<std::unique_ptr<btCollisionShape>> shapes;

  btCollisionShape* keep(std::unique_ptr<btCollisionShape> shape) {
    shapes.push_back(std::move(shape));
    return shapes.back().get();
  }
};

Shapes::Shapes(const std::vector<MeshSpec>& meshes)
    : meshes_(meshes), store_(std::make_unique<Store>()) {}

Shapes::~Shapes() = default;

/// Bullet has no shape with a hole: wedges around it, whose corners lie on both cylinders.
btCollisionShape* Shapes::tube(const ShapeSpec& spec) {
  constexpr int kWedges = 48;
  const auto half = static_cast<float>(0.5 * spec.size.y());
  auto whole = std::make_unique<btCompoundShape>();
  for (int i = 0; i < kWedges; ++i) {
    MeshSpec wedge;
    for (int side = 0; side < 2; ++side) {
      const double angle = 2 * std::numbers::pi * (i + side) / kWedges;
      for (const double radius : {spec.size.x(), spec.size.z()})
        for (const float z : {-half, half})
          wedge.positions.emplace_back(static_cast<float>(radius * std::cos(angle)),
                                       static_cast<float>(radius * std::sin(angle)), z);
    }
    whole->addChildShape(btTransform::getIdentity(), store_->keep(make_hull(wedge)));
  }
  return store_->keep(std::move(whole));
}

btCollisionShape* Shapes::empty() {
  return store_->keep(std::make_unique<btEmptyShape>());
}

btCollisionShape* Shapes::for_obstacle(const ShapeSpec& spec) {
  if (spec.kind == ShapeKind::kPlane)
    return store_->keep(
        std::make_unique<btStaticPlaneShape>(to_bullet(spec.normal.normalized()), 0));
  if (spec.kind == ShapeKind::kTube) return tube(spec);
  if (spec.kind != ShapeKind::kMesh) return store_->keep(make_convex(spec));

  const MeshSpec& mesh = meshes_.at(static_cast<std::size_t>(spec.mesh));
  auto triangles = std::make_unique<btTriangleMesh>();
  for (const auto& [a, b, c] : mesh.triangles)
    triangles->addTriangle(scaled(mesh.positions[a]), scaled(mesh.positions[b]),
                           scaled(mesh.positions[c]));
  auto shape = std::make_unique<btBvhTriangleMeshShape>(triangles.get(), true);
  shape->setMargin(0);
  store_->triangles.push_back(std::move(triangles));
  return store_->keep(std::move(shape));
}

btCollisionShape* Shapes::for_free_body(const BodySpec& body, const Pose& X_BG) {
  auto compound = std::make_unique<btCompoundShape>();
  for (const ColliderSpec& collider : body.colliders) {
    if (collider.shape.kind == ShapeKind::kPlane)
      throw std::invalid_argument("collision " + collider.name + " of " + body.name +
                                  ": a plane cannot belong to a body that moves freely");
    btCollisionShape* child =
        collider.shape.kind == ShapeKind::kMesh
            ? store_->keep(make_hull(meshes_.at(static_cast<std::size_t>(collider.shape.mesh))))
        : collider.shape.kind == ShapeKind::kTube ? tube(collider.shape)
                                                  : store_->keep(make_convex(collider.shape));
    compound->addChildShape(to_bullet(scaled(X_BG.inverse() * collider.X_BC, kUnitsPerMetre)),
                            child);
  }
  // a single shape in its own axes needs no compound around it
  if (compound->getNumChildShapes() == 1 &&
      compound->getChildTransform(0) == btTransform::getIdentity())
    return compound->getChildShape(0);
  return store_->keep(std::move(compound));
}

}  // namespace cprsim
