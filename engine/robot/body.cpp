// SPDX-License-Identifier: BSD-3-Clause
// Rotation within a step (equations as in engine/section/rotary.h):
//   theta = log(R_start^T R), theta_t = c_v theta + theta_h, omega = J_r(theta) theta_t, omega_t =
//   c_w omega + omega_h m a = F,   R (J omega_t + omega × J omega) = M
#include "engine/robot/body.h"

#include "engine/math/so3.h"

namespace cprsim {

RigidBody::Turning RigidBody::turning(const StageRates& rates) const {
  Turning out;
  out.theta = log_so3(R_start_.transpose() * R);
  out.theta_t = rates.c_v * out.theta + rotation.x_h;
  const Mat3 J_r = right_jacobian(out.theta);
  out.by_theta = rates.c_v * Mat3::Identity();
  out.omega = out.theta_t;
  if (rates.body_rates) {
    out.omega = J_r * out.theta_t;
    out.by_theta = rates.c_v * J_r + right_jacobian_derivative(out.theta, out.theta_t);
  }
  out.by_phi = R * out.by_theta * right_jacobian_inverse(out.theta) * R.transpose();
  return out;
}

RigidBody::Inertial RigidBody::inertial(const StageRates& rates) {
  Inertial out;
  const Turning now = turning(rates);
  omega = now.omega;
  const Vec3 omega_t = rates.c_w * omega + rotation.v_h;
  const Vec3 H = inertia * omega;
  const Vec3 moment = R * (inertia * omega_t + omega.cross(H));
  const Mat3 by_omega = rates.c_w * inertia + hat(omega) * inertia - hat(H);
  const Mat3 by_phi =
      R * by_omega * now.by_theta * right_jacobian_inverse(now.theta) * R.transpose() - hat(moment);
  const Vec3 a = rates.c_w * (rates.c_v * p + position.x_h) + position.v_h;
  out.wrench << moment, mass * a;
  out.by_motion.topLeftCorner<3, 3>() = by_phi;
  out.by_motion.bottomRightCorner<3, 3>().diagonal().setConstant(mass * rates.c_v * rates.c_w);
  return out;
}

RigidBody::Inertial RigidBody::weight(const Vec3& g) const {
  Inertial out;
  const Vec3 arm = R * gravity_arm, F = gravity_mass * g;
  out.wrench << arm.cross(F), F;
  // d(arm × F) = (phi × arm) × F
  out.by_motion.topLeftCorner<3, 3>() = hat(F) * hat(arm);
  return out;
}

void RigidBody::fill_tracks(const StageRates& rates) {
  position.x = p;
  const Vec3 theta = log_so3(R_start_.transpose() * R);
  const Vec3 theta_t = rates.c_v * theta + rotation.x_h;
  omega = rates.body_rates ? Vec3(right_jacobian(theta) * theta_t) : theta_t;
  rotation.x = theta;
  rotation.v = omega;
}

void RigidBody::start_tracks(const Vec3& velocity, const Vec3& angular_velocity) {
  position.resize(3);
  rotation.resize(3);
  position.set_start(p, velocity);
  rotation.set_start(Vec3::Zero(), angular_velocity);
  omega = angular_velocity;
  R_start_ = R;
}

double RigidBody::kinetic_energy() const {
  return 0.5 * mass * position.v.squaredNorm() + 0.5 * omega.dot(inertia * omega);
}

void RigidBody::visit(Archive& archive) {
  archive(R);
  archive(p);
  archive(omega);
  archive(R_start_);
  position.visit(archive);
  rotation.visit(archive);
}

}  // namespace cprsim
