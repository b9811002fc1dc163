// SPDX-License-Identifier: BSD-3-Clause
// A contact whose other side moves by unknowns of the Newton system: a shape on a body, or another
// rod. Its rows are (3) to (5) of engine/rod/contact.h, with what the other side's motion adds:
//   body, at the rod's surface point y = x + l:  u = u_rod - v - omega × (y - p)           (1)
//     or, without rates, u = u_rod - (y - X_0 X^-1 y), X_0 being where slip counts from   (2)
//   the body gets the force -f at y, so that rod and body exchange momentum and moment of it
//   exactly. rod:  g = x_1 - x_2,  m = g - B (B^T B + eps)^-1 B^T g,  B = [x_1' x_2'],
//     n = sigma m / |m|,  d - r = sigma |m| - r_1 - r_2                                  (3)
// x_1, x_2 stay where they are on their rods during a solve and follow the nearest points between
// solves. There m = g, but its derivatives are those of two lines that slide freely along each
// other; near parallel rods eps takes from them the direction in which that would be far. At the
// end of a rod, which slides nowhere, its column of B is zero. sigma keeps the side on which the
// rods were: what has passed through is pushed back.
#pragma once

#include "engine/robot/body.h"
#include "engine/rod/contact.h"

namespace cprsim {

using Mat3x6 = Eigen::Matrix<double, 3, 6>;
using Mat3x12 = Eigen::Matrix<double, 3, 12>;

/// Motion of a body as contacts see it, about its centre of mass.
struct MovingBody {
  Pose X;  ///< of the body
  bool rates = false;
  Pose X_0;  ///< without rates
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();
  double v_by_p = 0;
  Mat3 w_by_phi = Mat3::Zero();
};

/// Velocity, or without rates the way (2), of the point of a body that is at y, with its
/// derivatives by y and by the body's (phi, dp) while y stays.
struct PointMotion {
  Vec3 v;
  Mat3 by_y, by_phi, by_p;

  PointMotion(const MovingBody& body, const Vec3& y);
};

MovingBody moving_body(const RigidBody& body, const StageRates& rates, const Pose& X_0);

/// Rows with their derivatives by the ends' (phi_0, p_0, phi_1, p_1), by the body's (phi, dp) or
/// the other rod's ends, and by f.
struct PairRows {
  Vec3 value = Vec3::Zero();
  Mat3x12 by_ends = Mat3x12::Zero(), by_other = Mat3x12::Zero();
  Mat3x6 by_body = Mat3x6::Zero();
  Mat3 by_force = Mat3::Zero();
  Distance at;  ///< of the centreline: from the solid, or from the other rod's surface
  Vec3 slip = Vec3::Zero();
};

/// What stands still, for rods whose forces are the robot's unknowns.
PairRows rows_with_world(const RodContact& contact, const Surface& surface, double radius,
                         const ContactEnds& ends, const ContactScale& scale);

/// @param surface with its frame on the body.
PairRows rows_with_body(const RodContact& contact, const Surface& surface, const MovingBody& body,
                        double radius, const ContactEnds& ends, const ContactScale& scale);

struct RodSide {
  ContactEnds ends;
  double radius = 0;
  bool at_end = false;  ///< of its rod
};

PairRows rows_with_rod(const RodContact& contact, const RodSide& own, const RodSide& other,
                       const ContactScale& scale);

/// (8), at nodes of both. @param arms of the rods, section axes
PairRows tie_rows(const Vec3& arm, const Vec3& other_arm, const ContactEnds& own,
                  const ContactEnds& other, const ContactScale& scale);

/// d x / d (phi_0, p_0, phi_1, p_1) of the centreline's point.
Mat3x12 point_by_ends(double xi, const ContactEnds& ends);

}  // namespace cprsim
