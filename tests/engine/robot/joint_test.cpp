// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/joint.h"

#include <gtest/gtest.h>

#include <numbers>

#include "engine/math/so3.h"
#include "tests/engine/robot/sample_scenes.h"
#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

constexpr JointKind kKinds[] = {
    JointKind::kRevolute,  JointKind::kContinuous, JointKind::kPrismatic,   JointKind::kBall,
    JointKind::kUniversal, JointKind::kScrew,      JointKind::kCylindrical, JointKind::kPlanar};

JointSpec spec_of(JointKind kind) {
  JointSpec spec;
  spec.kind = kind;
  spec.axis = Vec3(0.6, 0.48, 0.64);
  spec.spring_stiffness = 2;
  spec.spring_reference = kind == JointKind::kBall ? 0 : 0.3;
  spec.damping = 0.4;
  spec.second.axis = Vec3(0.8, -0.36, -0.48);
  spec.second.damping = 0.3;
  spec.third.spring_stiffness = 1.5;
  spec.screw_pitch = 0.9;
  return spec;
}

struct Situation {
  Joint joint;
  Pose P, C;
  StageRates rates;
};

Pose moved(const Pose& X, const Vec6& d) {
  return {exp_so3(d.head<3>()) * X.R, X.p + d.tail<3>()};
}

/// A joint that gapes, between bodies anywhere.
Situation situation(const JointSpec& spec, bool dynamic) {
  Numbers numbers(12);
  const Pose X_PJ = numbers.pose(1, 0.5), X_CJ = numbers.pose(1, 0.5);
  Situation s{Joint(spec, 0, 1, X_PJ, X_CJ), numbers.pose(1, 1), {}, {}};
  s.joint.q = {0.7, -0.5, 0.4};
  s.joint.lambda = numbers.vec6();
  for (Joint::Freedom& freedom : s.joint.freedoms)
    freedom.effort = 0.2;
  s.joint.track.x_h.setConstant(-1.3);
  const Pose gap = numbers.pose(0.4, 0.2);
  s.C = s.P * X_PJ * gap * X_CJ.inverse();
  s.joint.start_tracks(s.P, moved(s.C, 0.3 * numbers.vec6()), Vec6::Zero());
  s.joint.spin.x_h = numbers.vec3();
  if (dynamic) s.rates = {3, 2, true};
  return s;
}

/// d: phi, dp of parent and child, lambda, q.
Situation increment(Situation s, const VecX& d) {
  s.P = moved(s.P, d.head<6>());
  s.C = moved(s.C, d.segment<6>(6));
  s.joint.lambda += d.segment<6>(12);
  s.joint.q += d.segment<3>(18);
  return s;
}

constexpr double kLength = 0.8, kMoment = 2, kForce = 2.5;

Joint::Rows rows_of(const Situation& s) {
  return s.joint.rows(s.P, s.C, s.rates, kLength, kMoment, kForce);
}

TEST(Joint, RowsAreDerivativesOfTheirValues) {
  for (JointKind kind : kKinds)
    for (bool dynamic : {false, true}) {
      const JointSpec spec = spec_of(kind);
      const Situation at = situation(spec, dynamic);
      const auto f = [](const Situation& s) {
        const Joint::Rows rows = rows_of(s);
        VecX values(9);
        values << rows.closure, rows.effort;
        return values;
      };
      const Joint::Rows rows = rows_of(at);
      MatX analytic = MatX::Zero(9, 21);
      analytic.topRows<6>() << rows.by_parent, rows.by_child, rows.by_lambda, rows.by_q;
      analytic.bottomRows<3>() << rows.effort_by_parent, Mat36::Zero(), rows.effort_by_lambda,
          rows.effort_by_q;
      // truncation (1e-3)^4 of functions of size 1
      EXPECT_TRUE(
          jacobians_agree(analytic, difference_jacobian(f, at, 21, increment), 1e-10, 1e-10))
          << static_cast<int>(kind) << dynamic;
    }
}

