// SPDX-License-Identifier: BSD-3-Clause
// The search: finds minima inside and at bounds, and survives points without an answer.
#include "engine/fit/least_squares.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "engine/fit/fit_parameter.h"

namespace cprsim {
namespace {

class Formula final : public LeastSquaresProblem {
 public:
  using Function = std::function<bool(const VecX&, VecX&)>;

  explicit Formula(Function f, double lowest = -1e300, double highest = 1e300)
      : f_(std::move(f)), lowest_(lowest), highest_(highest) {}

  bool residuals(const VecX& z, VecX& r) override { return f_(z, r); }

  bool derivative(const VecX& z, const VecX& r, MatX& J) override {
    const VecX low = VecX::Constant(z.size(), lowest_), high = VecX::Constant(z.size(), highest_);
    return difference_jacobian(*this, z, r, 1e-5, low, high, J);
  }

 private:
  Function f_;
  double lowest_, highest_;
};

VecX two(double a, double b) {
  return (VecX(2) << a, b).finished();
}

const VecX kNoLow = VecX::Constant(2, -1e300), kNoHigh = VecX::Constant(2, 1e300);

bool rosenbrock(const VecX& z, VecX& r) {
  r = two(10 * (z[1] - z[0] * z[0]), 1 - z[0]);
  return true;
}

TEST(LeastSquares, FollowsABentValley) {
  Formula problem(rosenbrock);
  const FitReport report = fit(problem, two(-1.2, 1), kNoLow, kNoHigh, {});
  EXPECT_TRUE(report.converged()) << to_string(report.status);
  EXPECT_LT((report.z - two(1, 1)).norm(), 1e-7);
  EXPECT_NEAR(report.start_sum, 24.2, 1e-9);
}

TEST(LeastSquares, StopsAtABoundAndMinimisesAlongIt) {
  // with z0 <= 0.5 the least sum is at (0.5, 0.25)
  Formula problem(rosenbrock);
  const FitReport report = fit(problem, two(-1.2, 1), two(-2, -2), two(0.5, 2), {});
  EXPECT_TRUE(report.converged()) << to_string(report.status);
  EXPECT_TRUE(report.at_bound[0]);
  EXPECT_FALSE(report.at_bound[1]);
  EXPECT_EQ(report.z[0], 0.5);
  EXPECT_NEAR(report.z[1], 0.25, 1e-7);
}

TEST(LeastSquares, LeavesABoundItStartsAt) {
  Formula problem(rosenbrock);
  const FitReport report = fit(problem, two(-1.2, 1), two(-1.2, -2), two(2, 2), {});
  EXPECT_TRUE(report.converged()) << to_string(report.status);
  EXPECT_LT((report.z - two(1, 1)).norm(), 1e-7);
}

TEST(LeastSquares, RefusesStepsToWhereThereIsNoAnswer) {
  // from 0 Newton's step for exp(z) = 2 is 1; the answer ends between there and ln 2
  Formula problem([](const VecX& z, VecX& r) {
    r = VecX::Constant(1, std::exp(z[0]) - 2);
    return z[0] < 0.8;
  });
  const VecX low = VecX::Constant(1, -9.0), high = VecX::Constant(1, 9.0);
  const FitReport report = fit(problem, VecX::Zero(1), low, high, {});
  EXPECT_TRUE(report.converged()) << to_string(report.status);
  EXPECT_NEAR(report.z[0], std::log(2.0), 1e-7);
  EXPECT_GT(report.rejected, 0);
}

TEST(LeastSquares, SaysThatItStalledWhereTheAnswersEnd) {
  // the minimum lies where there is no answer
  Formula problem([](const VecX& z, VecX& r) { return z[0] < 0.5 && rosenbrock(z, r); });
  const FitReport report = fit(problem, two(-1.2, 1), kNoLow, kNoHigh, {});
  EXPECT_FALSE(report.converged());
  EXPECT_LE(report.sum, report.start_sum);
}

TEST(LeastSquares, SaysThatThereIsNoStart) {
  Formula problem([](const VecX&, VecX&) { return false; });
  EXPECT_EQ(fit(problem, two(0, 0), kNoLow, kNoHigh, {}).status, FitStatus::kNoStart);
}

TEST(LeastSquares, EndsAtTheIterationLimit) {
  Formula problem(rosenbrock);
  FitOptions options;
  options.max_iterations = 2;
  EXPECT_EQ(fit(problem, two(-1.2, 1), kNoLow, kNoHigh, options).status,
            FitStatus::kIterationLimit);
}

TEST(LeastSquares, LeavesAloneWhatNothingDependsOn) {
  Formula problem([](const VecX& z, VecX& r) {
    r = two(std::exp(z[0]) - 2, z[0] - 1);
    return true;
  });
  const FitReport report = fit(problem, two(1, 3), kNoLow, kNoHigh, {});
  EXPECT_TRUE(report.converged()) << to_string(report.status);
  EXPECT_EQ(report.z[1], 3);
}

TEST(Differences, HaveSecondOrderInsideAndAtABound) {
  const auto f = [](const VecX& z, VecX& r) {
    r = (VecX(1) << std::exp(z[0])).finished();
    return true;
  };
  Formula problem(f);
  const VecX z = VecX::Zero(1), wide = VecX::Constant(1, 9.0);
  VecX r;
  problem.residuals(z, r);
  for (const VecX& low : {VecX(-wide), VecX(z)}) {
    MatX J;
    double errors[2];
    for (const int k : {0, 1}) {
      ASSERT_TRUE(difference_jacobian(problem, z, r, k == 0 ? 2e-3 : 1e-3, low, wide, J));
      errors[k] = std::abs(J(0, 0) - 1);
    }
    EXPECT_NEAR(errors[0] / errors[1], 4, 0.05);
    EXPECT_LT(errors[1], 1e-6);
  }
}

TEST(Parameter, IsLogarithmicWhereItsBoundsAreWideAndPositive) {
  FitParameter p{"E", 3e9, 1e9, 1e11};
  EXPECT_TRUE(p.logarithmic());
  EXPECT_NEAR(p.value(1 + std::log(2.0)), 6e9, 1e-3);
  p.high = 5e9;
  EXPECT_FALSE(p.logarithmic());
  EXPECT_NEAR(p.value(1.5), 4e9, 1e-3);
  EXPECT_EQ(p.value(100), 5e9);
  const FitParameter free{"x", -0.2};
  EXPECT_NEAR(free.value(2), 0, 1e-16);
  for (const FitParameter& each : {p, free, FitParameter{"E", 3e9, 1e9, 1e11}}) {
    const double h = 1e-6, z = 1.1;
    EXPECT_NEAR(each.coordinate(each.value(z)), z, 1e-12);
    EXPECT_NEAR((each.value(z + h) - each.value(z - h)) / (2 * h) / each.slope(z), 1, 1e-8);
  }
}

}  // namespace
}  // namespace cprsim
