// SPDX-License-Identifier: BSD-3-Clause
// Small scenes of rigid bodies, and a world that runs them.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "collision/bullet_world.h"

namespace cprsim {

inline ShapeSpec shape(ShapeKind kind, const Vec3& size) {
  ShapeSpec spec;
  spec.kind = kind;
  spec.size = size;
  return spec;
}

inline ColliderSpec collider(const ShapeSpec& spec, const Pose& X_BC = {}) {
  ColliderSpec result;
  result.shape = spec;
  result.X_BC = X_BC;
  return result;
}

/// A body of 0.1 kg with one collider; its inertia is that of a ball of 1 cm or as given.
inline BodySpec loose_body(const ShapeSpec& spec, const Vec3& position,
                           const Vec3& inertia = Vec3::Constant(4e-6)) {
  BodySpec body;
  body.name = "loose";
  body.mass = 0.1;
  body.inertia = inertia.asDiagonal();
  body.X_WB.p = position;
  body.colliders = {collider(spec)};
  return body;
}

/// A cube of edge 2 cm with the inertia of a homogeneous one.
inline BodySpec cube(const Vec3& position) {
  return loose_body(shape(ShapeKind::kBox, Vec3::Constant(0.02)), position,
                    Vec3::Constant(0.1 * 0.02 * 0.02 / 6));
}

inline BodySpec ball(double radius, const Vec3& position) {
  return loose_body(shape(ShapeKind::kSphere, Vec3(radius, 0, 0)), position,
                    Vec3::Constant(0.4 * 0.1 * radius * radius));
}

inline BodySpec ground(const Vec3& normal = Vec3::UnitZ()) {
  BodySpec body;
  body.name = "ground";
  body.is_static = true;
  ShapeSpec plane = shape(ShapeKind::kPlane, Vec3(1, 1, 0));
  plane.normal = normal;
  body.colliders = {collider(plane)};
  return body;
}

/// A scene with gravity, contact and friction.
inline Scene scene_of(std::vector<BodySpec> bodies) {
  Scene scene;
  scene.bodies = std::move(bodies);
  for (Effect effect : {Effect::kGravity, Effect::kContact, Effect::kFriction})
    scene.effects.set(effect, true);
  return scene;
}

/// The free bodies of a scene; all others stay where they are unless `motions` is changed.
struct World {
  std::unique_ptr<FreeBodies> free;
  std::vector<BodyMotion> motions;

  explicit World(const Scene& scene)
      : free(make_bullet_world(scene, find_free_bodies(scene))), motions(scene.bodies.size()) {
    for (std::size_t k = 0; k < motions.size(); ++k)
      motions[k].X_WB = scene.bodies[k].X_WB;
    free->read(motions);
  }

  void step(double dt) {
    free->advance(dt, motions);
    free->read(motions);
  }

  void run(double duration, double dt) {
    for (long i = 0, count = std::lround(duration / dt); i < count; ++i)
      step(dt);
  }

  const BodyMotion& operator[](std::size_t body) const { return motions[body]; }

  double energy() const { return free->kinetic_energy() + free->gravity_energy(); }
};

}  // namespace cprsim
