// SPDX-License-Identifier: BSD-3-Clause
#include "render/palette.h"

#include <gtest/gtest.h>

#include "render/color_range.h"
#include "render/overlay.h"
#include "tests/support/six_rods.h"

namespace cprsim {
namespace {

double lightness(const Color& c) {
  return 0.2126 * c.x() + 0.7152 * c.y() + 0.0722 * c.z();
}

TEST(Palette, ViridisGrowsLighterAllTheWay) {
  for (int i = 0; i < 100; ++i) {
    EXPECT_LT(lightness(viridis(i / 100.0)), lightness(viridis((i + 1) / 100.0))) << i;
  }
  EXPECT_EQ(viridis(-3), viridis(0));
  EXPECT_EQ(viridis(7), viridis(1));
}

TEST(Palette, ViridisIsThePublishedOne) {
  // 21918C at 0.5 and 5EC962 at 0.75 in the published table; half a table step of the 256 is 0.002
  EXPECT_LT((viridis(0.5) - Color(0x21, 0x91, 0x8C) / 255).norm(), 0.01);
  EXPECT_LT((viridis(0.75) - Color(0x5E, 0xC9, 0x62) / 255).norm(), 0.02);
}

TEST(Palette, NiceCeilingIsTheNextOfOneTwoFive) {
  EXPECT_DOUBLE_EQ(nice_ceiling(0.13), 0.2);
  EXPECT_DOUBLE_EQ(nice_ceiling(0.2), 0.2);
  EXPECT_DOUBLE_EQ(nice_ceiling(3), 5);
  EXPECT_DOUBLE_EQ(nice_ceiling(7000), 10000);
  EXPECT_EQ(nice_ceiling(0), 1);
}

TEST(Palette, TicksAreRoundAndInside) {
  for (double top : {0.2, 1.0, 3.7, 50.0}) {
    const std::vector<double> marks = ticks({0, top});
    EXPECT_GE(marks.size(), 4U) << top;
    EXPECT_LE(marks.size(), 7U) << top;
    EXPECT_EQ(marks.front(), 0);
    EXPECT_LE(marks.back(), top * (1 + 1e-6));
  }
  EXPECT_EQ(tick_text(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tick_text(40, 10), "40");
}

TEST(Palette, TimeIsNeverMinusZero) {
  EXPECT_EQ(time_text(-1e-12, 1), "t = 0.00 s");
  EXPECT_EQ(time_text(1.25, 1), "t = 1.25 s");
  EXPECT_EQ(time_text(1.25, 0.5), "t = 1.25 s   0.5\u00D7 real time");
}

Snapshot with_moment(double m) {
  Snapshot now;
  now.rods.resize(1);
  now.rods[0].points.resize(2);
  now.rods[0].points[1].moment = {m, 0, 0};
  return now;
}

TEST(SteadyRange, StaysUntilAValueExceedsItAndThenGlides) {
  const Scene scene = six_rods_scene();
  SteadyRange range(scene, ColorBy::kBendingMoment);
  const double first = range.next(with_moment(0.1), 0).y();
  EXPECT_DOUBLE_EQ(first, 0.2);
  EXPECT_EQ(range.next(with_moment(0.19), 1).y(), first);
  EXPECT_EQ(range.next(with_moment(0.01), 2).y(), first) << "it never shrinks";
  double last = first;
  for (int k = 0; k <= 30; ++k) {
    const double top = range.next(with_moment(0.4), 3 + k / 30.0).y();
    EXPECT_GE(top, last);
    EXPECT_LT(top - last, 0.05) << "a jump in frame " << k;
    last = top;
  }
  EXPECT_DOUBLE_EQ(last, 0.5);
}

}  // namespace
}  // namespace cprsim
