// SPDX-License-Identifier: BSD-3-Clause
#include "render/yuv.h"

#include <gtest/gtest.h>

namespace cprsim {
namespace {

std::vector<int> yuv_of(int r, int g, int b) {
  Image image(2, 2);
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    image.pixels[i] = static_cast<std::uint8_t>(r);
    image.pixels[i + 1] = static_cast<std::uint8_t>(g);
    image.pixels[i + 2] = static_cast<std::uint8_t>(b);
  }
  std::vector<std::uint8_t> planes;
  to_yuv420(image, 2, 2, planes);
  return {planes.at(0), planes.at(4), planes.at(5)};
}

TEST(Yuv, IsBt709InVideoRange) {
  EXPECT_EQ(yuv_of(255, 255, 255), (std::vector<int>{235, 128, 128}));
  EXPECT_EQ(yuv_of(0, 0, 0), (std::vector<int>{16, 128, 128}));
  EXPECT_EQ(yuv_of(255, 0, 0), (std::vector<int>{63, 102, 240}));
  EXPECT_EQ(yuv_of(0, 255, 0), (std::vector<int>{173, 42, 26}));
  EXPECT_EQ(yuv_of(0, 0, 255), (std::vector<int>{32, 240, 118}));
}

TEST(Image, ShrinksByAveraging) {
  Image image(4, 2);
  image.at(0, 0)[0] = 200;
  image.at(1, 1)[0] = 100;
  const Image small = shrink(image, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.at(0, 0)[0], 75);
  EXPECT_EQ(small.at(1, 0)[0], 0);
}

}  // namespace
}  // namespace cprsim
