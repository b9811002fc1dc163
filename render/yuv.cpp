// SPDX-License-Identifier: BSD-3-Clause
// Y' = 16 + 219 (0.2126 R + 0.7152 G + 0.0722 B) and so on (ITU-R BT.709), in 16-bit fixed point.
#include "render/yuv.h"

#include <array>

namespace cprsim {

namespace {

std::uint8_t luma(const std::uint8_t* p) {
  return static_cast<std::uint8_t>(
      (11966 * p[0] + 40254 * p[1] + 4064 * p[2] + (16 << 16) + 32768) >> 16);
}

}  // namespace

void to_yuv420(const Image& image, int width, int height, std::vector<std::uint8_t>& planes) {
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  planes.resize(w * h * 3 / 2);
  std::uint8_t* y = planes.data();
  std::uint8_t* cb = y + w * h;
  std::uint8_t* cr = cb + w * h / 4;
  for (int row = 0; row < height; row += 2) {
    const std::uint8_t* a = image.at(0, row);
    const std::uint8_t* b = image.at(0, row + 1);
    std::uint8_t* y0 = y + static_cast<std::size_t>(row) * w;
    std::uint8_t* y1 = y0 + w;
    for (std::size_t x = 0; x < w; ++x) {
      y0[x] = luma(a + 4 * x);
      y1[x] = luma(b + 4 * x);
    }
    for (std::size_t x = 0; x < w / 2; ++x) {
      const std::uint8_t *p = a + 8 * x, *q = b + 8 * x;
      const int red = p[0] + p[4] + q[0] + q[4], green = p[1] + p[5] + q[1] + q[5],
                blue = p[2] + p[6] + q[2] + q[6];
      // the sums are four times a value: 18 bits of fraction
      *cb++ = static_cast<std::uint8_t>(
          (-6596 * red - 22189 * green + 28785 * blue + (128 << 18) + 131072) >> 18);
      *cr++ = static_cast<std::uint8_t>(
          (28785 * red - 26145 * green - 2640 * blue + (128 << 18) + 131072) >> 18);
    }
  }
}

}  // namespace cprsim
