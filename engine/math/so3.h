// SPDX-License-Identifier: BSD-3-Clause
// Rotations. exp and log of SO(3), and the right Jacobian J_r that turns the rate of a rotation
// vector into a body angular velocity:
//   R = exp(theta^),   omega = J_r(theta) theta_t, (1) J_r = I - A theta^ + B theta^^2,  A = (1 -
//   cos|theta|)/|theta|²,  B = (|theta| - sin|theta|)/|theta|³ (2)
// Source: Iserles, Munthe-Kaas, Nørsett, Zanna, "Lie-group methods", Acta Numerica 2000, eq.
// (B.10). Below |theta| = 0.5 the coefficients come from their Taylor series.
#pragma once

#include "engine/math/types.h"

namespace cprsim {

/// The matrix of the cross product: hat(a) b = a × b.
Mat3 hat(const Vec3& a);

/// Rotation by the vector theta (rad).
Mat3 exp_so3(const Vec3& theta);

/// Rotation vector of R, |theta| <= pi; near pi the axis is taken from the symmetric part.
Vec3 log_so3(const Mat3& R);

/// (2).
Mat3 right_jacobian(const Vec3& theta);

/// Inverse of (2); defined for |theta| < 2 pi.
Mat3 right_jacobian_inverse(const Vec3& theta);

/// d(J_r(theta) w)/dtheta for constant w.
Mat3 right_jacobian_derivative(const Vec3& theta, const Vec3& w);

/// The shortest turn that takes the direction `from` to the direction `to`; half a turn about some
/// axis across where they are opposite. Neither needs unit length.
Mat3 rotation_between(const Vec3& from, const Vec3& to);

/// The rotation matrix nearest to one that has drifted by round-off.
Mat3 orthonormalized(const Mat3& R);

}  // namespace cprsim
