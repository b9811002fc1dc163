// SPDX-License-Identifier: BSD-3-Clause
// A number that a hard case measures, and the most it may be: checked here, and left in the test's
// record, from which page.py makes docs/stability.md.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace cprsim {

inline void measure(const std::string& what, double value, double limit) {
  EXPECT_LE(value, limit) << what;
  char text[64];
  std::snprintf(text, sizeof text, "%.2g %.2g", value, limit);
  ::testing::Test::RecordProperty(what, text);
}

}  // namespace cprsim
