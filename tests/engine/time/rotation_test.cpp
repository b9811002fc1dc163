// SPDX-License-Identifier: BSD-3-Clause
// Schemes on a rotation: a free rigid body, R (J omega_t + omega × J omega) = 0.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "engine/math/so3.h"
#include "engine/robot/body.h"
#include "tests/engine/time/schemes.h"

namespace cprsim {
namespace {

RigidBody top(const Vec3& omega) {
  RigidBody body;
  body.mass = 1;
  body.inertia = Vec3(1, 2, 3).asDiagonal();
  body.R = exp_so3({0.3, -0.4, 0.5});
  body.start_tracks({0.1, 0.2, 0.3}, omega);
  return body;
}

/// Enough to see the order, few enough to stay clear of round-off.
int steps_for(SchemeKind kind) {
  if (kind == SchemeKind::kRadau5) return 12;
  return kind == SchemeKind::kEsdirk43 ? 60 : 160;
}

/// Newton on the rotation, with the tangent that the engine uses.
void solve_stage(RigidBody& body, const StageRates& rates) {
  for (int i = 0; i < 12; ++i) {
    const RigidBody::Inertial at = body.inertial(rates);
    const Vec6 d = -at.by_motion.lu().solve(at.wrench);
    body.R = orthonormalized(exp_so3(d.head<3>()) * body.R);
    body.p += d.tail<3>();
    if (d.norm() < 1e-13) return;
  }
  ADD_FAILURE() << "Newton on a free body did not converge";
}

RigidBody spun(SchemeKind kind, const Vec3& omega, double time, int steps) {
  RigidBody body = top(omega);
  Stepper stepper({kind, -0.4, 0.8});
  const std::vector<Track*> tracks{&body.position, &body.rotation};
  for (int n = 0; n < steps; ++n) {
    const int stages = stepper.begin_step(time / steps, tracks);
    for (int i = 0; i < stages; ++i) {
      const StageRates rates = stepper.begin_stage(i, tracks);
      solve_stage(body, rates);
      body.fill_tracks(rates);
      stepper.finish_stage(i, tracks);
    }
    stepper.accept(tracks);
    body.accept_tracks();
  }
  return body;
}

/// Euler's equations by the classical Runge-Kutta method in tiny steps, without the engine's
/// schemes.
struct Reference {
  Mat3 R;
  Vec3 omega;
};

Reference reference_top(const Vec3& omega0, double time) {
  const Vec3 J(1, 2, 3);
  const auto omega_t = [&](const Vec3& w) -> Vec3 {
    return -w.cross(J.cwiseProduct(w)).cwiseQuotient(J);
  };
  constexpr int kSteps = 4000;
  const double h = time / kSteps;
  Reference r{exp_so3({0.3, -0.4, 0.5}), omega0};
  for (int i = 0; i < kSteps; ++i) {
    const Mat3 R1 = r.R * hat(r.omega);
    const Vec3 w1 = omega_t(r.omega);
    const Mat3 R2 = (r.R + h / 2 * R1) * hat(r.omega + h / 2 * w1);
    const Vec3 w2 = omega_t(r.omega + h / 2 * w1);
    const Mat3 R3 = (r.R + h / 2 * R2) * hat(r.omega + h / 2 * w2);
    const Vec3 w3 = omega_t(r.omega + h / 2 * w2);
    const Mat3 R4 = (r.R + h * R3) * hat(r.omega + h * w3);
    const Vec3 w4 = omega_t(r.omega + h * w3);
    r.R += h / 6 * (R1 + 2 * R2 + 2 * R3 + R4);
    r.omega += h / 6 * (w1 + 2 * w2 + 2 * w3 + w4);
  }
  return r;
}

const Vec3 kTumble(0.6, 1.9, 0.8);  // near the unstable middle axis

TEST(FreeTop, SpinAboutAPrincipalAxisIsExact) {
  for (SchemeKind kind : kAllSchemes)
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 omega = 2.5 * Vec3::Unit(axis);
      const RigidBody body = spun(kind, omega, 3, 20);  // more than a turn
      const Mat3 R = exp_so3({0.3, -0.4, 0.5}) * exp_so3(3 * omega);
      // 20 steps, each solved to round-off
      EXPECT_LT((body.R - R).norm(), 2e-12) << to_string(kind) << ", axis " << axis;
      EXPECT_LT((body.omega - omega).norm(), 2e-12) << to_string(kind) << ", axis " << axis;
    }
}

TEST(FreeTop, ConvergesWithTheOrderOfItsScheme) {
  const Reference exact = reference_top(kTumble, 2);
  for (SchemeKind kind : kAllSchemes) {
    const auto error = [&](int steps) {
      const RigidBody body = spun(kind, kTumble, 2, steps);
      return std::hypot((body.R - exact.R).norm(), (body.omega - exact.omega).norm());
    };
    EXPECT_NEAR(std::log2(error(steps_for(kind)) / error(2 * steps_for(kind))), order_of(kind),
                0.12)
        << to_string(kind);
  }
}

TEST(FreeTop, EnergyAndMomentumConvergeLikewise) {
  const auto momentum = [](const RigidBody& b) -> Vec3 { return b.R * (b.inertia * b.omega); };
  const RigidBody start = top(kTumble);
  for (SchemeKind kind : kAllSchemes) {
    double energy_error[2], momentum_error[2];
    for (int k = 0; k < 2; ++k) {
      const RigidBody body = spun(kind, kTumble, 2, (1 + k) * steps_for(kind));
      energy_error[k] = std::abs(body.kinetic_energy() - start.kinetic_energy());
      momentum_error[k] = (momentum(body) - momentum(start)).norm();
    }
    // may fall faster than the trajectory's error, never slower
    EXPECT_GT(std::log2(energy_error[0] / energy_error[1]), order_of(kind) - 0.15)
        << to_string(kind);
    EXPECT_GT(std::log2(momentum_error[0] / momentum_error[1]), order_of(kind) - 0.15)
        << to_string(kind);
  }
}

TEST(FreeTop, CentreOfMassGoesStraight) {
  for (SchemeKind kind : kAllSchemes) {
    const RigidBody body = spun(kind, kTumble, 2, 40);
    EXPECT_LT((body.p - 2 * Vec3(0.1, 0.2, 0.3)).norm(), 1e-13) << to_string(kind);  // round-off
  }
}

}  // namespace
}  // namespace cprsim
