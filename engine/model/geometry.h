// SPDX-License-Identifier: BSD-3-Clause
// Shapes and looks of rigid bodies: what is drawn and what collides.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/place.h"

namespace cprsim {

/// A triangle mesh in the coordinates of the shape that uses it (metres, scale already applied).
struct MeshSpec {
  std::string source;                              ///< resolved path, for messages
  std::vector<Eigen::Vector3f> positions;          ///< V vertices
  std::vector<Eigen::Vector3f> normals;            ///< V unit normals
  std::vector<Eigen::Vector3f> colors;             ///< V diffuse colours in [0,1], or empty
  std::vector<std::array<unsigned, 3>> triangles;  ///< counter-clockwise seen from outside
};

enum class ShapeKind {
  kEmpty,
  kBox,
  kSphere,
  kCylinder,
  kCapsule,
  kCone,
  kEllipsoid,
  kTube,
  kPlane,
  kMesh
};

/// One geometric primitive in its own frame, centred; axes of cylinder, capsule, cone, tube along
/// z. size means: box edge lengths; sphere (r,_,_); cylinder, capsule, cone (r, length, _), a
/// capsule's length without its caps, a cone's apex at +length/2; ellipsoid semi-axes; tube
/// (outer r, length, inner r); plane (x,y extent, _).
struct ShapeSpec {
  ShapeKind kind = ShapeKind::kEmpty;
  Vec3 size = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< plane only
  int mesh = -1;                ///< index into Scene::meshes
};

/// Linear RGB in [0,1] as in SDF's material.
struct Look {
  Vec3 ambient{0.4, 0.4, 0.4};
  Vec3 diffuse{0.7, 0.7, 0.7};
  Vec3 specular{0.2, 0.2, 0.2};
  Vec3 emissive{0, 0, 0};
  double shininess = 32;
  double opacity = 1;  ///< 1 - SDF transparency, times the diffuse alpha
  bool set = false;    ///< the scene gave a material
};

struct VisualSpec {
  std::string name;
  Place place;
  Pose X_BV;  ///< in the link frame
  ShapeSpec shape;
  Look look;
  bool cast_shadows = true;
};

/// Surface properties of a collider (SDF names).
struct SurfaceSpec {
  double friction = 1.0;
  double restitution = 0.0;
  double rolling_friction = 0.0;
  double stiffness = 0.0;  ///< kp of rods' contacts, N/m a point; 0: rigid
  double damping = 0.0;    ///< kd, N s/m a point
  unsigned collide_bitmask = 0xffff;
  unsigned category_bitmask = 0xffff;
};

struct ColliderSpec {
  std::string name;
  Place place;
  Pose X_BC;  ///< in the link frame
  ShapeSpec shape;
  SurfaceSpec surface;
};

}  // namespace cprsim
