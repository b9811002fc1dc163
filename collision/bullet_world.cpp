// SPDX-License-Identifier: BSD-3-Clause
#include "collision/bullet_world.h"

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <limits>

#include "collision/contact_rules.h"
#include "collision/convert.h"
#include "collision/free_body.h"
#include "collision/obstacle.h"
#include "collision/pace.h"
#include "collision/plane_contact.h"
#include "collision/shapes.h"
#include "collision/stepper.h"

// the single precision libraries miss a third of the contacts at the size of our bodies
static_assert(sizeof(btScalar) == 8, "needs Bullet in double precision");

namespace cprsim {
namespace {

constexpr double kNotice = 0.02;  // Bullet's: distance at which contacts are found, over the size

/// Only pairs that may touch reach the narrow phase.
struct PairFilter : btOverlapFilterCallback {
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    const auto contactor = [](btBroadphaseProxy* proxy) -> const Contactor& {
      const auto* object = static_cast<const btCollisionObject*>(proxy->m_clientObject);
      return *static_cast<const Contactor*>(object->getUserPointer());
    };
    return may_touch(contactor(a), contactor(b));
  }
};

class BulletWorld : public FreeBodies {
 public:
  BulletWorld(const Scene& scene, const std::vector<int>& free_bodies);
  ~BulletWorld() override;

  void advance(double step, const std::vector<BodyMotion>& others) override;
  void read(std::vector<BodyMotion>& all) const override;
  ContactSample contacts() const override;
  double kinetic_energy() const override;
  double gravity_energy() const override;

 private:
  void add_free_body(const BodySpec& spec, FreeBody& free);
  void add_obstacles(const Scene& scene);
  int count_substeps(double step) const;
  LinkContact link_contact(const btPersistentManifold& manifold, const btManifoldPoint& point,
                           double distance) const;

