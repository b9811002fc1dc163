// SPDX-License-Identifier: BSD-3-Clause
// Paths against closed forms: a truss that snaps, a column that buckles; and Lee's frame.
#include "engine/study/path.h"

#include <gtest/gtest.h>

#include "tests/support/elastica.h"
#include "tests/support/robots.h"

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
  const Path straight = follow_path(study, problem);
  ASSERT_EQ(straight.end, PathEnd::kArrived);
  ASSERT_EQ(straight.events.size(), 1U);
  const PathEvent& event = straight.events[0];
  EXPECT_EQ(event.kind, PathEventKind::kBranchPoint);
  EXPECT_NEAR(event.point.lambda * 3, 1, 1e-8);
  EXPECT_EQ(straight.points.front().unstable, 0);
  EXPECT_EQ(straight.points.back().unstable, 1);
  for (const int side : {1, -1}) {
    const Path branch = follow_branch(study, problem, event, side);
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

TEST(Path, PublishedRobotLosesStabilityWhenTranslated) {
  Scene scene = stewart_gough(std::vector<double>(6, 0.5), false);
  for (int i = 0; i < 6; ++i) {
    DriveSpec drive;
    drive.quantity = DriveQuantity::kLength;
    drive.rod = i;
    ProfileTerm term;
    term.value = 0.5;
    drive.profile.terms.push_back(term);
    scene.drives.push_back(drive);
  }
  scene.bodies[0].X_WB.p.z() = 0.5;
  StaticStudy study(scene);
  ASSERT_TRUE(study.solve().converged());
  PoseGoal from, to;
  from.at.body = to.at.body = 0;
  from.position = {0, 0, 0.5};
  to.position = {0.5, 0, 0.5};
  ASSERT_TRUE(solve_inverse(study, study.drives(), reach(from, 0.5)).reached);
  PathOptions options;
  options.max_events = 1;
  const auto t0 = std::chrono::steady_clock::now();
  options.observe = [&](const PathPoint& p) {
    const auto& X = p.state.unknowns.bodies[0];
    fprintf(stderr, "x %.5f s %.4f unstable %d softest %.6g  lengths %.4f %.4f %.4f %.4f t %.1f\n",
            X.p.x(), p.s, p.unstable, p.softest, p.state.drives[0], p.state.drives[2],
            p.state.drives[3], p.state.drives[4],
            std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count());
    return true;
  };
  const Path path = follow_path(study, along_pose(study, study.drives(), from, to), options);
  fprintf(stderr, "%s\n", to_string(path.end));
  for (auto& e : path.events) {
    fprintf(stderr, "event %s x %.10g %d %d softest %g\n", to_string(e.kind), e.point.lambda * 0.5,
            e.before, e.after, e.point.softest);
    for (int side : {1, -1}) {
      const Release r =
          release(study, along_pose(study, study.drives(), from, to), path.points.back(), e, side);
      const Pose& X = r.end.state.unknowns.bodies[0];
      fprintf(stderr, "release from %g: %s %d its, res %g, moved %g, unstable %d softest %g\n",
              path.points.back().lambda * 0.5, to_string(r.solve.status), r.solve.iterations,
              r.solve.residual, r.moved, r.end.unstable, r.end.softest);
      std::cerr << X.p.transpose() << " angles " << angles_of(X.R).transpose() * 57.29578
                << std::endl;
    }
    if (!e.bodies.empty()) std::cerr << e.bodies[0].transpose() << std::endl;
  }
}

}  // namespace
}  // namespace cprsim
