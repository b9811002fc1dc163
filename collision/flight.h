// SPDX-License-Identifier: BSD-3-Clause
// A rigid body in flight: constant acceleration a, no torque, velocities decaying at rates c and d.
//   (1) v' = a - c v:  v = v_0 e^(-ct) + a E,  p = p_0 + v_0 E + a (t - E)/c,  E = (1 - e^(-ct))/c
//   (2) L = L_0 e^(-dt),  R' = R hat(I^-1 R^T L): for τ = (1 - e^(-dt))/d the motion with L_0
// (1) is exact. (2) is integrated by the commutator-free method of order 4 of Celledoni, Marthinsen
// and Owren (Future Gener. Comput. Syst. 19, 2003), which keeps L exactly. Any consistent units.
#pragma once

#include "engine/math/types.h"

namespace cprsim {

/// Motion of the centre of mass and of the principal axes, world axes.
struct RigidMotion {
  Pose X;
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();
};

/// (1) over the time t.
void fly_centre(RigidMotion& motion, const Vec3& a, double c, double t);

/// (2) over the time t. @param inertia principal moments; with a zero among them w stays as it is.
void fly_axes(RigidMotion& motion, const Vec3& inertia, double d, double t);

}  // namespace cprsim
