// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/inverse.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/math/so3.h"
#include "engine/run/observe.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

PoseGoal platform_at(const Vec3& position, const Vec3& angles) {
  PoseGoal goal;
  goal.at.body = 0;
  goal.position = position;
  goal.angles = angles;
  return goal;
}

TEST(Inverse, FindsTheLegLengthsOfThePublishedPose) {
  StaticStudy study(stewart_gough_driven(std::vector<double>(6, 0.4)));
  ASSERT_TRUE(study.solve().converged());
  const InverseReport report = solve_inverse(
      study, study.drives(), reach(platform_at({0, 0, 0.4}, {0, 10 * kDegree, 0}), 0.4));
  ASSERT_TRUE(report.reached) << report.why;
  const double published[] = {0.3973263874, 0.3973263874, 0.3997201023,
                              0.4216240113, 0.4216240113, 0.3997201023};
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(study.value(study.drives()[i]), published[i], 1e-8) << i;
  // mirror symmetry about the x-z plane
  const auto length = [&](std::size_t i) { return study.value(study.drives()[i]); };
  EXPECT_NEAR(length(0), length(1), 1e-12);
  EXPECT_NEAR(length(3), length(4), 1e-12);
  EXPECT_NEAR(length(2), length(5), 1e-12);
}

TEST(Inverse, ForwardUndoesInverse) {
  StaticStudy study(stewart_gough_driven(std::vector<double>(6, 0.4)));
  ASSERT_TRUE(study.solve().converged());
  const StaticStudy::State home = study.state();
  StaticStudy forward(stewart_gough_driven(std::vector<double>(6, 0.4)));
  std::mt19937 random(7);
  const auto uniform = [&](double size) {
    return size * (2 * (static_cast<double>(random()) / 4294967296.0) - 1);
  };
  for (int k = 0; k < 1000; ++k) {
    const Vec3 p(uniform(0.03), uniform(0.03), 0.385 + uniform(0.02));
    const Vec3 a(uniform(0.12), uniform(0.12), uniform(0.2));
    study.restore(home);
    study.follow();
    const InverseReport report =
        solve_inverse(study, study.drives(), reach(platform_at(p, a), 0.4));
    if (!report.reached) {
      ADD_FAILURE() << k << ": " << report.why << " " << p.transpose() << " " << a.transpose();
      continue;
    }
    for (std::size_t i = 0; i < 6; ++i)
      forward.set(forward.drives()[i], study.value(study.drives()[i]));
    ASSERT_TRUE(forward.follow().converged()) << k;
    const Pose X = pose_of(forward, {0, Pose{}});
    EXPECT_LT((X.p - p).norm(), 1e-9) << k;
    const Mat3 R = exp_so3({0, 0, a.z()}) * exp_so3({0, a.y(), 0}) * exp_so3({a.x(), 0, 0});
    EXPECT_LT(log_so3(X.R * R.transpose()).norm(), 1e-8) << k;
  }
}

TEST(Inverse, EstimatesTheWrenchThatItWasGiven) {
  Scene scene = stewart_gough_driven({0.40, 0.41, 0.405, 0.40, 0.395, 0.41});
  const Vec3 force(0.4, -0.3, 0.5), torque(0.01, 0.02, -0.005);
  ProbeWrench wrench;
  wrench.at.body = 0;
  wrench.force = force;
  wrench.torque = torque;
  StaticStudy truth(scene, 0, {wrench});
  ASSERT_TRUE(truth.solve().converged());
  std::vector<ChannelGoal> measured;
  for (const Channel& channel : find_channels(scene, "*.base.wrench.force.*"))
    measured.push_back({channel, evaluate(channel, scene, truth.snapshot()), 1});
  ASSERT_EQ(measured.size(), 18U);
  wrench.force.setZero();
  wrench.torque.setZero();
  StaticStudy study(scene, 0, {wrench});
  ASSERT_TRUE(study.solve().converged());
  const InverseReport report = solve_inverse(study, study.probe(0), match(measured));
  ASSERT_TRUE(report.reached) << report.why;
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(study.value(study.probe(0)[static_cast<std::size_t>(i)]),
                i < 3 ? force[i] : torque[i - 3], 1e-8);
}

TEST(Inverse, UsesOnlyTheFreedomsThatAreAsked) {
  StaticStudy study(stewart_gough_driven(std::vector<double>(6, 0.4)));
  ASSERT_TRUE(study.solve().converged());
  PoseGoal goal = platform_at({0.01, 0, 0.392}, Vec3::Zero());
  goal.asked = {true, true, true, false, false, false};
  std::vector<Parameter> three{study.drives()[0], study.drives()[2], study.drives()[4]};
  const InverseReport report = solve_inverse(study, three, reach(goal, 0.4));
  ASSERT_TRUE(report.reached) << report.why;
  EXPECT_LT((pose_of(study, {0, Pose{}}).p - Vec3(0.01, 0, 0.392)).norm(), 1e-9);
  EXPECT_EQ(study.value(study.drives()[1]), 0.4);
}

TEST(Inverse, SaysThatAPoseIsOutOfReach) {
  StaticStudy study(stewart_gough_driven(std::vector<double>(6, 0.4)));
  ASSERT_TRUE(study.solve().converged());
  // one leg cannot place a platform held by five others
  const InverseReport report = solve_inverse(study, {study.drives()[0]},
                                             reach(platform_at({0.1, 0, 0.3}, Vec3::Zero()), 0.4));
  EXPECT_FALSE(report.reached);
  EXPECT_FALSE(report.why.empty());
  EXPECT_GT(report.residual, 1e-3);
}

TEST(Inverse, JacobianIsTheDerivativeOfSolvedEquilibria) {
  StaticStudy study(stewart_gough_driven({0.40, 0.41, 0.405, 0.40, 0.395, 0.41}));
  ASSERT_TRUE(study.solve().converged());
  const Goal goal = reach(platform_at(Vec3::Zero(), Vec3::Zero()), 0.4);
  const VecX units = parameter_units(study, study.drives());
  MatX J;
  ASSERT_TRUE(goal_jacobian(study, study.drives(), units, goal, J));
  const double h = 1e-4;
  for (std::size_t i = 0; i < 6; ++i) {
    const Parameter& leg = study.drives()[i];
    const double start = study.value(leg);
    VecX side[2];
    for (int k = 0; k < 2; ++k) {
      study.set(leg, start + (k == 0 ? -h : h) * units[static_cast<Eigen::Index>(i)]);
      ASSERT_TRUE(study.follow().converged());
      side[k] = goal(study);
    }
    study.set(leg, start);
    ASSERT_TRUE(study.follow().converged());
    const VecX difference = (side[1] - side[0]) / (2 * h);
    EXPECT_LT((J.col(static_cast<Eigen::Index>(i)) - difference).norm(), 1e-5 * difference.norm());
  }
}

}  // namespace
}  // namespace cprsim
