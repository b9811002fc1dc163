// SPDX-License-Identifier: BSD-3-Clause
#include "engine/solve/newton.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/solve/small_problem.h"

namespace cprsim {
namespace {

SmallProblem arctangent(double start) {
  return scalar_problem(
      start, [](double x) { return std::atan(x); }, [](double x) { return 1 / (1 + x * x); });
}

SmallProblem no_root(double start) {
  return scalar_problem(
      start, [](double x) { return x * x + 1; }, [](double x) { return 2 * x; });
}

SmallProblem logarithm(double start) {
  return scalar_problem(
      start, [](double x) { return std::log(x); }, [](double x) { return 1 / x; });
}

void expect_consistent(const SolveReport& r, const SolveOptions& options) {
  EXPECT_EQ(r.converged(), r.status == SolveStatus::kConverged);
  if (r.converged()) {
    EXPECT_LE(r.residual, options.tolerance);
  } else {
    EXPECT_GT(r.residual, options.tolerance);
  }
  if (r.status == SolveStatus::kIterationLimit) {
    EXPECT_GE(r.iterations, options.max_iterations);
  }
  EXPECT_EQ(r.history.front(), r.initial_residual);
  EXPECT_EQ(r.history.back(), r.residual);
  EXPECT_GT(r.evaluations, 0);
  EXPECT_EQ(r.worst_row, "the worst row");
}

TEST(Newton, FindsTheRootOfRosenbrocksValley) {
  SmallProblem problem = rosenbrock();
  const SolveReport r = newton(problem, {});
  expect_consistent(r, {});
  EXPECT_EQ(r.status, SolveStatus::kConverged);
  EXPECT_LT((problem.x - Vec2(1, 1)).norm(), 1e-9);  // the tolerance
  EXPECT_LE(r.iterations, 3);  // two full steps, of which the first raises the merit
}

TEST(Newton, ConvergesQuadratically) {
  SmallProblem problem = scalar_problem(
      1.0, [](double x) { return std::exp(x) - 2; }, [](double x) { return std::exp(x); });
  SolveOptions options;
  options.tolerance = 1e-14;
  const SolveReport r = newton(problem, options);
  ASSERT_TRUE(r.converged());
  // f = e^x - 2 near its root: f_next = f² / 4 to first order
  const std::vector<double>& h = r.history;
  for (std::size_t i = 2; i + 1 < h.size(); ++i)
    EXPECT_LT(h[i], 0.26 * h[i - 1] * h[i - 1] + 1e-15) << i;
}

TEST(Newton, ShortensStepsThatLeadAway) {
  // full steps on arctan alternate and grow from |x| > 1.39
  for (double start : {1.5, 3.0, -8.0, 20.0}) {
    SmallProblem problem = arctangent(start);
    const SolveReport r = newton(problem, {});
    expect_consistent(r, {});
    EXPECT_EQ(r.status, SolveStatus::kConverged) << start;
    EXPECT_LT(std::abs(problem.x[0]), 1e-9);
    EXPECT_LT(r.residual, r.initial_residual);
  }
}

TEST(Newton, ComesBackFromWhereTheResidualIsNotFinite) {
  SmallProblem problem = logarithm(5);  // the full step ends at -3
  const SolveReport r = newton(problem, {});
  expect_consistent(r, {});
  EXPECT_TRUE(r.converged());
  EXPECT_NEAR(problem.x[0], 1, 1e-9);
}

TEST(Newton, SaysThatTheResidualIsNotFinite) {
  SmallProblem problem = logarithm(-1);
  const SolveReport r = newton(problem, {});
  EXPECT_EQ(r.status, SolveStatus::kNotFinite);
  EXPECT_EQ(r.iterations, 0);
  EXPECT_FALSE(problem.moved_blindly);
}

TEST(Newton, SaysThatTheJacobianIsSingular) {
  SmallProblem problem = no_root(0);
  const SolveReport r = newton(problem, {});
  expect_consistent(r, {});
  EXPECT_EQ(r.status, SolveStatus::kSingular);
  EXPECT_EQ(problem.x[0], 0);
  EXPECT_FALSE(problem.moved_blindly);
}

TEST(Newton, SaysThatItHasRunOutOfIterations) {
  SmallProblem problem = arctangent(20);
  SolveOptions options;
  options.max_iterations = 1;
  const SolveReport r = newton(problem, options);
  expect_consistent(r, options);
  EXPECT_EQ(r.status, SolveStatus::kIterationLimit);
}

TEST(Newton, MakesAsManyIterationsAsItMay) {
  for (const int most : {0, 1, 2})
    for (const auto& solve : {newton, levenberg_marquardt}) {
      SmallProblem problem = scalar_problem(
          1.0, [](double x) { return std::exp(x) - 2; }, [](double x) { return std::exp(x); });
      SolveOptions options;
      options.max_iterations = most;
      const SolveReport r = solve(problem, options);
      expect_consistent(r, options);
      EXPECT_EQ(r.status, SolveStatus::kIterationLimit);
      EXPECT_EQ(r.iterations, most);
      EXPECT_EQ(r.history.size(), static_cast<std::size_t>(most) + 1);
    }
}

TEST(Newton, NeverClaimsARootThatIsNotThere) {
  for (double start : {3.0, 0.3, -1.0}) {
    SmallProblem problem = no_root(start);
    const SolveReport r = newton(problem, {});
    expect_consistent(r, {});
    EXPECT_FALSE(r.converged());
    EXPECT_GE(r.residual, 1);
  }
}

TEST(Newton, GivesUpAtOnceAboveTheLargestMerit) {
  SmallProblem problem = rosenbrock();
  SolveOptions options;
  options.max_merit = 1e-3;
  const SolveReport r = newton(problem, options);
  EXPECT_FALSE(r.converged());
  EXPECT_EQ(r.iterations, 0);
}

TEST(Newton, AlreadySolvedTakesNoIteration) {
  SmallProblem problem = arctangent(1e-10);
  const SolveReport r = newton(problem, {});
  EXPECT_TRUE(r.converged());
  EXPECT_EQ(r.iterations, 0);
  EXPECT_EQ(r.factorizations, 0);
  EXPECT_EQ(problem.x[0], 1e-10);
}

TEST(LevenbergMarquardt, FindsTheRootOfRosenbrocksValley) {
  SmallProblem problem = rosenbrock();
  SolveOptions options;
  options.max_iterations = 100;
  const SolveReport r = levenberg_marquardt(problem, options);
  expect_consistent(r, options);
  EXPECT_TRUE(r.converged());
  EXPECT_LT((problem.x - Vec2(1, 1)).norm(), 1e-8);
  EXPECT_EQ(r.stage, SolveStage::kLevenbergMarquardt);
}

TEST(LevenbergMarquardt, NeverRaisesTheResidualOfOneUnknown) {
  for (double start : {1.5, -8.0, 20.0}) {
    SmallProblem problem = arctangent(start);
    SolveOptions options;
    options.max_iterations = 100;
    const SolveReport r = levenberg_marquardt(problem, options);
    EXPECT_TRUE(r.converged()) << start;
    for (std::size_t i = 1; i < r.history.size(); ++i)
      EXPECT_LE(r.history[i], r.history[i - 1]);
  }
}

// Powell's singular function: the Jacobian has rank two at the root.
TEST(LevenbergMarquardt, ReachesARootWithASingularJacobian) {
  const auto f = [](const VecX& x, double) -> VecX {
    return Vec4(x[0] + 10 * x[1], std::sqrt(5.) * (x[2] - x[3]), std::pow(x[1] - 2 * x[2], 2),
                std::sqrt(10.) * std::pow(x[0] - x[3], 2));
  };
  const auto J = [](const VecX& x) -> MatX {
    const double a = 2 * (x[1] - 2 * x[2]), b = 2 * std::sqrt(10.) * (x[0] - x[3]);
    MatX m(4, 4);
    m << 1, 10, 0, 0, 0, 0, std::sqrt(5.), -std::sqrt(5.), 0, a, -2 * a, 0, b, 0, 0, -b;
    return m;
  };
  SmallProblem problem(Vec4(3, -1, 0, 1), f, J);
  SolveOptions options;
  options.max_iterations = 200;
  const SolveReport r = levenberg_marquardt(problem, options);
  expect_consistent(r, options);
  EXPECT_TRUE(r.converged());
  EXPECT_LT(problem.x.norm(), 1e-3);  // squares: the root of the tolerance and more
}

TEST(LevenbergMarquardt, StallsInAMinimumThatIsNoRoot) {
  for (double start : {2.0, 0.0}) {
    SmallProblem problem = no_root(start);
    SolveOptions options;
    options.max_iterations = 500;
    const SolveReport r = levenberg_marquardt(problem, options);
    expect_consistent(r, options);
    EXPECT_EQ(r.status, SolveStatus::kStalled);
    EXPECT_NEAR(problem.x[0], 0, 1e-6);
  }
}

TEST(LevenbergMarquardt, StiffensUntilThereIsADirection) {
  SmallProblem problem = arctangent(2);
  problem.smallest_mu = 0.05;
  SolveOptions options;
  options.max_iterations = 100;
  const SolveReport r = levenberg_marquardt(problem, options);
  EXPECT_FALSE(problem.moved_blindly);
  EXPECT_LT(r.residual, r.initial_residual);
}

TEST(LevenbergMarquardt, SaysThatTheResidualIsNotFinite) {
  SmallProblem problem = logarithm(-1);
  EXPECT_EQ(levenberg_marquardt(problem, {}).status, SolveStatus::kNotFinite);
}

}  // namespace
}  // namespace cprsim
