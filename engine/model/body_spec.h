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
  // Compiled once, in scene.cpp: dozens of files make and copy one.
  BodySpec();
  BodySpec(const BodySpec&);
  BodySpec(BodySpec&&) noexcept;
  BodySpec& operator=(const BodySpec&);
  BodySpec& operator=(BodySpec&&) noexcept;
  ~BodySpec();

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

enum class JointKind {
  kFixed,
  kRevolute,
  kContinuous,
  kPrismatic,
  kBall,
  kUniversal,
  kScrew,
  kCylindrical,
  kPlanar
};

/// One freedom of a joint: its direction and what resists motion along it. Rotations in rad and N
/// m, translations in m and N.
struct AxisSpec {
  Vec3 axis = Vec3::UnitZ();  ///< unit, in the joint frame
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::optional<double> stop_stiffness;  ///< of the limits; absent: from the robot's scale
  double stop_dissipation = 1;           ///< of the limits, s/rad or s/m
  double effort_limit = std::numeric_limits<double>::infinity();
  double velocity_limit = std::numeric_limits<double>::infinity();
  double damping = 0, friction = 0;  ///< viscous and dry
  double spring_stiffness = 0, spring_reference = 0;

  bool limited() const {
    return lower > -std::numeric_limits<double>::infinity() ||
           upper < std::numeric_limits<double>::infinity();
  }
};

/// A rigid joint. At q = 0 the joint frames of parent and child coincide: X_WP X_PJ = X_WC X_CJ.
/// The base class is the first freedom; `second` and `third` count where the kind has them:
/// universal two rotations; cylindrical translation, rotation; planar two translations, rotation.
struct JointSpec : AxisSpec {
  // Compiled once, in scene.cpp: dozens of files make and copy one.
  JointSpec();
  JointSpec(const JointSpec&);
  JointSpec(JointSpec&&) noexcept;
  JointSpec& operator=(const JointSpec&);
  JointSpec& operator=(JointSpec&&) noexcept;
  ~JointSpec();

  std::string name;  ///< scoped
  Place place;
  JointKind kind = JointKind::kFixed;
  int parent = kWorld, child = kWorld;  ///< body indices
  Pose X_PJ, X_CJ;
  AxisSpec second, third;
  double screw_pitch = 0;  ///< m per turn, positive for a right-handed thread
};

/// Scalar coordinates of a kind; a ball has none, its attitude is not a chain of rotations.
inline int freedom_count(JointKind kind) {
  switch (kind) {
    case JointKind::kFixed:
    case JointKind::kBall:
      return 0;
    case JointKind::kUniversal:
    case JointKind::kCylindrical:
      return 2;
    case JointKind::kPlanar:
      return 3;
    default:
      return 1;
  }
}

/// Whether coordinate i is a length rather than an angle.
inline bool slides(JointKind kind, int i) {
  return kind == JointKind::kPrismatic || (kind == JointKind::kCylindrical && i == 0) ||
         (kind == JointKind::kPlanar && i < 2);
}

inline const AxisSpec& axis_of(const JointSpec& joint, int i) {
  return i == 0 ? static_cast<const AxisSpec&>(joint) : i == 1 ? joint.second : joint.third;
}

inline AxisSpec& axis_of(JointSpec& joint, int i) {
  return i == 0 ? static_cast<AxisSpec&>(joint) : i == 1 ? joint.second : joint.third;
}

}  // namespace cprsim