TEST(Joint, WrenchesAreDerivativesOfTheirValues) {
  const JointSpec spec = spec_of(JointKind::kPrismatic);
  const Situation at = situation(spec, false);
  const auto f = [](const Situation& s) {
    const Joint::Wrenches w = s.joint.wrenches(s.P, s.C);
    VecX values(12);
    values << w.on_parent, w.on_child;
    return values;
  };
  const Joint::Wrenches w = at.joint.wrenches(at.P, at.C);
  MatX analytic = MatX::Zero(12, 21);
  analytic.topRows<6>().leftCols<18>() << w.parent_by_parent, w.parent_by_child, w.parent_by_lambda;
  analytic.bottomRows<6>().leftCols<18>() << Mat6::Zero(), w.child_by_child, w.child_by_lambda;
  EXPECT_TRUE(jacobians_agree(analytic, difference_jacobian(f, at, 21, increment), 1e-10, 1e-10));
}

TEST(Joint, ActionIsReaction) {
  for (JointKind kind : kKinds) {
    const JointSpec spec = spec_of(kind);
    const Situation at = situation(spec, false);
    const Joint::Wrenches w = at.joint.wrenches(at.P, at.C);
    const Vec3 F_P = w.on_parent.tail<3>(), F_C = w.on_child.tail<3>();
    const Vec3 M_P = w.on_parent.head<3>() + at.P.p.cross(F_P),
               M_C = w.on_child.head<3>() + at.C.p.cross(F_C);
    EXPECT_LT((F_P + F_C).norm(), 1e-15);  // round-off
    EXPECT_LT((M_P + M_C).norm(), 1e-14);
  }
}

/// What q does to the child, told by kind and not by chain.
Pose motion_of(const JointSpec& spec, const Vec3& q) {
  const auto turn = [](double angle, const Vec3& axis) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  };
  const Vec3 &a = spec.axis, &b = spec.second.axis;
  Pose X;
  switch (spec.kind) {
    case JointKind::kPrismatic:
      X.p = q[0] * a;
      break;
    case JointKind::kUniversal:
      X.R = turn(q[0], a) * turn(q[1], b);
      break;
    case JointKind::kScrew:
      X = {turn(q[0], a), q[0] * spec.screw_pitch / (2 * std::numbers::pi) * a};
      break;
    case JointKind::kCylindrical:
      X = {turn(q[1], a), q[0] * a};
      break;
    case JointKind::kPlanar:
      X = {turn(q[2], a.cross(b)), q[0] * a + q[1] * b};
      break;
    case JointKind::kBall:
      X.R = exp_so3(q);
      break;
    default:
      X.R = turn(q[0], a);
  }
  return X;
}

// At the joint's own pose closure vanishes for every q; of a ball, where nothing resists.
TEST(Joint, ClosesWhereItsCoordinatesSay) {
  Numbers numbers(2);
  for (JointKind kind : kKinds)
    for (double size : {0.0, 1e-8, 1.1}) {
      JointSpec spec = spec_of(kind);
      if (kind == JointKind::kBall) spec.spring_stiffness = 0;
      const Pose X_PJ = numbers.pose(1, 1), X_CJ = numbers.pose(1, 1), P = numbers.pose(1, 1);
      Joint joint(spec, 0, 1, X_PJ, X_CJ);
      joint.q = size * Vec3(1, -0.7, 0.5);
      const Pose C = P * X_PJ * motion_of(spec, joint.q) * X_CJ.inverse();
      EXPECT_LT(joint.rows(P, C, {}, 1, 1, 1).closure.norm(), 1e-15 * 4)  // round-off
          << static_cast<int>(kind);
      const Pose moved = joint.displacement(P) * P * X_PJ;
      if (kind == JointKind::kBall) continue;
      EXPECT_LT((moved.p - (C * X_CJ).p).norm() + (moved.R - (C * X_CJ).R).norm(), 1e-14);
    }
}

TEST(Joint, ObservesTheWrenchAlongItsAxes) {
  for (JointKind kind : kKinds) {
    if (kind == JointKind::kBall) continue;
    const JointSpec spec = spec_of(kind);
    const Situation at = situation(spec, false);
    const Joint::Rows rows = rows_of(at);
    const Joint::Observed seen = at.joint.observe(at.P, at.C);
    for (int i = 0; i < freedom_count(kind); ++i)
      EXPECT_NEAR(
          seen.effort[i],
          (slides(kind, i) ? kForce : kMoment) * rows.effort_by_lambda.row(i).dot(at.joint.lambda),
          2e-15);
    EXPECT_EQ(at.joint.unknowns(), 6 + freedom_count(kind));
  }
}

