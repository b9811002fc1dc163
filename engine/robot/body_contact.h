// SPDX-License-Identifier: BSD-3-Clause
// A contact between two rigid bodies, or a body and what stands still: a point a of the one, or a
// ball of radius r about it, against a solid on the other. With x the point's place, d(x) its
// distance to the solid and n = dd/dx, body a gets the force f at y = x + l, l = -r n, the other
// body -f at the same place: what one loses the other gains, to round-off. The rows are (3) to (5)
// of engine/rod/contact.h with
//   u = v_a + w_a × (y - p_a) - v_b - w_b × (y - p_b)                                       (1)
//     or, without rates, by how much the two bodies' points at y moved apart since slip counts (2)
// and, since three points already bear a body that rests on more,
//   d - r + C n.f = 0,   stick: P (u / U + C (f - f_0) / L) = 0                             (3)
// C, so small that a body sinks by 2e-7 of its size under its own weight, says how they share it;
// f_0 is the force when the step began: nothing creeps. In the step in which two hard things with a
// coefficient of restitution e meet, with u_0 when it began, they part again:
//   n.u + e n.u_0 = 0  in the place of  d - r = 0                                           (4)
// A body's points are corners, and places that its motion moves along it: on the rim of a disc, on
// an edge, on an ellipsoid. They stay where they are on the body during a solve.
#pragma once

#include "engine/robot/contact_pair.h"

namespace cprsim {

/// A feature of one collider against the solid of another.
struct BodyProbe {
  enum class Kind { kPoint, kRim, kEdge, kEllipsoid };

  Kind kind = Kind::kPoint;
  int link = -1, other_link = -1;  ///< indices into Scene::bodies
  int body = -1, other = -1;       ///< into Robot::bodies; one may be -1, the ground
  Pose X_BC;                       ///< of the feature's collider in its body
  Vec3 a = Vec3::Zero();  ///< in the collider: point, centre of a rim about z, start of an edge,
                          ///< semi-axes of an ellipsoid
  Vec3 b = Vec3::Zero();  ///< end of an edge; a rim's radius in x
  double radius = 0;      ///< r
  Surface surface;        ///< of the other, in its body or the world
  double friction = 0, restitution = 0;
  double give = 0;       ///< C, m/N
  double size = 1;       ///< of the smaller of the two, m
  double thickness = 0;  ///< of the solid: infinite for a plane
};

struct BodyContact {
  std::size_t probe = 0;
  Vec3 at = Vec3::Zero();  ///< a, in its body
  RodContact law;          ///< grip, friction, lever and force are what counts of it
  double bounce = 0;       ///< -e n.u_0, m/s; 0: (3)
  double give = 0;         ///< C; less where it bounces
  bool fresh = true;       ///< came within this step
};

/// Contacts as a solve leaves them. @throws StateError for more than a robot can have
void visit(std::vector<BodyContact>& contacts, Archive& archive);

/// Rows with their derivatives by the motions (phi, dp) of both bodies and by f.
struct BodyContactRows {
  Vec3 value = Vec3::Zero();
  Mat3x6 by_body = Mat3x6::Zero(), by_other = Mat3x6::Zero();
  Mat3 by_force = Mat3::Zero();
  Distance at;  ///< of x from the solid
  Vec3 slip = Vec3::Zero();
  Vec3 x = Vec3::Zero(), y = Vec3::Zero();
};

/// @param other identity and at rest for the ground
BodyContactRows rows_between(const BodyProbe& probe, const BodyContact& contact,
                             const MovingBody& body, const MovingBody& other,
                             const ContactScale& scale);

}  // namespace cprsim
