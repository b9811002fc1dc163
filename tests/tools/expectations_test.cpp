// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/expectations.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tools/synthetic.h"

namespace cprsim {
namespace {

Expectation expectation(ExpectKind kind, const Channel& channel) {
  Expectation expected;
  expected.kind = kind;
  expected.channels = {channel};
  return expected;
}

/// The only check of a scene that expects just this of the synthetic run.
CheckResult check(const Expectation& expected, double end = 0.4) {
  Scene scene = synthetic_scene();
  scene.expects.push_back({"it", {}, {expected}});
  Expectations expectations(scene);
  play(expectations, end);
  return expectations.results(true).at(0).checks.at(0);
}

TEST(Expectations, CompareAValueAtExactlyItsInstant) {
  Expectation expected = expectation(ExpectKind::kValue, height());
  expected.at = 0.21;  // within a step
  expected.equals = {height_at(0.21)};
  expected.tolerance = 1e-12;
  EXPECT_EQ(check(expected).verdict, Verdict::kMet);
  EXPECT_EQ(check(expected).time, 0.21);
  expected.equals = {height_at(0.21) + 1e-6};
  EXPECT_EQ(check(expected).verdict, Verdict::kNotMet);
}

TEST(Expectations, LookAtValuesAtTheVeryStartAndEnd) {
  Expectation expected = expectation(ExpectKind::kValue, height());
  for (const double at : {0.0, 0.4}) {
    expected.at = at;
    expected.equals = {height_at(at)};
    expected.tolerance = 1e-12;
    EXPECT_EQ(check(expected).verdict, Verdict::kMet) << at;
  }
}

TEST(Expectations, ReportWhereABoundIsBrokenMost) {
  Expectation expected = expectation(ExpectKind::kBound, height());
  expected.max = 1.1;  // the top is 1.2 at 0.2 s
  const CheckResult result = check(expected);
  EXPECT_EQ(result.verdict, Verdict::kNotMet);
  EXPECT_NEAR(result.time, 0.2, 1e-12);
  EXPECT_NEAR(result.value, 1.2, 1e-12);
  EXPECT_EQ(result.limit, "max 1.1");
  EXPECT_EQ(result.channel, "ball.position.z");
}

TEST(Expectations, HoldABoundOnlyBetweenItsInstants) {
  Expectation expected = expectation(ExpectKind::kBound, height());
  expected.min = height_at(0.33) - 1e-12;
  expected.from = 0.1;
  expected.to = 0.33;  // later it falls below
  EXPECT_EQ(check(expected).verdict, Verdict::kMet);
  expected.to = 0.34;
  EXPECT_EQ(check(expected).verdict, Verdict::kNotMet);
}

TEST(Expectations, SayThatAnInstantWasNotReached) {
  Expectation expected = expectation(ExpectKind::kBound, height());
  expected.max = 2;
  EXPECT_EQ(check(expected, 0.4).verdict, Verdict::kMet);
  EXPECT_EQ(check(expected, 0.2).verdict, Verdict::kNotReached);
  expected.from = 0.3;  // begins after the end of the run
  expected.to = 0.2;
  EXPECT_EQ(check(expected, 0.2).verdict, Verdict::kNotReached);
  expected.from = 0;
  expected.to = -1;
  expected.max = 1.1;  // what is broken is broken
  EXPECT_EQ(check(expected, 0.2).verdict, Verdict::kNotMet);
}

TEST(Expectations, MeasureDriftFromItsFirstInstant) {
  Expectation expected = expectation(ExpectKind::kDrift, height());
  expected.from = 0.2;
  expected.below = 1.2 - height_at(0.4) + 1e-9;
  EXPECT_EQ(check(expected).verdict, Verdict::kMet);
  expected.below = 1.2 - height_at(0.4) - 1e-9;
  EXPECT_EQ(check(expected).verdict, Verdict::kNotMet);
}

TEST(Expectations, CountIterationsOfStepsNotOfTheStart) {
  Scene scene = synthetic_scene();
  Expectation expected = expectation(ExpectKind::kBound, iterations());
  expected.max = 3;
  scene.expects.push_back({"it", {}, {expected}});
  Expectations expectations(scene);
  Snapshot start = synthetic_state(0);
  start.solver.iterations = 40;
  expectations.begin(start);
  expectations.step(start, synthetic_state(0.4));
  EXPECT_EQ(expectations.results(true)[0].verdict, Verdict::kMet);
}

TEST(Expectations, NeverTakeNotANumberForMet) {
  Scene scene = synthetic_scene();
  Expectation expected = expectation(ExpectKind::kBound, height());
  expected.max = 100;
  scene.expects.push_back({"it", {}, {expected}});
  Expectations expectations(scene);
  const Snapshot start = synthetic_state(0);
  Snapshot broken = synthetic_state(0.4);
  broken.bodies[0].X_WB.p.z() = std::nan("");
  expectations.begin(start);
  expectations.step(start, broken);
  EXPECT_EQ(expectations.results(true)[0].verdict, Verdict::kNotMet);
}

TEST(Expectations, AreNotMetAsAWholeIfOneCheckIsNot) {
  Scene scene = synthetic_scene();
  Expectation met = expectation(ExpectKind::kBound, height());
  met.max = 2;
  const Expectation converged = expectation(ExpectKind::kConverged, height());
  scene.expects.push_back({"both", {}, {met, converged, met}});
  Expectations expectations(scene);
  play(expectations);
  EXPECT_EQ(expectations.results(true)[0].verdict, Verdict::kMet);
  EXPECT_EQ(expectations.results(false)[0].verdict, Verdict::kNotMet);
}

}  // namespace
}  // namespace cprsim
