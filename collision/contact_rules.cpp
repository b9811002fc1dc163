// SPDX-License-Identifier: BSD-3-Clause
#include "collision/contact_rules.h"

#include <btBulletDynamicsCommon.h>

#include <algorithm>

#include "collision/convert.h"
#include "engine/model/flight.h"

namespace cprsim {
namespace {

const SurfaceSpec& surface_of(const btCollisionObject& object, int child) {
  const auto& contactor = *static_cast<const Contactor*>(object.getUserPointer());
  const auto& all = contactor.surfaces;
  // on an obstacle the index counts triangles, but then there is one surface
  return all.size() == 1 ? all[0] : all.at(static_cast<std::size_t>(child));
}

/// (1) as the coefficient that makes Bullet, which does not count gravity among v_n⁻, give v_n⁺.
void prepare_bounce(btManifoldPoint& point, const btRigidBody& a, const btRigidBody& b, double e,
                    double dt) {
  const btVector3& n = point.m_normalWorldOnB;
  const btVector3 arm_a = point.getPositionWorldOnA() - a.getCenterOfMassPosition();
  const btVector3 arm_b = point.getPositionWorldOnB() - b.getCenterOfMassPosition();
  const double v = n.dot(a.getVelocityInLocalPoint(arm_a) - b.getVelocityInLocalPoint(arm_b));
  const double acceleration = n.dot(a.getGravity() - b.getGravity());
  const double gap = point.getDistance();
  point.m_combinedRestitution = 0;
  const bool closes = v < 0 && gap + (v + acceleration * dt) * dt < 0;
  if (!closes) return;
  const double effective = e + acceleration * dt / -v;
  if (effective <= 0) return;
  point.m_combinedRestitution = effective;
  if (gap > 0) point.setDistance(0);
}

void apply(btManifoldPoint& point, const SurfaceSpec& a, const SurfaceSpec& b, bool friction) {
  point.m_combinedFriction = friction ? a.friction * b.friction : 0;
  // a length: the arm of the normal force about the rolling axis
  point.m_combinedRollingFriction =
      friction
          ? kUnitsPerMetre * (a.rolling_friction * b.friction + b.rolling_friction * a.friction)
          : 0;
  point.m_combinedSpinningFriction = 0;
}

}  // namespace

bool may_touch(const Contactor& a, const Contactor& b) {
  if (!a.free && !b.free) return false;
  return std::any_of(a.surfaces.begin(), a.surfaces.end(), [&](const SurfaceSpec& of_a) {
    return std::any_of(b.surfaces.begin(), b.surfaces.end(),
                       [&](const SurfaceSpec& of_b) { return may_touch(of_a, of_b); });
  });
}

void apply_contact_rules(btDispatcher& dispatcher, bool friction, double dt) {
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
    btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
    const btRigidBody& a = *btRigidBody::upcast(manifold.getBody0());
    const btRigidBody& b = *btRigidBody::upcast(manifold.getBody1());
    for (int i = manifold.getNumContacts() - 1; i >= 0; --i) {
      btManifoldPoint& point = manifold.getContactPoint(i);
      const SurfaceSpec& of_a = surface_of(a, point.m_index0);
      const SurfaceSpec& of_b = surface_of(b, point.m_index1);
      if (!may_touch(of_a, of_b)) {
        manifold.removeContactPoint(i);
        continue;
      }
      apply(point, of_a, of_b, friction);
      prepare_bounce(point, a, b, of_a.restitution * of_b.restitution, dt);
    }
  }
}

}  // namespace cprsim
