// SPDX-License-Identifier: BSD-3-Clause
// Rate of angular momentum of a rigid section, t = d/dt(R rhoJ omega), with its derivative by the
// world rotation increment. Time is already algebra (engine/time/scheme.h):
//   theta = log(R_start^T R),  theta_t = c_v theta + theta_h,  omega = J_r(theta) theta_t, (1)
//   omega_t = c_w omega + omega_h,   t = R (J omega_t + omega × J omega) (2)
#pragma once

#include "engine/section/small_vector.h"

namespace {  // NOLINT: as small_vector.h

inline V3 rotation_log(const M3& R) {
  // increments within a step are far below pi; acos-free: sin from the skew part, cos from the
  // trace
  const V3 s = {0.5 * (R.a[7] - R.a[5]), 0.5 * (R.a[2] - R.a[6]), 0.5 * (R.a[3] - R.a[1])};
  const double sine = sqrt(dot(s, s)), cosine = 0.5 * (R.a[0] + R.a[4] + R.a[8] - 1);
  const double angle = atan2(sine, cosine);
  return (sine > 1e-12 ? angle / sine : 1.0) * s;
}

inline M3 inverse(const M3& A) {
  const V3 r0 = {A.a[0], A.a[1], A.a[2]}, r1 = {A.a[3], A.a[4], A.a[5]},
           r2 = {A.a[6], A.a[7], A.a[8]};
  const V3 c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
  const double d = 1 / dot(r0, c0);
  return {
      {d * c0.x, d * c1.x, d * c2.x, d * c0.y, d * c1.y, d * c2.y, d * c0.z, d * c1.z, d * c2.z}};
}

/// Reads rhoJ, c_v, c_w, body_rates of a cell model and R, R_start, theta_h, omega_h of its stage;
/// fills theta, theta_t, omega, omega_t, torque and torque_phi (engine/rod/cell.h).
template <class Model, class Stage>
inline void evaluate_rotary(const Model& model, Stage& stage) {
  const M3 R = load_matrix(stage.R);
  const V3 theta = rotation_log(transpose(load_matrix(stage.R_start)) * R);
  const V3 theta_t = model.c_v * theta + load(stage.theta_h);
  const RotationCoefficients k = rotation_coefficients(dot(theta, theta));
  const M3 J_r = right_jacobian(theta, k);
  M3 omega_by_theta = model.c_v * identity();
  V3 omega = theta_t;
  if (model.body_rates) {
    omega = J_r * theta_t;
    omega_by_theta = model.c_v * J_r + right_jacobian_derivative(theta, theta_t, k);
  }
  const V3 omega_t = model.c_w * omega + load(stage.omega_h);
  // (2)
  const V3 H = scaled(model.rhoJ, omega);
  const V3 t = R * (scaled(model.rhoJ, omega_t) + cross(omega, H));
  M3 t_by_omega = hat(omega) * M3{{model.rhoJ[0], 0, 0, 0, model.rhoJ[1], 0, 0, 0, model.rhoJ[2]}} +
                  (-1.0) * hat(H);
  for (int i = 0; i < 3; ++i)
    t_by_omega.a[4 * i] += model.c_w * model.rhoJ[i];
  const M3 by_phi = R * (t_by_omega * (omega_by_theta * (inverse(J_r) * transpose(R))));
  store(stage.theta, theta);
  store(stage.theta_t, theta_t);
  store(stage.omega, omega);
  store(stage.omega_t, omega_t);
  store(stage.torque, t);
  store_matrix(stage.torque_phi, by_phi + (-1.0) * hat(t));
}

}  // namespace
