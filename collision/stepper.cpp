// SPDX-License-Identifier: BSD-3-Clause
#include "collision/stepper.h"

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/convert.h"

namespace cprsim {
namespace {

// a contact normal that differs less from the span of others adds no direction
constexpr double kSameDirection = 1e-6;

/// Rate of the exponential decay in which a velocity loses the part `lost` per second.
double decay_rate(double lost) {
  return -std::log1p(-std::clamp(lost, 0.0, 1.0));
}

/// (1)
void fly(FreeBody& free, double dt) {
  RigidMotion motion = free.before;
  fly_centre(motion, free.acceleration, decay_rate(free.linear_decay), dt);
  if (free.twisted) {
    const RigidMotion bullet = free.motion();
    motion.X.R = bullet.X.R;
    motion.w = bullet.w;
  } else {
    fly_axes(motion, free.inertia, decay_rate(free.angular_decay), dt);
  }
  free.set_motion(motion);
}

/// (2)
void correct_slide(FreeBody& free, double dt) {
  RigidMotion motion = free.motion();
  Vec3 shift = (free.before.v - motion.v) * dt / 2;
  std::vector<Vec3> held;  // orthonormal
  for (Vec3 normal : free.normals) {
    for (const Vec3& axis : held)
      normal -= axis.dot(normal) * axis;
    if (normal.norm() < kSameDirection) continue;
    held.push_back(normal.normalized());
    shift -= held.back().dot(shift) * held.back();
  }
  motion.X.p += shift;
  free.set_motion(motion);
}

class Stepper : public btDiscreteDynamicsWorld {
 public:
  Stepper(const WorldParts& parts, std::vector<FreeBody>& bodies, bool friction)
      : btDiscreteDynamicsWorld(parts.dispatcher, parts.broadphase, parts.solver,
                                parts.configuration),
        bodies_(bodies),
        friction_(friction) {}

 protected:
  // the velocities of obstacles are set from outside, for the coming substep
  void saveKinematicState(btScalar) override {}

  void solveConstraints(btContactSolverInfo& info) override {
    apply_contact_rules(*getDispatcher(), friction_, info.m_timeStep);
    btDiscreteDynamicsWorld::solveConstraints(info);
  }

  void internalSingleStepSimulation(btScalar dt) override {
    for (FreeBody& free : bodies_) {
      free.before = free.motion();
      free.normals.clear();
    }
    btDiscreteDynamicsWorld::internalSingleStepSimulation(dt);
    collect_normals();
    for (FreeBody& free : bodies_)
      free.normals.empty() ? fly(free, dt) : correct_slide(free, dt);
  }

 private:
  /// Of contacts that carry force or whose penetration is being removed.
  void collect_normals() {
    for (int m = 0; m < getDispatcher()->getNumManifolds(); ++m) {
      const btPersistentManifold& manifold = *getDispatcher()->getManifoldByIndexInternal(m);
      for (int i = 0; i < manifold.getNumContacts(); ++i) {
        const btManifoldPoint& point = manifold.getContactPoint(i);
        if (point.getAppliedImpulse() <= 0 && point.getDistance() >= 0) continue;
        for (const btCollisionObject* object : {manifold.getBody0(), manifold.getBody1()})
          if (object->getUserIndex() >= 0)
            bodies_[static_cast<std::size_t>(object->getUserIndex())].normals.push_back(
                from_bullet(point.m_normalWorldOnB));
      }
    }
  }

  std::vector<FreeBody>& bodies_;
  bool friction_;
};

}  // namespace

std::unique_ptr<btDiscreteDynamicsWorld> make_stepper(const WorldParts& parts,
                                                      std::vector<FreeBody>& bodies,
                                                      bool friction) {
  auto world = std::make_unique<Stepper>(parts, bodies, friction);
  world->getDispatchInfo().m_deterministicOverlappingPairs = true;
  btContactSolverInfo& info = world->getSolverInfo();
  info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS;
  info.m_warmstartingFactor = 1;
  // with 50 iterations a pushed cube turns by 1e-4 rad, with 200 by 1e-15
  info.m_numIterations = 200;
  info.m_restitutionVelocityThreshold = 0;
  // every penetration, however shallow, is removed by shifting bodies, not by speeding them up
  info.m_splitImpulsePenetrationThreshold = std::numeric_limits<double>::max();
  return world;
}

}  // namespace cprsim
