// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/joint.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/engine/robot/sample_scenes.h"
#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

constexpr JointKind kKinds[] = {JointKind::kRevolute, JointKind::kContinuous,
                                JointKind::kPrismatic};

JointSpec spec_of(JointKind kind) {
  JointSpec spec;
  spec.kind = kind;
  spec.axis = Vec3(0.6, 0.48, 0.64);
  spec.spring_stiffness = 2;
  spec.spring_reference = 0.3;
  spec.damping = 0.4;
  return spec;
}

struct Situation {
  Joint joint;
  Pose P, C;
  StageRates rates;
};

/// A joint that gapes, between bodies anywhere.
Situation situation(const JointSpec& spec, bool dynamic) {
  Numbers numbers(12);
  const Pose X_PJ = numbers.pose(1, 0.5), X_CJ = numbers.pose(1, 0.5);
  Situation s{Joint(spec, 0, 1, X_PJ, X_CJ), numbers.pose(1, 1), {}, {}};
  s.joint.q = 0.7;
  s.joint.lambda = numbers.vec6();
  s.joint.effort = 0.2;
  s.joint.track.x_h[0] = -1.3;
  const Pose gap = numbers.pose(0.4, 0.2);
  s.C = s.P * X_PJ * gap * X_CJ.inverse();
  if (dynamic) s.rates = {3, 2, true};
  return s;
}

Pose moved(const Pose& X, const Vec6& d) {
  return {exp_so3(d.head<3>()) * X.R, X.p + d.tail<3>()};
}

/// d: phi, dp of parent and child, lambda, q.
Situation increment(Situation s, const VecX& d) {
  s.P = moved(s.P, d.head<6>());
  s.C = moved(s.C, d.segment<6>(6));
  s.joint.lambda += d.segment<6>(12);
  s.joint.q += d[18];
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
        VecX values(7);
        values << rows.closure, rows.effort;
        return values;
      };
      const Joint::Rows rows = rows_of(at);
      MatX analytic = MatX::Zero(7, 19);
      analytic.topRows<6>() << rows.by_parent, rows.by_child, Mat6::Zero(), rows.by_q;
      analytic.bottomRows<1>() << rows.effort_by_parent, Row6::Zero(), rows.effort_by_lambda,
          rows.effort_by_q;
      // truncation (1e-3)^4 of functions of size 1
      EXPECT_TRUE(
          jacobians_agree(analytic, difference_jacobian(f, at, 19, increment), 1e-10, 1e-10))
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
  MatX analytic = MatX::Zero(12, 19);
  analytic.topRows<6>().leftCols<18>() << w.parent_by_parent, w.parent_by_child, w.parent_by_lambda;
  analytic.bottomRows<6>().leftCols<18>() << Mat6::Zero(), w.child_by_child, w.child_by_lambda;
  EXPECT_TRUE(jacobians_agree(analytic, difference_jacobian(f, at, 19, increment), 1e-10, 1e-10));
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

// At the joint's own pose closure vanishes for every q.
TEST(Joint, ClosesWhereItsCoordinateSays) {
  Numbers numbers(2);
  for (JointKind kind : kKinds)
    for (double q : {0.0, 1e-8, 1.1}) {
      const JointSpec spec = spec_of(kind);
      const Pose X_PJ = numbers.pose(1, 1), X_CJ = numbers.pose(1, 1), P = numbers.pose(1, 1);
      Joint joint(spec, 0, 1, X_PJ, X_CJ);
      joint.q = q;
      Pose motion;
      if (kind == JointKind::kPrismatic)
        motion.p = q * spec.axis;
      else
        motion.R = Eigen::AngleAxisd(q, spec.axis).toRotationMatrix();
      const Pose C = P * X_PJ * motion * X_CJ.inverse();
      EXPECT_LT(joint.rows(P, C, {}, 1, 1, 1).closure.norm(), 1e-15 * 4);  // round-off
    }
}

TEST(Joint, AxialEffortIsTheWrenchAlongItsAxis) {
  for (JointKind kind : kKinds) {
    const JointSpec spec = spec_of(kind);
    const Situation at = situation(spec, false);
    const Joint::Rows rows = rows_of(at);
    const bool slides = kind == JointKind::kPrismatic;
    EXPECT_NEAR(at.joint.axial_effort(at.P),
                (slides ? kForce : kMoment) * rows.effort_by_lambda.dot(at.joint.lambda), 1e-15);
    EXPECT_EQ(at.joint.unknowns(), 7);
  }
}

}  // namespace
}  // namespace cprsim
