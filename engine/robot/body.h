// SPDX-License-Identifier: BSD-3-Clause
// A rigid body of the Newton system: one or several links welded together. Newton-Euler about the
// centre of mass, world axes, with time already turned into algebra (engine/time/scheme.h).
#pragma once

#include <vector>

#include "engine/math/types.h"
#include "engine/time/scheme.h"

namespace cprsim {

class RigidBody {
 public:
  double mass = 0;
  Mat3 inertia = Mat3::Zero();      ///< about the centre of mass, body axes
  double gravity_mass = 0;          ///< of the links that feel gravity
  Vec3 gravity_arm = Vec3::Zero();  ///< their centre of mass from the body's, body axes
  std::vector<int> links;           ///< indices into Scene::bodies

  Mat3 R = Mat3::Identity();  ///< body axes = those of its first link
  Vec3 p = Vec3::Zero();      ///< centre of mass
  Vec3 omega = Vec3::Zero();  ///< body axes, at the current stage

  Pose pose() const { return {R, p}; }

  /// Inertial wrench (moment, force) that the surroundings must supply, and its derivative by (phi,
  /// dp).
  struct Inertial {
    Vec6 wrench = Vec6::Zero();
    Mat6 by_motion = Mat6::Zero();
  };

  Inertial inertial(const StageRates& rates);

  /// Angular velocity at the present rotation, body axes; d(omega) = R^T by_phi phi.
  struct Turning {
    Vec3 theta, theta_t, omega;
    Mat3 by_theta, by_phi;
  };

  Turning turning(const StageRates& rates) const;
  /// Weight under gravity g, and its derivative.
  Inertial weight(const Vec3& g) const;

  void fill_tracks(const StageRates& rates);

  void accept_tracks() { R_start_ = R; }

  /// @param velocity of the centre of mass; @param angular_velocity body axes.
  void start_tracks(const Vec3& velocity, const Vec3& angular_velocity);

  Vec3 velocity() const { return position.v; }

  double kinetic_energy() const;

  void visit(Archive& archive);

  Track position{Track::Kind::kLinear};
  Track rotation{Track::Kind::kRotation};

 private:
  Mat3 R_start_ = Mat3::Identity();  ///< at the start of the step
};

}  // namespace cprsim
