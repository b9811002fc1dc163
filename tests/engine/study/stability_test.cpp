// SPDX-License-Identifier: BSD-3-Clause
// Critical loads from the verdict alone, against closed forms.
#include "engine/study/stability.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/support/column_and_frame.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 0.001;
constexpr double kPi = std::numbers::pi;

Scene column(EndJoint base, EndJoint tip) {
  Scene scene = column(kLength, kRadius, base, tip, 1);
  scene.solver.points = 16;
  return scene;
}

/// The force between a stable and an unstable column, by bisection of the verdict.
double critical_force(Scene scene, double low, double high) {
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    scene.loads[0].force = {0, 0, -middle};
    StaticStudy study(scene);
    EXPECT_TRUE(study.solve().converged()) << middle;
    const Stability judged = judge(study);
    EXPECT_EQ(judged.verdict, count_unstable(study.robot()).verdict);
    (judged.verdict == StabilityVerdict::kStable ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double euler(double factor) {
  return factor * kPi * kPi * bending_stiffness(steel_rod(kLength, kRadius)) / (kLength * kLength);
}

TEST(Stability, EulerColumnWithBothEndsPinned) {
  const double force =
      critical_force(column(EndJoint::kUniversal, EndJoint::kUniversal), euler(0.5), euler(1.5));
  EXPECT_NEAR(force / euler(1), 1, 1e-5);
}

TEST(Stability, EulerColumnClampedAndPinned) {
  // tan x = x, x = 4.493409457909
  const double factor = std::pow(4.493409457909064 / kPi, 2);
  const double force = critical_force(column(EndJoint::kFixed, EndJoint::kUniversal),
                                      euler(0.5 * factor), euler(1.5 * factor));
  EXPECT_NEAR(force / euler(factor), 1, 1e-5);
}

TEST(Stability, EulerColumnWithBothEndsClamped) {
  const double force =
      critical_force(column(EndJoint::kFixed, EndJoint::kFixed), euler(2), euler(6));
  EXPECT_NEAR(force / euler(4), 1, 1e-5);
}

TEST(Stability, EulerColumnWithAFreeEnd) {
  Scene scene = column(EndJoint::kFixed, EndJoint::kFree);
  scene.bodies.clear();
  scene.joints.clear();
  scene.loads[0].at = {};
  scene.loads[0].rod = 0;
  scene.loads[0].rod_s = 1;
  const double force = critical_force(scene, euler(0.1), euler(0.5));
  EXPECT_NEAR(force / euler(0.25), 1, 1e-5);
}

// A shaft clamped at both ends, one free to slide, twisted by an angle: tan x = x with x = M L / 2
// EI (Greenhill 1883).
TEST(Stability, TwistedShaftClampedAtBothEnds) {
  Scene scene = column(EndJoint::kFixed, EndJoint::kFixed);
  scene.loads.clear();
  const RodSpec& rod = scene.rods[0];
  const double GJ = rod.material->shear_modulus * kPi / 2 * std::pow(kRadius, 4);
  const double critical = 8.98681891582 * bending_stiffness(rod) / kLength;  // N m
  double low = 0.5 * critical * kLength / GJ, high = 1.5 * critical * kLength / GJ;
  // the base is turned, in steps that Newton's method follows
  const auto verdict = [&](double angle) {
    Scene turned = scene;
    turn_base(turned).profile.terms.push_back({});
    StaticStudy study(turned);
    EXPECT_TRUE(study.solve().converged());
    const int steps = static_cast<int>(std::ceil(angle / 0.5));
    for (int i = 1; i <= steps; ++i) {
      study.set(study.drives()[0], angle * i / steps);
      EXPECT_TRUE(study.follow().converged()) << angle << " " << i;
    }
    EXPECT_NEAR(std::abs(study.snapshot().rods[0].points[3].moment.z()), GJ * angle / kLength,
                1e-6 * GJ);
    return judge(study).verdict;
  };
  for (int i = 0; i < 16; ++i) {
    const double middle = 0.5 * (low + high);
    (verdict(middle) == StabilityVerdict::kStable ? low : high) = middle;
  }
  EXPECT_NEAR(0.5 * (low + high) * GJ / kLength / critical, 1, 1e-4);
}

TEST(Stability, StiffnessOfThePublishedRobotIsTheDerivativeOfItsReactions) {
  Scene scene = stewart_gough({0.40, 0.41, 0.405, 0.40, 0.395, 0.41}, false);
  scene.solver.points = 10;
  ProbeWrench wrench;
  wrench.at.body = 0;
  StaticStudy study(scene, 0, {wrench});
  ASSERT_TRUE(study.solve().converged());
  const Stability judged = judge(study);
  EXPECT_EQ(judged.verdict, StabilityVerdict::kStable);
  const MatX K = judged.body_stiffness;
  ASSERT_EQ(K.rows(), 6);
  EXPECT_LT((K - K.transpose()).norm(), 1e-9 * K.norm());
  // a small force moves the plate by K^-1 times it
  const Pose home = study.robot().body_pose(0);
  for (std::size_t c = 0; c < 3; ++c) {
    const double force = 1e-3;
    const Parameter push = study.probe(0)[c];
    Vec6 moved[2];
    for (int k = 0; k < 2; ++k) {
      study.set(push, k == 0 ? -force : force);
      ASSERT_TRUE(study.follow().converged());
      const Pose X = study.robot().body_pose(0);
      moved[k] << log_so3(X.R * home.R.transpose()), X.p - home.p;
    }
    study.set(push, 0);
    ASSERT_TRUE(study.follow().converged());
    const Vec6 change = (moved[1] - moved[0]) / 2;
    Vec6 expected = Vec6::Zero();
    expected[3 + static_cast<Eigen::Index>(c)] = force;
    EXPECT_LT((K * change - expected).norm(), 1e-5 * force) << c;
  }
}

}  // namespace
}  // namespace cprsim