AxisSpec rough_axis() {
  AxisSpec spec;
  spec.spring_stiffness = 3;
  spec.spring_reference = 0.1;
  spec.damping = 0.2;
  spec.friction = 0.5;
  spec.lower = -1;
  spec.upper = 2;
  spec.stop_stiffness = 40;
  spec.stop_dissipation = 0.3;
  return spec;
}

TEST(AxisLaw, TangentsAreDerivativesOfTheirValues) {
  const AxisSpec spec = rough_axis();
  AxisLaw law;
  law.set_scale(spec, 1, 1);
  law.engage_friction(0);
  // sticking, slipping, between the stops, in both, in the soft part of one, leaving fast
  const double states[][2] = {{4e-6, 2e-5}, {0.4, 0.7},   {0.4, -0.7},     {2.3, 0.4},
                              {-1.2, 0.4},  {-1.2, -0.4}, {2 + 5e-5, 0.2}, {2.3, -9}};
  for (const auto& [q, q_t] : states) {
    const double h = 1e-7, k = 1e-6;
    const AxisEffort tau = law.total(spec, q, q_t);
    const double by_q =
        (law.total(spec, q + h, q_t).value - law.total(spec, q - h, q_t).value) / (2 * h);
    const double by_rate =
        (law.total(spec, q, q_t + k).value - law.total(spec, q, q_t - k).value) / (2 * k);
    EXPECT_NEAR(tau.by_q, by_q, 1e-7 * (1 + std::abs(by_q))) << q << ' ' << q_t;
    EXPECT_NEAR(tau.by_rate, by_rate, 1e-7 * (1 + std::abs(by_rate))) << q << ' ' << q_t;
  }
}

// tau = -dU/dq for what is stored, and what is lost is never negative.
TEST(AxisLaw, StoresWhatItGivesBack) {
  AxisSpec spec = rough_axis();
  spec.friction = 0;
  AxisLaw law;
  law.set_scale(spec, 1, 1);
  for (double q : {-1.3, -1 - 6e-5, 0.3, 2 + 4e-5, 2.4}) {
    const double h = 1e-6;
    EXPECT_NEAR(law.total(spec, q, 0).value,
                -(law.stored(spec, q + h) - law.stored(spec, q - h)) / (2 * h), 1e-6);
    for (double q_t : {-20., -0.5, 0., 0.5}) {
      EXPECT_GE(law.loss(spec, q, q_t), 0);
      // what the passive effort takes is lost or stored
      const double stored_rate = -law.total(spec, q, 0).value * q_t;
      EXPECT_NEAR(-law.total(spec, q, q_t).value * q_t, law.loss(spec, q, q_t) + stored_rate,
                  1e-12);
    }
  }
}

TEST(AxisLaw, FrictionSticksThenSlipsAndTakesItsAnchorAlong) {
  AxisSpec spec;
  spec.friction = 0.5;
  AxisLaw law;
  law.set_scale(spec, 1, 1);
  EXPECT_EQ(law.friction(spec, 1, 1).value, 0);  // not engaged
  law.engage_friction(1);
  EXPECT_EQ(law.friction(spec, 1, 0).value, 0);
  EXPECT_NEAR(law.friction(spec, 1 + 5e-6, 0).value, -0.25, 1e-9);
  law.accept(spec, 1 + 5e-6);
  EXPECT_NEAR(law.friction(spec, 1, 0).value, 0, 1e-9);  // it stuck: nothing has shifted
  EXPECT_NEAR(law.friction(spec, 1.2, 0).value, -0.5, 1e-15);
  EXPECT_NEAR(law.friction(spec, 1.2, 3).value, -0.5, 1e-15);
  law.accept(spec, 1.2);
  EXPECT_NEAR(law.friction(spec, 1.2, 0).value, -0.5, 1e-9);
  EXPECT_NEAR(law.friction(spec, 1.2 - 1e-5, 0).value, 0, 1e-9);
  EXPECT_NEAR(law.friction(spec, 1.2 - 1e-3, 0).value, 0.5, 1e-9);
  EXPECT_NEAR(law.stored_in_friction(spec, 1.2), 0.5 * 0.5 * 1e-5, 1e-15);
}

}  // namespace
}  // namespace cprsim
