// SPDX-License-Identifier: BSD-3-Clause
// Frequencies, amplitudes and damping of motions that are known in closed form.
#include "tools/series/vibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cprsim {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

struct Samples {
  std::vector<double> time, value;
};

template <typename Motion>
Samples sampled(double duration, std::size_t count, const Motion& motion) {
  Samples s;
  for (std::size_t k = 0; k < count; ++k) {
    s.time.push_back(duration * static_cast<double>(k) / static_cast<double>(count - 1));
    s.value.push_back(motion(s.time.back()));
  }
  return s;
}

TEST(Vibration, OfAHarmonicMotionIsItsOwn) {
  const Samples s =
      sampled(3, 1001, [](double t) { return 0.02 * std::cos(kTurn * 8.7 * t + 0.4); });
  const auto found = find_vibration(s.time, s.value);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->frequency, 8.7, 1e-4);
  EXPECT_NEAR(found->amplitude, 0.02, 2e-5);
  ASSERT_TRUE(found->damping_ratio);
  EXPECT_NEAR(*found->damping_ratio, 0, 1e-5);
}

TEST(Vibration, DampingIsThatOfTheDecayEvenOnADriftingRecord) {
  for (const double zeta : {0.002, 0.01, 0.05}) {
    const double natural = kTurn * 5, damped = natural * std::sqrt(1 - zeta * zeta);
    const Samples s = sampled(4, 4001, [&](double t) {
      return 0.3 + 0.01 * t + 0.1 * std::exp(-zeta * natural * t) * std::cos(damped * t);
    });
    const auto found = find_vibration(s.time, s.value);
    ASSERT_TRUE(found) << zeta;
    EXPECT_NEAR(found->frequency, damped / kTurn, 5e-3) << zeta;
    ASSERT_TRUE(found->damping_ratio) << zeta;
    EXPECT_NEAR(*found->damping_ratio, zeta, 0.02 * zeta + 1e-5);
  }
}

TEST(Vibration, TheStrongerOfTwoFrequenciesIsTaken) {
  const Samples s = sampled(
      2, 2001, [](double t) { return std::cos(kTurn * 11 * t) + 0.3 * std::cos(kTurn * 47 * t); });
  const auto found = find_vibration(s.time, s.value);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->frequency, 11, 1e-3);
  EXPECT_NEAR(found->amplitude, 1, 1e-3);
}

TEST(Vibration, SamplesNeedNotBeEven) {
  Samples s;
  for (int k = 0; k < 2000; ++k) {
    s.time.push_back(2 * (k + 0.4 * std::sin(1.0 * k)) / 2000);
    s.value.push_back(std::cos(kTurn * 9 * s.time.back()));
  }
  const auto found = find_vibration(s.time, s.value);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->frequency, 9, 1e-3);
}

TEST(Vibration, WhatDoesNotVibrateHasNone) {
  const auto none = [](const Samples& s) { return !find_vibration(s.time, s.value).has_value(); };
  EXPECT_TRUE(none(sampled(1, 500, [](double) { return 2.0; })));
  EXPECT_TRUE(none(sampled(1, 500, [](double t) { return 3 * t; })));
  EXPECT_TRUE(none(sampled(1, 500, [](double t) { return t * t; })));
  // two periods and a half
  EXPECT_TRUE(none(sampled(1, 500, [](double t) { return std::sin(kTurn * 2.5 * t); })));
  // as many frequencies of one size as there is room for
  unsigned state = 1;
  EXPECT_TRUE(none(sampled(1, 2000, [&](double) {
    state = 1664525U * state + 1013904223U;
    return static_cast<double>(state) / 4294967296.0 - 0.5;
  })));
}

TEST(Vibration, FewPeriodsTellNoDamping) {
  const Samples s = sampled(1, 500, [](double t) { return std::sin(kTurn * 5 * t); });
  const auto found = find_vibration(s.time, s.value);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->damping_ratio);
}

}  // namespace
}  // namespace cprsim
