// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/expectations.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tools/scratch_folder.h"
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

/// A match of the synthetic height with a file; `error` is put into the file's third row.
CheckResult match_check(double error, double limit, bool rms, double end = 0.4) {
  const ScratchFolder folder;
  std::string text = "time [s],ball.position.z [mm]\n";
  for (int k = 0; k <= 8; ++k) {
    const double t = 0.05 * k, z = height_at(t) + (k == 2 ? error : 0);
    text += std::to_string(t) + "," + std::to_string(1000 * z) + "\n";
  }
  spill(folder / "measured.csv", text);
  Expectation expected = expectation(ExpectKind::kMatch, height());
  expected.reference = (folder / "measured.csv").string();
  (rms ? expected.rms : expected.max) = limit;
  return check(expected, end);
}

TEST(Expectations, MatchATrajectoryAtItsInstantsWithinSteps) {
  // to_string keeps six digits after the point
  EXPECT_EQ(match_check(0, 1e-6, false).verdict, Verdict::kMet);
  const CheckResult off = match_check(0.03, 0.02, false);
  EXPECT_EQ(off.verdict, Verdict::kNotMet);
  EXPECT_NEAR(off.value, 0.03, 1e-6);
  EXPECT_NEAR(off.time, 0.1, 1e-12);
  EXPECT_EQ(match_check(0.03, 0.011, true).verdict, Verdict::kMet);  // 0.03 / 3
  EXPECT_EQ(match_check(0.03, 0.009, true).verdict, Verdict::kNotMet);
  EXPECT_EQ(match_check(0, 1e-6, false, 0.2).verdict, Verdict::kNotReached);
  EXPECT_EQ(match_check(0.03, 0.02, false, 0.2).verdict, Verdict::kNotMet);
}

/// Touches something from 0.12 s to 0.24 s, in steps of 0.04 s.
CheckResult event_check(EventKind kind, double from, double to) {
  Channel contacts = height();
  contacts.name = "contact.count";
  contacts.entity = ChannelEntity::kContact;
  contacts.quantity = Quantity::kContactCount;
  Expectation expected = expectation(ExpectKind::kEvent, contacts);
  expected.event = kind;
  expected.from = from;
  expected.to = to;
  Scene scene = synthetic_scene();
  scene.expects.push_back({"it", {}, {expected}});
  Expectations expectations(scene);
  Snapshot before = synthetic_state(0);
  expectations.begin(before);
  for (int k = 1; k <= 10; ++k) {
    Snapshot now = synthetic_state(0.04 * k);
    now.contact.count = k >= 3 && k <= 6 ? 2 : 0;
    expectations.step(before, now);
    before = now;
  }
  return expectations.results(true).at(0).checks.at(0);
}

TEST(Expectations, EventsComeAboutWithinTheirTimes) {
  EXPECT_EQ(event_check(EventKind::kContact, 0, -1).verdict, Verdict::kMet);
  EXPECT_NEAR(event_check(EventKind::kContact, 0, -1).time, 0.12, 1e-12);
  EXPECT_EQ(event_check(EventKind::kContact, 0.1, 0.2).verdict, Verdict::kMet);
  EXPECT_EQ(event_check(EventKind::kContact, 0, 0.1).verdict, Verdict::kNotMet);
  EXPECT_EQ(event_check(EventKind::kContact, 0.2, 0.4).verdict, Verdict::kNotMet);
  EXPECT_NEAR(event_check(EventKind::kSeparation, 0, -1).time, 0.28, 1e-12);
  EXPECT_EQ(event_check(EventKind::kSeparation, 0, 0.2).verdict, Verdict::kNotMet);
}

TEST(Expectations, EventsThatNeverComeAboutAreNotMet) {
  Expectation expected = expectation(ExpectKind::kEvent, height());
  expected.channels[0].quantity = Quantity::kContactCount;
  expected.channels[0].entity = ChannelEntity::kContact;
  EXPECT_EQ(check(expected).verdict, Verdict::kNotMet);
  EXPECT_EQ(check(expected, 0.2).verdict, Verdict::kNotReached);
}

}  // namespace
}  // namespace cprsim
