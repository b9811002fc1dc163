// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/workspace.h"

#include <gtest/gtest.h>

#include <mutex>

#include "tests/support/robots.h"

namespace cprsim {
namespace {

WorkspaceAxis axis(int drive, double low, double high, int count) {
  WorkspaceAxis a;
  a.name = "drive " + std::to_string(drive);
  a.low = low;
  a.high = high;
  a.count = count;
  a.drive = drive;
  return a;
}

WorkspaceAxis freedom_axis(int freedom, double low, double high) {
  WorkspaceAxis a = axis(-1, low, high, 3);
  a.freedom = freedom;
  return a;
}

TEST(Workspace, GridHasEveryCombinationWithItsEnds) {
  const auto points = grid_points({axis(0, 1, 3, 3), axis(1, -1, 1, 2), axis(2, 4, 6, 1)});
  ASSERT_EQ(points.size(), 6U);
  EXPECT_EQ(points.front(), (std::vector<double>{1, -1, 5}));
  EXPECT_EQ(points[1], (std::vector<double>{1, 1, 5}));
  EXPECT_EQ(points.back(), (std::vector<double>{3, 1, 5}));
}

TEST(Workspace, RandomPointsFillTheBoxAndDependOnTheSeedAlone) {
  const std::vector<WorkspaceAxis> axes{axis(0, 1, 3, 0), axis(1, -2, -1, 0)};
  const auto points = random_points(axes, 4000, 5);
  Vec2 mean = Vec2::Zero();
  for (const auto& point : points) {
    EXPECT_TRUE(point[0] >= 1 && point[0] < 3 && point[1] >= -2 && point[1] < -1);
    mean += Vec2(point[0], point[1]) / 4000;
  }
  EXPECT_NEAR(mean.x(), 2, 0.04);
  EXPECT_NEAR(mean.y(), -1.5, 0.02);
  EXPECT_EQ(points, random_points(axes, 4000, 5));
  EXPECT_NE(points, random_points(axes, 4000, 6));
}

// What a drive exerts is what the potential energy of the whole robot costs per unit of its motion.
TEST(Workspace, EffortsAreDerivativesOfEnergy) {
  Scene scene = stewart_gough_driven({0.40, 0.41, 0.405, 0.40, 0.395, 0.41});
  scene.solver.accuracy = 1e-10;  // energies are sums over points, forces are not
  StaticStudy study(scene);
  ASSERT_TRUE(study.solve().converged());
  const std::vector<double> efforts = drive_efforts(study);
  const auto potential = [&] {
    double sum = 0;
    for (const RobotRod& rod : study.robot().rods)
      sum += rod.model->energy().elastic + rod.model->energy().gravity;
    for (const RigidBody& body : study.robot().bodies)
      sum -= body.mass * study.robot().gravity.dot(body.p);
    return sum;
  };
  const double h = 1e-5;
  for (std::size_t i = 0; i < 6; ++i) {
    const Parameter& leg = study.drives()[i];
    const double start = study.value(leg);
    double side[2];
    for (int k = 0; k < 2; ++k) {
      study.set(leg, start + (k == 0 ? -h : h));
      ASSERT_TRUE(study.follow().converged());
      side[k] = potential();
    }
    study.set(leg, start);
    ASSERT_TRUE(study.follow().converged());
    EXPECT_NEAR(efforts[i], (side[1] - side[0]) / (2 * h), 1e-5 * std::abs(efforts[i])) << i;
  }
}

TEST(Workspace, AnswersDoNotDependOnEarlierPointsOrThreads) {
  const Scene scene = stewart_gough_driven(std::vector<double>(6, 0.4));
  WorkspaceQuestion question;
  question.poses = true;
  question.frame.body = 0;
  question.axes = {freedom_axis(0, -0.05, 0.05), freedom_axis(2, 0.37, 0.4)};
  for (HeldFreedom& other : question.others)
    other.held = true;
  const auto points = grid_points(question.axes);
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < points.size(); ++i)
    all.push_back(i);
  std::vector<WorkspacePoint> answers(points.size());
  solve_points(
      scene, question, points, all, 2,
      [&](const WorkspacePoint& point) { answers[point.index] = point; }, [] { return false; });
  for (const std::size_t i : {8U, 3U, 0U}) {
    const WorkspacePoint alone = WorkspaceSolver(scene, question).solve(i, points[i]);
    ASSERT_TRUE(alone.reached()) << alone.why;
    EXPECT_EQ(alone.drives, answers[i].drives);
    EXPECT_EQ(alone.efforts, answers[i].efforts);
    EXPECT_EQ(alone.position, answers[i].position);
    EXPECT_NEAR(alone.position.x(), points[i][0], 1e-9);
    EXPECT_NEAR(alone.angles.norm(), 0, 1e-8);
  }
}

TEST(Workspace, StopsWhenToldSo) {
  const Scene scene = stewart_gough_driven(std::vector<double>(6, 0.4));
  WorkspaceQuestion question;
  question.frame.body = 0;
  question.axes = {axis(0, 0.39, 0.41, 20)};
  const auto points = grid_points(question.axes);
  std::vector<std::size_t> all(points.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = i;
  std::size_t count = 0;
  solve_points(
      scene, question, points, all, 1, [&](const WorkspacePoint&) { ++count; },
      [&] { return count == 3; });
  EXPECT_EQ(count, 3U);
}

// Stiff legs of unequal length, which Newton's method alone does not bring together: vectors of
// docs/robustness.md.
TEST(Workspace, LegsOfVeryUnequalLengthsAreBroughtTogether) {
  const std::vector<double> lengths[] = {
      {0.36359740418533026, 0.33852662304741427, 0.32287262679246198, 0.451784553204436,
       0.37299020710872266, 0.36223381697987578},
      {0.36941221565247345, 0.45659514763827164, 0.45483504614579684, 0.42810700203858421,
       0.48345235175194212, 0.47163870105160977},
      {0.35154805651623239, 0.44478372573315184, 0.36731581393323487, 0.3419549520385014,
       0.43738135695154323, 0.45469607487090025}};
  int harder = 0;
  for (const std::vector<double>& each : lengths) {
    Scene scene = stewart_gough_driven(each);
    scene.solver.accuracy = 1e-10;
    StaticStudy study(scene);
    const SolveReport report = study.solve();
    EXPECT_TRUE(report.converged()) << to_string(report.status);
    EXPECT_LT(report.residual, 1e-9);
    if (report.stage != SolveStage::kNewton) ++harder;
  }
  EXPECT_GE(harder, 1);
}

}  // namespace
}  // namespace cprsim
