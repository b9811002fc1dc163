// SPDX-License-Identifier: BSD-3-Clause
// A collider of a body that somebody else moves, in world units. Over a step it goes from pose to
// pose with constant velocities, which the contact solver sees; C are the collider's axes.
#pragma once

#include <memory>

#include "collision/contact_rules.h"
#include "collision/pace.h"
#include "engine/model/body_spec.h"
#include "engine/robot/free_bodies.h"

class btCollisionShape;
class btRigidBody;

namespace cprsim {

struct Obstacle {
  Obstacle();
  Obstacle(Obstacle&&) noexcept;
  ~Obstacle();

  int index = -1;  ///< of its body in Scene::bodies
  Pose X_BC;
  Contactor contactor;
  std::unique_ptr<btRigidBody> body;
  Pose start;  ///< X_WC at the beginning of the step
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();

  /// Sets velocities that lead from `start` to the pose of `motion` in `step`.
  void aim(const BodyMotion& motion, double step);

  /// Sets `start` to where `motion` came from, `step` earlier.
  void trace_back(const BodyMotion& motion, double step);

  void place(double since_start);
  Pose X_WC() const;
  Barrier barrier() const;
};

/// @param shape outlives the obstacle.
Obstacle make_obstacle(const BodySpec& body, int index, const ColliderSpec& collider,
                       btCollisionShape* shape);

}  // namespace cprsim
