// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/body.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/engine/robot/sample_scenes.h"
#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

/// Somewhere within a step that began at R_start, with histories of size 1.
RigidBody sample_rigid_body(double angle) {
  Numbers numbers(21);
  RigidBody body;
  body.mass = 1.7;
  const Mat3 A = exp_so3(numbers.vec3());
  body.inertia = A * Vec3(0.4, 0.7, 0.9).asDiagonal() * A.transpose();
  body.gravity_mass = 1.2;
  body.gravity_arm = 0.3 * numbers.vec3();
  body.R = exp_so3(numbers.vec3());
  body.start_tracks(numbers.vec3(), numbers.vec3());
  for (VecX* history :
       {&body.position.x_h, &body.position.v_h, &body.rotation.x_h, &body.rotation.v_h})
    *history = numbers.vec3();
  body.R = body.R * exp_so3(angle * numbers.vec3().normalized());
  body.p = numbers.vec3();
  return body;
}

RigidBody moved(RigidBody body, const VecX& d) {
  body.R = exp_so3(d.head<3>()) * body.R;
  body.p += d.tail<3>();
  return body;
}

TEST(RigidBody, InertialTangentIsTheDerivative) {
  for (bool body_rates : {false, true})
    for (double angle : {0.0, 1e-8, 0.6, 2.5}) {
      RigidBody body = sample_rigid_body(angle);
      const StageRates rates{3, 2, body_rates};
      const auto f = [&](RigidBody b) -> VecX { return b.inertial(rates).wrench; };
      // truncation (1e-3)^4 times fifth derivatives that grow near pi
      EXPECT_TRUE(jacobians_agree(body.inertial(rates).by_motion,
                                  difference_jacobian(f, body, 6, moved), 1e-9, 1e-9))
          << body_rates << ", angle " << angle;
    }
}

TEST(RigidBody, WeightTangentIsTheDerivative) {
  const RigidBody body = sample_rigid_body(0.5);
  const Vec3 g(0.3, -0.5, -9.7);
  const auto f = [&](const RigidBody& b) -> VecX { return b.weight(g).wrench; };
  EXPECT_TRUE(
      jacobians_agree(body.weight(g).by_motion, difference_jacobian(f, body, 6, moved), 1e-10));
}

TEST(RigidBody, WeightActsAtTheCentreOfWhatHasWeight) {
  const RigidBody body = sample_rigid_body(0.5);
  const Vec3 g(0, 0, -10);
  const Vec6 w = body.weight(g).wrench;
  EXPECT_LT((w.tail<3>() - 1.2 * g).norm(), 1e-14);  // round-off
  EXPECT_LT((w.head<3>() - (body.R * body.gravity_arm).cross(1.2 * g)).norm(), 1e-14);
}

TEST(RigidBody, KineticEnergyIsThatOfMassAndInertia) {
  RigidBody body = sample_rigid_body(0);
  const Vec3 v(1, -2, 0.5), w(0.3, 0.2, -0.4);
  body.start_tracks(v, w);
  EXPECT_NEAR(body.kinetic_energy(), 0.5 * 1.7 * v.squaredNorm() + 0.5 * w.dot(body.inertia * w),
              1e-15);
}

}  // namespace
}  // namespace cprsim
