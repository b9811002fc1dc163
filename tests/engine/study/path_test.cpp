// SPDX-License-Identifier: BSD-3-Clause
// Paths against closed forms: a truss that snaps, a column that buckles; and Lee's frame.
#include "engine/study/path.h"

#include <gtest/gtest.h>

#include "tests/support/column_and_frame.h"
#include "tests/support/elastica.h"

namespace cprsim {
namespace {

constexpr double kPi = std::numbers::pi;

Parameter force_of(int load, int component) {
  return {Parameter::Kind::kForce, load, component, "force", "N"};
}

VecX one(double value) {
  return VecX::Constant(1, value);
}

/// A body that slides along z (and x, if planar is asked elsewhere), held by a prismatic joint.
int add_slider(Scene& scene, const std::string& name, const Vec3& at) {
  BodySpec slider;
  slider.name = name;
  slider.X_WB.p = at;
  scene.bodies.push_back(slider);
  JointSpec rail;
  rail.name = name + "_rail";
  rail.kind = JointKind::kPrismatic;
  rail.child = static_cast<int>(scene.bodies.size()) - 1;
  rail.X_PJ.p = at;
  scene.joints.push_back(rail);
  return rail.child;
}

// Two stretching rods from hinges at (-a, 0, 0) and (a, 0, 0) to an apex on a vertical rail.
// With angle q of the rods, N = EA (1 - cos q0 / cos q) and P = 2 N sin q; dP/dq = 0 where
// cos³ q = cos q0, P = 2 EA sin³ q (von Mises 1923).
constexpr double kAngle = 0.1, kHalfSpan = 0.2;

Scene truss() {
  Scene scene;
  switch_on(scene, {Effect::kExtension});
  const int apex = add_slider(scene, "apex", {0, 0, kHalfSpan * std::tan(kAngle)});
  for (const double side : {-1.0, 1.0}) {
    RodSpec rod = steel_rod(kHalfSpan / std::cos(kAngle), 0.02);
    rod.name = side < 0 ? "left" : "right";
    rod.material->youngs_modulus = 1e6;
    rod.material->shear_modulus = 4e5;
    rod.base.joint = rod.tip.joint = EndJoint::kRevolute;
    rod.base.axis = rod.tip.axis = Vec3::UnitY();
    const Mat3 R = Eigen::AngleAxisd(-side * (kPi / 2 - kAngle), Vec3::UnitY()).toRotationMatrix();
    rod.base.at.X_BF.p = {side * kHalfSpan, 0, 0};
    rod.base.at.X_BF.R = rod.tip.at.X_BF.R = R;
    rod.tip.at.body = apex;
    scene.rods.push_back(rod);
  }
  LoadSpec load;
  load.at.body = apex;
  load.force = Vec3::Zero();
  scene.loads.push_back(load);
  scene.solver.points = 4;
  return scene;
}

TEST(Path, TrussSnapsAtTheClosedFormLoad) {
  const Scene scene = truss();
  const double EA = 1e6 * kPi * 0.02 * 0.02;
  const double q = std::acos(std::cbrt(std::cos(kAngle)));
  const double fold = 2 * EA * std::pow(std::sin(q), 3);
  StaticStudy study(scene);
  ASSERT_TRUE(study.solve().converged());
  PathOptions options;
  options.low = -4;
  const Path path =
      follow_path(study, along_line(study, {force_of(0, 2)}, one(0), one(-2 * fold)), options);
  ASSERT_EQ(path.end, PathEnd::kArrived) << to_string(path.end);
  ASSERT_EQ(path.events.size(), 2U);
  const double sign[] = {1, -1};
  for (std::size_t i = 0; i < 2; ++i) {
    const PathEvent& event = path.events[i];
    EXPECT_EQ(event.kind, PathEventKind::kFold);
    EXPECT_NEAR(event.point.lambda * 2, sign[i], 1e-8) << i;
    EXPECT_NEAR(event.point.state.unknowns.bodies[0].p.z(), sign[i] * kHalfSpan * std::tan(q),
                1e-6 * kHalfSpan);
    EXPECT_EQ(event.before, i == 0 ? 0 : 1);
    EXPECT_EQ(event.after, i == 0 ? 1 : 0);
  }
  for (const PathPoint& point : path.points) {
    const double angle = std::atan2(point.state.unknowns.bodies[0].p.z(), kHalfSpan);
    const double P = 2 * EA * (1 - std::cos(kAngle) / std::cos(angle)) * std::sin(angle);
    EXPECT_NEAR(point.lambda * 2 * fold, P, 1e-8 * fold);
    EXPECT_EQ(point.unstable, std::abs(angle) < q ? 1 : 0);
  }
}

/// A strip between hinges that turn about y, pressed along z: it buckles in the x-z plane.
Scene column(double length) {
  Scene scene;
  const int slider = add_slider(scene, "slider", {0, 0, length});
  RodSpec rod = steel_rod(length, 1e-3);
  rod.base.joint = rod.tip.joint = EndJoint::kRevolute;
  rod.base.axis = rod.tip.axis = Vec3::UnitY();
  rod.tip.at.body = slider;
  scene.rods.push_back(rod);
  LoadSpec load;
  load.at.body = slider;
  load.force = Vec3::Zero();
  scene.loads.push_back(load);
  scene.solver.points = 16;
  return scene;
}

// With the angle a at the ends and k = sin(a/2): P L² / EI = 4 K(k)², the middle is off by L k / K,
// the ends approach to L (2 E / K - 1) (Euler 1744; Love, Mathematical Theory of Elasticity, §262).
TEST(Path, BuckledColumnFollowsTheElastica) {
  constexpr double kLength = 0.4;
  constexpr double kMeetK = 2.321049853;  // K(k) where 2 E = K
  const Scene scene = column(kLength);
  const double EI = bending_stiffness(scene.rods[0]);
  const double euler = kPi * kPi * EI / (kLength * kLength);
  StaticStudy study(scene);
  ASSERT_TRUE(study.solve().converged());
  const PathProblem problem = along_line(study, {force_of(0, 2)}, one(0), one(-3 * euler));
  PathOptions options;
  options.largest_step = 0.5;
  const Path straight = follow_path(study, problem, options);
  ASSERT_EQ(straight.end, PathEnd::kArrived);
  ASSERT_EQ(straight.events.size(), 1U);
  const PathEvent& event = straight.events[0];
  EXPECT_EQ(event.kind, PathEventKind::kBranchPoint);
  EXPECT_NEAR(event.point.lambda * 3, 1, 1e-8);
  EXPECT_EQ(straight.points.front().unstable, 0);
  EXPECT_EQ(straight.points.back().unstable, 1);
  for (const int side : {1, -1}) {
    const Path branch = follow_branch(study, problem, event, side, options);
    ASSERT_EQ(branch.end, PathEnd::kArrived) << to_string(branch.end);
    // where the ends meet, 2 E = K, the whole rod can turn about them
    ASSERT_EQ(branch.events.size(), 1U);
    EXPECT_EQ(branch.events[0].kind, PathEventKind::kBranchPoint);
    EXPECT_NEAR(branch.events[0].point.lambda * 3, std::pow(2 * kMeetK / kPi, 2), 1e-7);
    double widest = 0;
    for (const PathPoint& point : branch.points) {
      study.restore(point.state);
      const RodSample rod = study.snapshot().rods[0];
      const Vec3 t = rod.points.front().rotation.col(2);
      const double a = std::atan2(std::abs(t.x()), t.z());
      const double s = std::sin(a / 2), c = std::cos(a / 2);
      const double K = elliptic_F(1, 0, c * c), E = elliptic_E(1, 0, c * c);
      EXPECT_NEAR(point.lambda * 3, std::pow(2 * K / kPi, 2), 2e-7 * point.lambda * 3);
      EXPECT_NEAR(std::abs(point_at(rod, 0.5).position.x()), kLength * s / K, 1e-7 * kLength);
      EXPECT_NEAR(rod.points.back().position.z(), kLength * (2 * E / K - 1), 1e-7 * kLength);
      EXPECT_EQ(point.unstable, rod.points.back().position.z() > 0 ? 0 : 1);
      widest = std::max(widest, a);
    }
    EXPECT_GT(widest, 2);
  }
}

TEST(Path, CriticalMotionOfTheColumnIsASineHalfWave) {
  constexpr double kLength = 0.4;
  const Scene scene = column(kLength);
  const double euler = kPi * kPi * bending_stiffness(scene.rods[0]) / (kLength * kLength);
  StaticStudy study(scene);
  ASSERT_TRUE(study.solve().converged());
  const Path path =
      follow_path(study, along_line(study, {force_of(0, 2)}, one(0), one(-2 * euler)));
  ASSERT_EQ(path.events.size(), 1U);
  study.restore(path.events[0].displaced);
  const RodSample rod = study.snapshot().rods[0];
  const double middle = point_at(rod, 0.5).position.x();
  EXPECT_GT(std::abs(middle), 1e-3 * kLength);
  for (const RodPoint& point : rod.points) {
    EXPECT_NEAR(point.position.x(), middle * std::sin(kPi * point.s), 1e-2 * std::abs(middle));
    EXPECT_NEAR(point.position.y(), 0, 1e-9);
  }
}

// Reference: arc length on a shooting map, independent of this program, shear coefficient 1;
// literature 18.55 and -9.4 EI/L² (Lee, Manuel, Rossow 1968).
TEST(Path, LeesFrameSnapsBack) {
  Scene scene = lees_frame();
  scene.solver.points = 8;
  StaticStudy study(scene);
  ASSERT_TRUE(study.solve().converged());
  PathOptions options;
  options.largest_step = 0.4;
  const Path path =
      follow_path(study, along_line(study, {force_of(0, 2)}, one(0), one(-20000)), options);
  ASSERT_EQ(path.end, PathEnd::kArrived) << to_string(path.end);
  std::vector<double> folds;
  for (const PathEvent& event : path.events)
    if (event.kind == PathEventKind::kFold) folds.push_back(20000 * event.point.lambda);
  ASSERT_EQ(folds.size(), 2U);
  EXPECT_NEAR(folds[0] / 18546.5587408, 1, 1e-6);
  EXPECT_NEAR(folds[1] / -9396.14236998, 1, 1e-5);
}

/// The published robot over its base, 0.5 m above it.
Scene translated_robot() {
  Scene scene = stewart_gough(std::vector<double>(6, 0.5), false);
  for (int i = 0; i < 6; ++i) {
    DriveSpec drive;
    drive.quantity = DriveQuantity::kLength;
    drive.rod = i;
    drive.profile.terms.push_back({});
    drive.profile.terms.back().value = 0.5;
    scene.drives.push_back(drive);
  }
  scene.bodies[0].X_WB.p.z() = 0.5;
  scene.solver.points = 5;
  return scene;
}

TEST(Path, PublishedRobotLosesStabilityWhenTranslatedAndSnapsToEitherSide) {
  StaticStudy study(translated_robot());
  ASSERT_TRUE(study.solve().converged());
  PoseGoal from, to;
  from.at.body = to.at.body = 0;
  from.position = {0, 0, 0.5};
  to.position = {0.117, 0, 0.5};
  ASSERT_TRUE(solve_inverse(study, study.drives(), reach(from, 0.5)).reached);
  const PathProblem problem = along_pose(study, study.drives(), from, to);
  const Path path = follow_path(study, problem);
  ASSERT_EQ(path.end, PathEnd::kArrived);
  for (const PathPoint& point : path.points) {
    const Pose& X = point.state.unknowns.bodies[0];
    EXPECT_NEAR(X.p.x(), 0.117 * point.lambda, 1e-10);
    EXPECT_NEAR(X.p.y(), 0, 1e-10);
    EXPECT_NEAR(X.p.z(), 0.5, 1e-10);
  }
  ASSERT_EQ(path.events.size(), 1U);
  const PathEvent& event = path.events[0];
  EXPECT_EQ(event.kind, PathEventKind::kStability);
  EXPECT_EQ(event.before, 0);
  EXPECT_EQ(event.after, 1);
  EXPECT_NEAR(event.point.lambda * 0.117, 0.11678, 1e-5);
  // softest stiffness zero there; and the critical motion is out of the mirror plane y = 0
  EXPECT_LT(std::abs(event.point.softest), 1e-6 * path.points.front().softest);
  ASSERT_EQ(event.bodies.size(), 1U);
  EXPECT_LT(std::abs(event.bodies[0][3]), 1e-4 * std::abs(event.bodies[0][4]));
  // let go beyond it with the legs locked, the robot leaves the mirror plane, to either side alike
  Pose end[2];
  for (int k = 0; k < 2; ++k) {
    const Release let_go = release(study, problem, path.points.back(), event, k == 0 ? 1 : -1);
    ASSERT_TRUE(let_go.solve.converged());
    EXPECT_EQ(let_go.end.verdict, StabilityVerdict::kStable);
    EXPECT_EQ(let_go.end.state.drives, path.points.back().state.drives);
    end[k] = let_go.end.state.unknowns.bodies[0];
    EXPECT_GT(std::abs(end[k].p.y()), 5e-5);
  }
  EXPECT_NEAR(end[0].p.y(), -end[1].p.y(), 1e-8);
  EXPECT_NEAR(end[0].p.x(), end[1].p.x(), 1e-8);
}

}  // namespace
}  // namespace cprsim
