// SPDX-License-Identifier: BSD-3-Clause
// Rows of contacts between bodies, against differences.
#include "engine/robot/body_contact.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "engine/math/so3.h"

namespace cprsim {
namespace {

RigidBody body_at(const Vec3& p, const Vec3& turn) {
  RigidBody body;
  body.mass = 1;
  body.p = p;
  body.R = exp_so3(turn);
  body.start_tracks({0.3, -0.2, 0.1}, {0.5, 0.4, -0.6});
  body.position.x_h = Vec3(0.1, 0.2, -0.4);
  body.rotation.x_h = Vec3(-0.3, 0.1, 0.2);
  return body;
}

struct Case {
  ShapeSpec shape;
  Grip grip = Grip::kSmooth;
  bool rates = false;
  double bounce = 0;
};

/// Bodies a and b; slip counts from beside where `from` are.
BodyContactRows rows_of(const Case& of, const RigidBody& a, const RigidBody& b,
                        const BodyContact& contact, const std::array<RigidBody, 2>& from) {
  BodyProbe probe;
  probe.radius = 0.01;
  probe.surface.shape = &of.shape;
  probe.surface.X_WC = {exp_so3({0.1, -0.2, 0.3}), {0.02, 0.01, -0.03}};
  StageRates rates;
  if (of.rates) {
    rates.c_v = 120;
    rates.c_w = 130;
    rates.body_rates = true;
  }
  const Pose from_a{exp_so3({0.02, 0.01, 0.03}) * from[0].R, from[0].p + Vec3(0.01, 0.02, 0)};
  const Pose from_b{exp_so3({-0.01, 0.02, 0.01}) * from[1].R, from[1].p - Vec3(0.01, 0, 0.02)};
  ContactScale scale;
  scale.length = 0.5;
  scale.force = 2;
  scale.rate = of.rates ? 60 : 0.5;
  return rows_between(probe, contact, moving_body(a, rates, from_a), moving_body(b, rates, from_b),
                      scale);
}

double worst_slope(const Case& of) {
  const RigidBody a = body_at({0.05, 0.02, 0.16}, {0.2, 0.1, -0.3});
  const RigidBody b = body_at({0.01, -0.01, 0.02}, {-0.1, 0.3, 0.2});
  BodyContact contact;
  contact.at = {0.01, 0.02, -0.03};
  contact.bounce = of.bounce;
  contact.give = 1e-3;
  contact.law.grip = of.grip;
  contact.law.friction = 0.4;
  contact.law.lever = {0.002, -0.001, -0.009};
  contact.law.force = {0.3, -0.2, 1.4};
  contact.law.held = {0.1, 0.1, 0.9};
  contact.law.kappa = 3;
  const BodyContactRows rows = rows_of(of, a, b, contact, {a, b});
  constexpr double kStep = 1e-6;
  double worst = 0;
  const auto compare = [&](const Vec3& found, const Vec3& up, const Vec3& down) {
    const Vec3 slope = (up - down) / (2 * kStep);
    worst = std::max(worst, (found - slope).norm() / std::max(1.0, slope.norm()));
  };
  for (int i = 0; i < 6; ++i) {
    const auto moved = [&](RigidBody body, double by) {
      const Vec3 turn = i < 3 ? Vec3(by * Vec3::Unit(i)) : Vec3(Vec3::Zero());
      body.R = exp_so3(turn) * body.R;
      if (i >= 3) body.p[i - 3] += by;
      return body;
    };
    const auto rows_at = [&](const RigidBody& one, const RigidBody& other) {
      return rows_of(of, one, other, contact, {a, b}).value;
    };
    compare(rows.by_body.col(i), rows_at(moved(a, kStep), b), rows_at(moved(a, -kStep), b));
    compare(rows.by_other.col(i), rows_at(a, moved(b, kStep)), rows_at(a, moved(b, -kStep)));
  }
  for (int i = 0; i < 3; ++i) {
    BodyContact up = contact, down = contact;
    up.law.force[i] += kStep;
    down.law.force[i] -= kStep;
    compare(rows.by_force.col(i), rows_of(of, a, b, up, {a, b}).value,
            rows_of(of, a, b, down, {a, b}).value);
  }
  return worst;
}

ShapeSpec shape(ShapeKind kind, const Vec3& size) {
  ShapeSpec spec;
  spec.kind = kind;
  spec.size = size;
  return spec;
}

TEST(BodyContact, RowsHaveTheirSlopes) {
  for (const ShapeSpec& solid :
       {shape(ShapeKind::kSphere, {0.08, 0, 0}), shape(ShapeKind::kBox, {0.1, 0.12, 0.14}),
        shape(ShapeKind::kEllipsoid, {0.06, 0.09, 0.07}),
        shape(ShapeKind::kCylinder, {0.05, 0.12, 0})})
    for (const Grip grip : {Grip::kSmooth, Grip::kStick, Grip::kSlip})
      for (const bool rates : {false, true})
        for (const double bounce : {0.0, 0.2})
          EXPECT_LT(worst_slope({solid, grip, rates, bounce}), 2e-7)
              << static_cast<int>(solid.kind) << ", grip " << static_cast<int>(grip) << ", rates "
              << rates << ", bounce " << bounce;
}

}  // namespace
}  // namespace cprsim
