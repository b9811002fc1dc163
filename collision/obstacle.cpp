// SPDX-License-Identifier: BSD-3-Clause
#include "collision/obstacle.h"

#include <btBulletDynamicsCommon.h>

#include "collision/convert.h"
#include "engine/math/so3.h"

namespace cprsim {
namespace {}  // namespace

Obstacle::Obstacle() = default;
Obstacle::Obstacle(Obstacle&&) noexcept = default;
Obstacle::~Obstacle() = default;

void Obstacle::aim(const BodyMotion& motion, double step) {
  const Pose end = scaled(motion.X_WB, kU) * X_BC;
  v = (end.p - start.p) / step;
  w = log_so3(end.R * start.R.transpose()) / step;
}

void Obstacle::trace_back(const BodyMotion& motion, double step) {
  const Pose end = scaled(motion.X_WB, kU) * X_BC;
  const Vec3 arm = end.p - kU * motion.X_WB.p;
  const Vec3 velocity = kU * motion.linear_velocity + motion.angular_velocity.cross(arm);
  start = {exp_so3(-step * motion.angular_velocity) * end.R, end.p - step * velocity};
}

void Obstacle::place(double since_start) {
  const Pose X{exp_so3(since_start * w) * start.R, start.p + since_start * v};
  body->setWorldTransform(to_bullet(X));
  body->setInterpolationWorldTransform(to_bullet(X));
  body->setLinearVelocity(to_bullet(v));
  body->setAngularVelocity(to_bullet(w));
}

Pose Obstacle::X_WC() const {
  return from_bullet(body->getWorldTransform());
}

Barrier Obstacle::barrier() const {
  Barrier barrier;
  const Pose X = X_WC();
  const btCollisionShape& shape = *body->getCollisionShape();
  if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE) {
    const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
    barrier.is_plane = true;
    barrier.normal = X.R * from_bullet(plane.getPlaneNormal());
    barrier.level = barrier.normal.dot(X.p);
    barrier.speed = v.norm();
    return barrier;
  }
  btVector3 low, high;
  shape.getAabb(to_bullet(X), low, high);
  barrier.low = from_bullet(low);
  barrier.high = from_bullet(high);
  barrier.speed = v.norm() + w.norm() * (barrier.high - barrier.low).norm();
  return barrier;
}

Obstacle make_obstacle(const BodySpec& body, int index, const ColliderSpec& collider,
                       btCollisionShape* shape) {
  Obstacle obstacle;
  obstacle.index = index;
  obstacle.X_BC = scaled(collider.X_BC, kU);
  obstacle.start = scaled(body.X_WB, kU) * obstacle.X_BC;
  obstacle.contactor.surfaces = {collider.surface};
  obstacle.body =
      std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, shape));
  obstacle.body->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  obstacle.body->setActivationState(DISABLE_DEACTIVATION);
  obstacle.place(0);
  return obstacle;
}

}  // namespace cprsim
