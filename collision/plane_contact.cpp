// SPDX-License-Identifier: BSD-3-Clause
#include "collision/plane_contact.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace cprsim {
namespace {

// sine of the tilt below which a disc counts as flat: the rim then misses its lowest point by 1e-6
// radii
constexpr double kFlat = 1e-6;

using Points = std::vector<btVector3>;

/// Four fixed points of the circle of this radius about z, and the lowest one if it has one.
void add_rim(double radius, double z, const btVector3& down, Points& points) {
  for (int i = 0; i < 4; ++i)
    points.emplace_back(i % 2 == 0 ? radius * (1 - i) : 0, i % 2 == 1 ? radius * (2 - i) : 0, z);
  const double tilt = std::hypot(down.x(), down.y());
  if (tilt > kFlat) points.emplace_back(radius * down.x() / tilt, radius * down.y() / tilt, z);
}

/// Points of a shape, in its own axes, of which some are the lowest in the direction `down`.
Points lowest_points(const btConvexShape& shape, const btVector3& down) {
  Points points;
  if (shape.isPolyhedral()) {
    const auto& polyhedron = static_cast<const btPolyhedralConvexShape&>(shape);
    points.resize(static_cast<std::size_t>(polyhedron.getNumVertices()));
    for (std::size_t i = 0; i < points.size(); ++i)
      polyhedron.getVertex(static_cast<int>(i), points[i]);
    return points;
  }
  switch (shape.getShapeType()) {
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      const btVector3 end(0, 0, capsule.getHalfHeight());
      points = {capsule.getRadius() * down + end, capsule.getRadius() * down - end};
      break;
    }
    case CYLINDER_SHAPE_PROXYTYPE: {
      const btVector3 half = static_cast<const btCylinderShape&>(shape).getHalfExtentsWithMargin();
      add_rim(half.x(), half.z(), down, points);
      add_rim(half.x(), -half.z(), down, points);
      break;
    }
    case CONE_SHAPE_PROXYTYPE: {
      const auto& cone = static_cast<const btConeShape&>(shape);
      points.emplace_back(0, 0, cone.getHeight() / 2);
      add_rim(cone.getRadius(), -cone.getHeight() / 2, down, points);
      break;
    }
    default:
      points = {shape.localGetSupportingVertex(down)};
  }
  return points;
}

/// One pair of a convex shape and a plane. The manifold's body 0 is the convex one.
class Algorithm : public btCollisionAlgorithm {
 public:
  Algorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObject* convex,
            const btCollisionObject* plane, bool swapped)
      : btCollisionAlgorithm(info),
        manifold_(m_dispatcher->getNewManifold(convex, plane)),
        swapped_(swapped) {}

  ~Algorithm() override { m_dispatcher->releaseManifold(manifold_); }

  void processCollision(const btCollisionObjectWrapper* wrap0,
                        const btCollisionObjectWrapper* wrap1, const btDispatcherInfo&,
                        btManifoldResult* result) override {
    const btCollisionObjectWrapper& convex = swapped_ ? *wrap1 : *wrap0;
    const btCollisionObjectWrapper& plane = swapped_ ? *wrap0 : *wrap1;
    const auto& shape = static_cast<const btConvexShape&>(*convex.getCollisionShape());
    const auto& surface = static_cast<const btStaticPlaneShape&>(*plane.getCollisionShape());
    const btTransform& X_convex = convex.getWorldTransform();
    const btTransform& X_plane = plane.getWorldTransform();
    const btVector3 normal = X_plane.getBasis() * surface.getPlaneNormal();
    const btScalar level = surface.getPlaneConstant() + normal.dot(X_plane.getOrigin());

    // points within the breaking distance enter the manifold, which keeps the best four
    result->setPersistentManifold(manifold_);
    Points found;
    for (const btVector3& local : lowest_points(shape, -normal * X_convex.getBasis())) {
      const btVector3 point = X_convex * local;
      const btScalar distance = normal.dot(point) - level;
      if (distance >= manifold_->getContactBreakingThreshold()) continue;
      found.push_back(point - distance * normal);
      result->addContactPoint(normal, found.back(), distance);
    }
    drop_old_points(found);
  }

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }

  void getAllContactManifolds(btManifoldArray& manifolds) override {
    manifolds.push_back(manifold_);
  }

 private:
  /// Only what was found now is in contact; Bullet would keep a point until it has moved visibly.
  void drop_old_points(const Points& found) {
    for (int i = manifold_->getNumContacts() - 1; i >= 0; --i)
      if (std::find(found.begin(), found.end(),
                    manifold_->getContactPoint(i).getPositionWorldOnB()) == found.end())
        manifold_->removeContactPoint(i);
  }

  btPersistentManifold* manifold_;
  bool swapped_;
};

struct Create : btCollisionAlgorithmCreateFunc {
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* wrap0,
                                                 const btCollisionObjectWrapper* wrap1) override {
    void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Algorithm));
    const btCollisionObject* first = wrap0->getCollisionObject();
    const btCollisionObject* second = wrap1->getCollisionObject();
    return m_swapped ? new (memory) Algorithm(info, second, first, true)
                     : new (memory) Algorithm(info, first, second, false);
  }
};

}  // namespace

struct PlaneContact::Functions {
  Create convex_first, plane_first;
};

PlaneContact::PlaneContact(btCollisionDispatcher& dispatcher)
    : functions_(std::make_unique<Functions>()) {
  functions_->plane_first.m_swapped = true;
  for (int convex = 0; convex < CONCAVE_SHAPES_START_HERE; ++convex) {
    dispatcher.registerCollisionCreateFunc(convex, STATIC_PLANE_PROXYTYPE,
                                           &functions_->convex_first);
    dispatcher.registerCollisionCreateFunc(STATIC_PLANE_PROXYTYPE, convex,
                                           &functions_->plane_first);
  }
}

PlaneContact::~PlaneContact() = default;

}  // namespace cprsim
