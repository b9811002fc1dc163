// SPDX-License-Identifier: BSD-3-Clause
#include "collision/free_body.h"

#include <btBulletDynamicsCommon.h>

#include <Eigen/Eigenvalues>
#include <stdexcept>

#include "collision/convert.h"

namespace cprsim {
namespace {

/// Principal moments and axes; a matrix that is diagonal already keeps its axes.
void find_principal_axes(const Mat3& inertia, FreeBody& free) {
  free.inertia = kU * kU * inertia.diagonal();
  const Mat3 off = inertia - Mat3(inertia.diagonal().asDiagonal());
  if (off.cwiseAbs().maxCoeff() <= 1e-12 * inertia.diagonal().maxCoeff()) return;
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(inertia);
  free.inertia = kU * kU * axes.eigenvalues();
  free.X_BG.R = axes.eigenvectors();
  if (free.X_BG.R.determinant() < 0) free.X_BG.R.col(2) *= -1;
}

}  // namespace

FreeBody::FreeBody() = default;
FreeBody::FreeBody(FreeBody&&) noexcept = default;
FreeBody::~FreeBody() = default;

RigidMotion FreeBody::motion() const {
  return {from_bullet(body->getCenterOfMassTransform()), from_bullet(body->getLinearVelocity()),
          from_bullet(body->getAngularVelocity())};
}

void FreeBody::set_motion(const RigidMotion& motion) {
  body->setLinearVelocity(to_bullet(motion.v));
  body->setAngularVelocity(to_bullet(motion.w));
  body->setCenterOfMassTransform(to_bullet(motion.X));
}

Pose FreeBody::X_WB() const {
  return motion().X * X_BG.inverse();
}

void FreeBody::apply_loads(double t) {
  acceleration = gravity;
  twisted = false;
  for (const LoadSpec& load : loads) {
    const Pose X = X_WB();
    const double factor = load.has_profile ? load.profile.evaluate(t).value : 1;
    const Mat3 R = load.follower ? Mat3(X.R * load.at.X_BF.R * load.R_expressed) : load.R_expressed;
    const Vec3 arm = X * (kU * load.at.X_BF.p) - motion().X.p;
    const Vec3 force = kU * factor * (R * load.force);
    const Vec3 torque = kU * kU * factor * (R * load.torque) + arm.cross(force);
    body->applyCentralForce(to_bullet(force));
    body->applyTorque(to_bullet(torque));
    acceleration += force / mass;
    twisted = twisted || !torque.isZero(0);
  }
}

double FreeBody::kinetic_energy() const {
  const RigidMotion now = motion();
  const Vec3 w = now.X.R.transpose() * now.w;
  const double twice = mass * now.v.squaredNorm() + w.dot(inertia.cwiseProduct(w));
  return twice / 2 / (kU * kU);
}

double FreeBody::gravity_energy() const {
  return -mass * gravity.dot(motion().X.p) / (kU * kU);
}

FreeBody describe_free_body(const Scene& scene, int index) {
  const BodySpec& spec = scene.bodies.at(static_cast<std::size_t>(index));
  // negated so that a NaN is refused
  if (!(spec.mass > 0)) throw std::invalid_argument(spec.name + " moves freely but has no mass");
  FreeBody free;
  free.index = index;
  free.mass = spec.mass;
  free.X_BG.p = kU * spec.com;
  find_principal_axes(spec.inertia, free);
  if (spec.gravity && scene.effects.has(Effect::kGravity)) free.gravity = kU * scene.gravity;
  free.acceleration = free.gravity;
  free.linear_decay = spec.linear_decay;
  free.angular_decay = spec.angular_decay;
  for (const LoadSpec& load : scene.loads)
    if (load.rod < 0 && load.at.body == index) free.loads.push_back(load);
  free.contactor.free = true;
  if (scene.effects.has(Effect::kContact))
    for (const ColliderSpec& collider : spec.colliders)
      free.contactor.surfaces.push_back(collider.surface);
  return free;
}

RigidMotion initial_motion(const FreeBody& free, const BodySpec& spec) {
  const Pose X_WB = scaled(spec.X_WB, kU);
  RigidMotion motion;
  motion.X = X_WB * free.X_BG;
  motion.w = spec.angular_velocity;
  motion.v = kU * spec.linear_velocity + motion.w.cross(motion.X.p - X_WB.p);
  return motion;
}

}  // namespace cprsim
