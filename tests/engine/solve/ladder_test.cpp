// SPDX-License-Identifier: BSD-3-Clause
// Continuation, relaxation and the ladder of all four.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/solve/newton.h"
#include "tests/engine/solve/small_problem.h"

namespace cprsim {
namespace {

/// x = fraction, but nothing can be evaluated farther than `sight` from it.
SmallProblem short_sighted(double sight) {
  const auto f = [sight](const VecX& x, double fraction) {
    const double r = x[0] - fraction;
    return vector1(std::abs(r) > sight ? std::numeric_limits<double>::quiet_NaN() : r);
  };
  return {vector1(0), f, [](const VecX&) -> MatX { return vector1(1); }};
}

/// Downhill of (x² - 1)² / 4: stable at -1 and 1, unstable at 0.
SmallProblem double_well(double start) {
  return scalar_problem(
      start, [](double x) { return x * x * x - x; }, [](double x) { return 3 * x * x - 1; });
}

TEST(Continuation, WalksWhereASingleSolveCannotSee) {
  for (double sight : {0.3, 0.2, 0.05}) {
    SmallProblem problem = short_sighted(sight);
    ASSERT_EQ(newton(problem, {}).status, SolveStatus::kNotFinite);
    problem.restart();
    const SolveReport r = continuation(problem, {});
    EXPECT_TRUE(r.converged()) << sight;
    EXPECT_EQ(r.stage, SolveStage::kContinuation);
    EXPECT_NEAR(problem.x[0], 1, 1e-9);  // the tolerance
    EXPECT_EQ(problem.fractions.back(), 1);
  }
}

TEST(Continuation, GivesUpWhenTheWayIsBarred) {
  SmallProblem problem = short_sighted(1e-4);
  const SolveReport r = continuation(problem, {});
  EXPECT_FALSE(r.converged());
  EXPECT_EQ(problem.fractions.back(), 1);  // the problem is left as it was asked
  EXPECT_FALSE(problem.moved_blindly);
}

TEST(Continuation, DoublesItsStepWhileAllGoesWell) {
  SmallProblem problem = rosenbrock();
  EXPECT_TRUE(continuation(problem, {}).converged());
  EXPECT_EQ(problem.fractions, (std::vector<double>{0.25, 0.75, 1, 1}));
}

TEST(Relaxation, EndsInAStableEquilibrium) {
  // Newton goes to the nearest root, stable or not
  SmallProblem problem = double_well(0.1);
  ASSERT_TRUE(newton(problem, {}).converged());
  EXPECT_NEAR(problem.x[0], 0, 1e-9);
  for (double start : {0.1, -0.1, 3.0}) {
    SmallProblem relaxed = double_well(start);
    const SolveReport r = relaxation(relaxed, {});
    EXPECT_TRUE(r.converged()) << start;
    EXPECT_EQ(r.stage, SolveStage::kRelaxation);
    EXPECT_NEAR(relaxed.x[0], start > 0 ? 1 : -1, 1e-9) << start;
  }
}

TEST(Relaxation, NeverClaimsAnEquilibriumThatIsNotThere) {
  SmallProblem problem = scalar_problem(
      0.5, [](double x) { return x * x + 1; }, [](double x) { return 2 * x; });
  const SolveReport r = relaxation(problem, {});
  EXPECT_FALSE(r.converged());
}

TEST(Ladder, StopsAtTheFirstRungThatHolds) {
  SmallProblem problem = rosenbrock();
  const SolveReport r = solve_statics(problem, {});
  EXPECT_TRUE(r.converged());
  EXPECT_EQ(r.stage, SolveStage::kNewton);
}

TEST(Ladder, ClimbsWhenARungBreaks) {
  SmallProblem problem = short_sighted(0.2);
  const SolveReport r = solve_statics(problem, {});
  EXPECT_TRUE(r.converged());
  EXPECT_EQ(r.stage, SolveStage::kContinuation);
  EXPECT_NEAR(problem.x[0], 1, 1e-9);
}

TEST(Ladder, LeavesAnUnsolvableProblemAtItsStart) {
  SmallProblem problem = scalar_problem(
      0.5, [](double x) { return x * x + 1; }, [](double x) { return 2 * x; });
  const SolveReport r = solve_statics(problem, {});
  EXPECT_FALSE(r.converged());
  EXPECT_EQ(problem.x[0], 0.5);
  EXPECT_EQ(r.initial_residual, 1.25);
  EXPECT_GT(r.residual, 1e-9);
}

TEST(Ladder, EndsWhereItsWorkIsUsedUp) {
  constexpr long kOneIteration = 24;  // evaluations of a step that is shortened to 1/1024, twice
  for (const auto solve :
       {newton, levenberg_marquardt, continuation, hardening, relaxation, solve_statics}) {
    SmallProblem problem = scalar_problem(
        0.5, [](double x) { return x * x + 1; }, [](double x) { return 2 * x; });
    SolveOptions options;
    options.max_iterations = 1'000'000;
    for (const long most : {0L, 3L, 30L}) {
      problem.restart();
      options.most_work = problem.work() + most;
      const SolveReport r = solve(problem, options);
      if (solve == newton && r.status == SolveStatus::kStalled) continue;  // sooner
      EXPECT_EQ(r.status, SolveStatus::kWorkLimit) << most;
      EXPECT_LE(problem.work(), options.most_work + kOneIteration) << most;
    }
  }
  SmallProblem valley = rosenbrock();
  SolveOptions enough;
  enough.most_work = 1000;
  EXPECT_TRUE(solve_statics(valley, enough).converged());
}

TEST(Ladder, EveryStatusAndStageHasAName) {
  EXPECT_STREQ(to_string(SolveStatus::kConverged), "converged");
  EXPECT_STREQ(to_string(SolveStatus::kStalled), "stalled");
  EXPECT_STREQ(to_string(SolveStatus::kIterationLimit), "iteration limit");
  EXPECT_STREQ(to_string(SolveStatus::kNotFinite), "not finite");
  EXPECT_STREQ(to_string(SolveStatus::kSingular), "singular");
  EXPECT_STREQ(to_string(SolveStatus::kWorkLimit), "work limit");
  EXPECT_STREQ(to_string(SolveStage::kNewton), "Newton");
  EXPECT_STREQ(to_string(SolveStage::kRelaxation), "relaxation");
}

}  // namespace
}  // namespace cprsim
