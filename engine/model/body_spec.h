// SPDX-License-Identifier: BSD-3-Clause
// Rigid bodies (SDF links) and the joints between them.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/geometry.h"
#include "engine/model/place.h"

namespace cprsim {

constexpr int kWorld = -1;  ///< body index that means the world

/// A frame fixed to a body: X_BF in the body's link frame, or in the world for kWorld.
struct FrameRef {
  int body = kWorld;
  Pose X_BF;
};

struct BodySpec {
  std::string name;  ///< scoped, e.g. robot::platform
  Place place;
  Pose X_WB;               ///< link frame at t = 0
  bool is_static = false;  ///< of a static model: never moves
  bool gravity = true;
  double mass = 0;                       ///< kg; 0 for a static body without <inertial>
  Vec3 com = Vec3::Zero();               ///< centre of mass in the link frame
  Mat3 inertia = Mat3::Zero();           ///< about the centre of mass, link axes, kg m²
  Vec3 linear_velocity = Vec3::Zero();   ///< of the link origin at t = 0, world axes
  Vec3 angular_velocity = Vec3::Zero();  ///< at t = 0, world axes
  bool velocity_given = false;
  double linear_decay = 0, angular_decay = 0;  ///< SDF velocity_decay
  std::vector<VisualSpec> visuals;
  std::vector<ColliderSpec> colliders;
};

enum class JointKind { kFixed, kRevolute, kContinuous, kPrismatic, kBall, kUniversal, kScrew };

/// A rigid joint. At q = 0 the joint frames of parent and child coincide: X_WP X_PJ = X_WC X_CJ.
struct JointSpec {
  std::string name;  ///< scoped
  Place place;
  JointKind kind = JointKind::kFixed;
  int parent = kWorld, child = kWorld;  ///< body indices
  Pose X_PJ, X_CJ;
  Vec3 axis = Vec3::UnitZ();   ///< unit, in the joint frame
  Vec3 axis2 = Vec3::UnitZ();  ///< universal only
  double screw_pitch = 0;      ///< m per turn
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double effort_limit = std::numeric_limits<double>::infinity();
  double velocity_limit = std::numeric_limits<double>::infinity();
  double damping = 0, friction = 0;  ///< viscous and dry
  double spring_stiffness = 0, spring_reference = 0;
};

}  // namespace cprsim
