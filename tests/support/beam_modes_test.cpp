// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/beam_modes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cprsim {
namespace {

TEST(BeamModes, RootsAreThoseOfTheTables) {
  EXPECT_NEAR(clamped_free_root(1), 1.875104068711961, 1e-14);
  EXPECT_NEAR(clamped_free_root(2), 4.694091132974175, 1e-14);
  EXPECT_NEAR(clamped_free_root(3), 7.854757438237613, 1e-14);
  EXPECT_NEAR(clamped_free_root(12), 11.5 * std::numbers::pi, 1e-12);
}

TEST(BeamModes, FrequencyScalesWithTheLengthSquared) {
  const double f = clamped_free_frequency(1, 2.0, 0.5, 0.4);
  EXPECT_NEAR(f, std::pow(1.875104068711961 / 0.4, 2) * 2, 1e-12);
  EXPECT_NEAR(clamped_free_frequency(1, 2.0, 0.5, 0.8), f / 4, 1e-12);
}

}  // namespace
}  // namespace cprsim
