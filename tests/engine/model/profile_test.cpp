// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cprsim {
namespace {

Profile keyframes(Interpolation interpolation, std::vector<double> times,
                  std::vector<double> values) {
  ProfileTerm term;
  term.shape = ShapeOfTime::kKeyframes;
  term.interpolation = interpolation;
  term.times = std::move(times);
  term.values = std::move(values);
  finish_keyframes(term);
  return Profile{{term}, {}};
}

Profile span(ShapeOfTime shape, double from, double to, double start, double end) {
  ProfileTerm term;
  term.shape = shape;
  term.from = from;
  term.to = to;
  term.start = start;
  term.end = end;
  return Profile{{term}, {}};
}

Profile sine() {
  ProfileTerm term;
  term.shape = ShapeOfTime::kSine;
  term.amplitude = 2;
  term.frequency = 3;
  term.phase = 0.4;
  term.start = 0.1;
  term.end = 0.9;
  return Profile{{term}, {}};
}

Profile trapezoid() {
  Profile profile = span(ShapeOfTime::kTrapezoid, 1, -2, 0.1, 0.9);
  profile.terms[0].acceleration = 1.3 * least_acceleration(profile.terms[0]);
  return profile;
}

Profile chirp() {
  Profile profile = sine();
  profile.terms[0].shape = ShapeOfTime::kChirp;
  profile.terms[0].last_frequency = 7;
  return profile;
}

TEST(Profiles, AreDifferentiatedExactly) {
  const std::vector<Profile> all{span(ShapeOfTime::kRamp, 1, 3, 0.2, 0.7),
                                 span(ShapeOfTime::kSmoothstep, 1, 3, 0.2, 0.7),
                                 sine(),
                                 trapezoid(),
                                 chirp(),
                                 keyframes(Interpolation::kLinear, {0, 0.3, 0.8, 1}, {0, 1, -1, 2}),
                                 keyframes(Interpolation::kPchip, {0, 0.3, 0.8, 1}, {0, 1, 1.5, 2}),
                                 keyframes(Interpolation::kCubic, {0, 0.3, 0.8, 1}, {0, 1, -1, 2})};
  const double h = 1e-6;
  for (std::size_t k = 0; k < all.size(); ++k)
    for (double t = 0.013; t < 1; t += 0.05) {
      const ProfileValue a = all[k].evaluate(t - h), b = all[k].evaluate(t),
                         c = all[k].evaluate(t + h);
      // central differences of exact values: h² f'''/6 with f''' up to 1e4
      EXPECT_NEAR((c.value - a.value) / (2 * h), b.rate, 1e-6 * (1 + std::abs(b.rate)))
          << k << " " << t;
      EXPECT_NEAR((c.rate - a.rate) / (2 * h), b.acceleration,
                  1e-4 * (1 + std::abs(b.acceleration)))
          << k << " " << t;
    }
}

TEST(Profiles, TakeTheSideOfAJumpThatIsAskedFor) {
  ProfileTerm step;
  step.shape = ShapeOfTime::kStep;
  step.from = 1;
  step.to = 0;
  step.start = 0;
  const Profile released{{step}, {}};
  EXPECT_EQ(released.evaluate(0).value, 0);
  EXPECT_EQ(released.evaluate(0, true).value, 1);
  const Profile ramp = span(ShapeOfTime::kRamp, 0, 1, 0, 2);
  EXPECT_EQ(ramp.evaluate(0).rate, 0.5);
  EXPECT_EQ(ramp.evaluate(0, true).rate, 0);
  const Profile stairs = keyframes(Interpolation::kStep, {0, 1, 2}, {3, 4, 5});
  EXPECT_EQ(stairs.evaluate(1).value, 4);
  EXPECT_EQ(stairs.evaluate(1, true).value, 3);
  EXPECT_EQ(stairs.evaluate(2).value, 5);
  EXPECT_EQ(stairs.evaluate(-1).value, 3);
}

TEST(Profiles, AddUp) {
  Profile sum = span(ShapeOfTime::kSmoothstep, 0, 0.04, 0.2, 1.2);
  ProfileTerm constant;
  constant.value = 0.4;
  sum.terms.push_back(constant);
  EXPECT_EQ(sum.evaluate(0).value, 0.4);
  EXPECT_DOUBLE_EQ(sum.evaluate(0.7).value, 0.42);
  EXPECT_EQ(sum.evaluate(9).value, 0.44);
}

TEST(Profiles, KnowWhereTheyAreNotSmooth) {
  EXPECT_EQ(span(ShapeOfTime::kRamp, 0, 1, 0, 2).breakpoints(5), (std::vector<double>{0, 2}));
  EXPECT_EQ(span(ShapeOfTime::kRamp, 0, 1, 1, 9).breakpoints(5), (std::vector<double>{1}));
  EXPECT_TRUE(span(ShapeOfTime::kSmoothstep, 0, 1, 1, 2).breakpoints(5).empty());
  EXPECT_EQ(keyframes(Interpolation::kCubic, {0, 1, 2}, {0, 1, 0}).breakpoints(5),
            (std::vector<double>{0, 2}));
  EXPECT_EQ(keyframes(Interpolation::kPchip, {-1, 1, 2}, {0, 1, 0}).breakpoints(5),
            (std::vector<double>{1, 2}));
  Profile twice = span(ShapeOfTime::kRamp, 0, 1, 1, 2);
  twice.terms.push_back(twice.terms[0]);
  EXPECT_EQ(twice.breakpoints(5), (std::vector<double>{1, 2}));
}

TEST(Trapezoid, ArrivesInTimeWithTheAccelerationGiven) {
  const Profile p = trapezoid();
  const ProfileTerm& term = p.terms[0];
  EXPECT_NEAR(p.evaluate(0.9, true).value, -2, 1e-14);
  EXPECT_NEAR(p.evaluate(0.5).value, -0.5, 1e-14);  // by symmetry
  EXPECT_NEAR(p.evaluate(0.9, true).rate, 0, 1e-14);
  const std::vector<double> corners = p.breakpoints(1);
  ASSERT_EQ(corners.size(), 4u);
  for (const double t : corners) {  // continuous in value and rate
    EXPECT_NEAR(p.evaluate(t).value, p.evaluate(t, true).value, 1e-14);
    EXPECT_NEAR(p.evaluate(t).rate, p.evaluate(t, true).rate, 1e-13);
  }
  EXPECT_DOUBLE_EQ(p.evaluate(0.11).acceleration, -term.acceleration);
  EXPECT_DOUBLE_EQ(p.evaluate(0.89).acceleration, term.acceleration);
  EXPECT_EQ(p.evaluate(0.5).acceleration, 0);
}

TEST(Chirp, PassesFromOneFrequencyToTheOther) {
  const Profile p = chirp();
  // zero crossings with rate ± amplitude times the frequency of the moment
  EXPECT_NEAR(p.evaluate(0.1).rate, 2 * 2 * std::numbers::pi * 3, 1e-12);
  const ProfileValue end = p.evaluate(0.9, true);
  const double w = 2 * std::numbers::pi * 7;
  EXPECT_NEAR(std::hypot(end.value, end.rate / w), 2, 1e-12);
  EXPECT_EQ(p.evaluate(0.9).value, 0);
}

TEST(Keyframes, PassThroughTheirPoints) {
  const std::vector<double> times{0, 0.5, 1.5, 2}, values{1, -1, 4, 4};
  for (const Interpolation i :
       {Interpolation::kLinear, Interpolation::kPchip, Interpolation::kCubic})
    for (std::size_t k = 0; k < times.size(); ++k) {
      EXPECT_DOUBLE_EQ(keyframes(i, times, values).evaluate(times[k]).value, values[k]);
      EXPECT_DOUBLE_EQ(keyframes(i, times, values).evaluate(times[k], true).value, values[k]);
    }
}

TEST(Keyframes, PchipKeepsMonotoneDataMonotone) {
  const Profile p = keyframes(Interpolation::kPchip, {0, 1, 2, 3, 4}, {0, 0, 0.01, 5, 5});
  for (double t = 0; t < 4; t += 0.01) {
    EXPECT_GE(p.evaluate(t).rate, 0) << t;
    EXPECT_LE(p.evaluate(t).value, 5) << t;
  }
}

TEST(Keyframes, NaturalSplineHasContinuousSecondDerivativeThatVanishesAtTheEnds) {
  const Profile p = keyframes(Interpolation::kCubic, {0, 0.5, 1.5, 2}, {1, -1, 4, 0});
  for (const double t : {0.5, 1.5})
    EXPECT_NEAR(p.evaluate(t).acceleration, p.evaluate(t, true).acceleration, 1e-11);
  EXPECT_NEAR(p.evaluate(0).acceleration, 0, 1e-12);
  EXPECT_NEAR(p.evaluate(2, true).acceleration, 0, 1e-12);
}

TEST(Keyframes, OneOfThemIsAConstant) {
  for (const Interpolation i :
       {Interpolation::kStep, Interpolation::kLinear, Interpolation::kPchip})
    for (const double t : {-1.0, 0.5, 7.0})
      EXPECT_EQ(keyframes(i, {0.5}, {3}).evaluate(t).value, 3);
}

}  // namespace
}  // namespace cprsim
