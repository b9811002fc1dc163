// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/values.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>

namespace cprsim {
namespace {

TEST(Numbers, AreTheWholeTextAndFinite) {
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(parse_number(" -2e-3\n"), -2e-3);
  EXPECT_EQ(parse_number("+4"), 4);
  for (const char* text : {"nan", "inf", "-inf", "1e999", "1,5", "1.0abc", "0x10", "1 2 3", "--1",
                           "", " ", "+-1", "1_000", "1e", ".", "infinity"})
    EXPECT_FALSE(parse_number(text)) << text;
}

TEST(Numbers, MayBeInfiniteOnlyInLimits) {
  EXPECT_TRUE(std::isinf(*parse_number("inf", true)));
  EXPECT_LT(*parse_number("-inf", true), 0);
  EXPECT_FALSE(parse_number("nan", true));
}

TEST(Numbers, ThatAreWholeDoNotWrapAround) {
  EXPECT_EQ(parse_integer("42"), 42);
  for (const char* text : {"1e9", "3.7", "99999999999999999999", "", "4 2", "0x10"})
    EXPECT_FALSE(parse_integer(text)) << text;
}

TEST(Numbers, DoNotDependOnTheMachinesLanguage) {
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(format_number(0.1), "0.1");
  std::setlocale(LC_ALL, "C");
}

TEST(Numbers, AreWrittenSoThatTheyReadBack) {
  for (const double x : {0.1, 1.0 / 3, 6.02e23, -5e-324, 0.30000000000000004})
    EXPECT_EQ(parse_number(format_number(x)), x);
}

TEST(Keyframes, ArePairsSeparatedByCommas) {
  const auto frames = parse_keyframes("0 0, 1 0.05,\n 2 -3");
  ASSERT_TRUE(frames);
  ASSERT_EQ(frames->size(), 3u);
  EXPECT_EQ((*frames)[2].time, 2);
  EXPECT_EQ((*frames)[2].value, -3);
  for (const char* text : {"", "0", "0 1,", "0 1 2", "a b", "0 nan"})
    EXPECT_FALSE(parse_keyframes(text)) << text;
}

TEST(Rotations, ApplyRollThenPitchThenYawAboutFixedAxes) {
  const double h = std::acos(0.0);
  // roll turns y into z, yaw then turns x into y
  EXPECT_LT((rotation_from_rpy(h, 0, 0) * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_LT((rotation_from_rpy(0, h, 0) * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-15);
  EXPECT_LT((rotation_from_rpy(h, 0, h) * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_LT((rotation_from_rpy(h, 0, h) * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
}

}  // namespace
}  // namespace cprsim
