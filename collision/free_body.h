// SPDX-License-Identifier: BSD-3-Clause
// A rigid body that Bullet integrates, in world units (mm, kg, s). Its axes G are the principal
// axes at the centre of mass.
#pragma once

#include <memory>
#include <vector>

#include "collision/contact_rules.h"
#include "collision/flight.h"
#include "engine/model/scene.h"

class btRigidBody;

namespace cprsim {

struct FreeBody {
  FreeBody();
  FreeBody(FreeBody&&) noexcept;
  ~FreeBody();

  int index = -1;  ///< in Scene::bodies
  Pose X_BG;
  double mass = 0;
  Vec3 inertia = Vec3::Zero();
  Vec3 gravity = Vec3::Zero();
  double linear_decay = 0, angular_decay = 0;  ///< of SDF: lost per second
  double radius = 0;  ///< of the smallest ball about G around the colliders
  std::vector<LoadSpec> loads;
  Contactor contactor;  ///< without surfaces: touches nothing
  std::unique_ptr<btRigidBody> body;

  // of the current substep
  RigidMotion before;
  Vec3 acceleration = Vec3::Zero();  ///< of gravity and loads
  bool twisted = false;              ///< a load has a torque about G
  std::vector<Vec3> normals;         ///< of the contacts that hold it

  RigidMotion motion() const;
  void set_motion(const RigidMotion& motion);
  Pose X_WB() const;

  /// Hands the loads at time t to Bullet and sets `acceleration` and `twisted`.
  void apply_loads(double t);

  double kinetic_energy() const;  ///< J
  double gravity_energy() const;  ///< J
};

/// The body without its Bullet part. @throws std::invalid_argument if it has no mass.
FreeBody describe_free_body(const Scene& scene, int index);

/// Motion of G at t = 0.
RigidMotion initial_motion(const FreeBody& free, const BodySpec& spec);

}  // namespace cprsim