  Shapes shapes_;
  btDefaultCollisionConfiguration configuration_;
  mutable btCollisionDispatcher dispatcher_;  // its manifolds cannot be read through const
  PlaneContact plane_contact_;
  PairFilter filter_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  std::vector<FreeBody> bodies_;
  std::vector<Obstacle> obstacles_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  double notice_ = std::numeric_limits<double>::infinity();  // of the smallest shape
  double time_ = 0, substep_ = 0;
};

BulletWorld::BulletWorld(const Scene& scene, const std::vector<int>& free_bodies)
    : shapes_(scene.meshes), dispatcher_(&configuration_), plane_contact_(dispatcher_) {
  configuration_.setConvexConvexMultipointIterations(3, 3);
  broadphase_.getOverlappingPairCache()->setOverlapFilterCallback(&filter_);
  for (int index : free_bodies)
    bodies_.push_back(describe_free_body(scene, index));
  world_ = make_stepper({&dispatcher_, &broadphase_, &solver_, &configuration_}, bodies_,
                        scene.effects.has(Effect::kFriction));
  for (FreeBody& free : bodies_)
    add_free_body(scene.bodies[static_cast<std::size_t>(free.index)], free);
  if (scene.effects.has(Effect::kContact)) add_obstacles(scene);
}

BulletWorld::~BulletWorld() {
  for (Obstacle& obstacle : obstacles_)
    world_->removeRigidBody(obstacle.body.get());
  for (FreeBody& free : bodies_)
    world_->removeRigidBody(free.body.get());
}

void BulletWorld::add_free_body(const BodySpec& spec, FreeBody& free) {
  const bool touches = !free.contactor.surfaces.empty();
  btCollisionShape* shape =
      touches ? shapes_.for_free_body(spec, scaled(free.X_BG, 1 / kU)) : shapes_.empty();
  free.body = std::make_unique<btRigidBody>(
      btRigidBody::btRigidBodyConstructionInfo(free.mass, nullptr, shape, to_bullet(free.inertia)));
  btRigidBody& body = *free.body;
  body.setActivationState(DISABLE_DEACTIVATION);
  body.setFlags(BT_DISABLE_WORLD_GRAVITY | BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY);
  body.setDamping(free.linear_decay, free.angular_decay);
  body.setGravity(to_bullet(free.gravity));
  body.setUserPointer(&free.contactor);
  body.setUserIndex(static_cast<int>(&free - bodies_.data()));
  body.setUserIndex2(free.index);
  free.set_motion(initial_motion(free, spec));
  world_->addRigidBody(&body);
  if (!touches) return;

  btVector3 centre;
  btScalar radius = 0;
  shape->getBoundingSphere(centre, radius);
  free.radius = radius + centre.length();
  notice_ = std::min(notice_, shape->getContactBreakingThreshold(kNotice));
}

void BulletWorld::add_obstacles(const Scene& scene) {
  const auto is_free = [&](int index) {
    return std::any_of(bodies_.begin(), bodies_.end(),
                       [&](const FreeBody& free) { return free.index == index; });
  };
  int index = -1;
  for (const BodySpec& body : scene.bodies) {
    if (is_free(++index)) continue;
    for (const ColliderSpec& collider : body.colliders) {
      if (collider.shape.kind == ShapeKind::kEmpty) continue;
      btCollisionShape* shape = shapes_.for_obstacle(collider.shape);
      obstacles_.push_back(make_obstacle(body, index, collider, shape));
      if (collider.shape.kind != ShapeKind::kPlane)
        notice_ = std::min(notice_, shape->getContactBreakingThreshold(kNotice));
    }
  }
  // only now are the addresses final that Bullet keeps
  for (Obstacle& obstacle : obstacles_) {
    obstacle.body->setUserPointer(&obstacle.contactor);
    obstacle.body->setUserIndex2(obstacle.index);
    world_->addRigidBody(obstacle.body.get());
  }
}

int BulletWorld::count_substeps(double step) const {
  std::vector<Mover> movers;
  for (const FreeBody& free : bodies_) {
    const RigidMotion motion = free.motion();
    movers.push_back({motion.X.p, free.radius, motion.v.norm(), motion.w.norm(),
                      free.acceleration.norm(), !free.contactor.surfaces.empty()});
  }
  std::vector<Barrier> barriers;
  for (const Obstacle& obstacle : obstacles_)
    barriers.push_back(obstacle.barrier());
  return cprsim::count_substeps(step, movers, barriers, notice_);
}

void BulletWorld::advance(double step, const std::vector<BodyMotion>& others) {
  if (step <= 0) return;

  // obstacles set out from where they were; at first, from where their velocity says
  for (Obstacle& obstacle : obstacles_) {
    const BodyMotion& end = others.at(static_cast<std::size_t>(obstacle.index));
    if (time_ == 0) obstacle.trace_back(end, step);
    obstacle.aim(end, step);
  }

  const int count = count_substeps(step);
  const double dt = step / count;
  substep_ = dt;
  for (int i = 0; i < count; ++i) {
    for (Obstacle& obstacle : obstacles_)
      obstacle.place(i * dt);
    for (FreeBody& free : bodies_)
      free.apply_loads(time_ + (i + 0.5) * dt);
    world_->stepSimulation(dt, 0);
  }

  for (Obstacle& obstacle : obstacles_) {
    obstacle.place(step);
    obstacle.start = obstacle.X_WC();
  }
  time_ += step;
}

void BulletWorld::read(std::vector<BodyMotion>& all) const {
  for (const FreeBody& free : bodies_) {
    const RigidMotion motion = free.motion();
    const Pose X_WB = free.X_WB();
    BodyMotion& out = all.at(static_cast<std::size_t>(free.index));
    out.X_WB = scaled(X_WB, 1 / kU);
    out.angular_velocity = motion.w;
    out.linear_velocity = (motion.v + motion.w.cross(X_WB.p - motion.X.p)) / kU;
  }
}

/// A point as the last substep has solved it. Forces are impulses over its length.
LinkContact BulletWorld::link_contact(const btPersistentManifold& manifold,
                                      const btManifoldPoint& point, double distance) const {
  const btRigidBody& a = *btRigidBody::upcast(manifold.getBody0());
  const btRigidBody& b = *btRigidBody::upcast(manifold.getBody1());
  const auto metres = [](const btVector3& v) { return Vec3(Vec3(v.x(), v.y(), v.z()) / kU); };
  const btVector3 at = a.getWorldTransform() * point.m_localPointA;
  LinkContact out;
  out.link = a.getUserIndex2();
  out.other = b.getUserIndex2();
  out.position = metres(at);
  out.normal = kU * metres(point.m_normalWorldOnB);
  out.gap = distance;
  const auto velocity = [&](const btRigidBody& body) {
    return body.getVelocityInLocalPoint(at - body.getWorldTransform().getOrigin());
  };
  const Vec3 u = metres(velocity(a) - velocity(b));
  out.slip = u - out.normal.dot(u) * out.normal;
  if (substep_ > 0)
    out.force = metres(point.getAppliedImpulse() * point.m_normalWorldOnB +
                       point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                       point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2) /
                substep_;
  return out;
}

ContactSample BulletWorld::contacts() const {
  ContactSample sample;
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      // the points were found before the substep moved the bodies
      const btVector3 a = manifold.getBody0()->getWorldTransform() * point.m_localPointA;
      const btVector3 b = manifold.getBody1()->getWorldTransform() * point.m_localPointB;
      const double distance = (a - b).dot(point.m_normalWorldOnB) / kU;
      if (point.getAppliedImpulse() <= 0 && distance > 0) continue;
      ++sample.count;
      sample.penetration = std::max(sample.penetration, -distance);
      sample.links.push_back(link_contact(manifold, point, distance));
    }
  }
  return sample;
}

double BulletWorld::kinetic_energy() const {
  double energy = 0;
  for (const FreeBody& free : bodies_)
    energy += free.kinetic_energy();
  return energy;
}

double BulletWorld::gravity_energy() const {
  double energy = 0;
  for (const FreeBody& free : bodies_)
    energy += free.gravity_energy();
  return energy;
}

}  // namespace

std::unique_ptr<FreeBodies> make_bullet_world(const Scene& scene,
                                              const std::vector<int>& free_bodies) {
  return std::make_unique<BulletWorld>(scene, free_bodies);
}

}  // namespace cprsim
