// SPDX-License-Identifier: BSD-3-Clause
// A picture in memory and its way to a PNG file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cprsim {

/// 8-bit sRGB, four bytes a pixel (red, green, blue, 255), rows from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;

  Image() = default;

  Image(int w, int h)
      : width(w),
        height(h),
        pixels(4 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  std::uint8_t* at(int x, int y) {
    return pixels.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                static_cast<std::size_t>(x));
  }

  const std::uint8_t* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
};

/// Writes a PNG: first to `path`.part, then renamed, so that no half picture is ever seen.
/// Throws std::runtime_error with the reason if the file cannot be written.
void write_png(const std::string& path, const Image& image);

/// Averages blocks of factor × factor pixels.
Image shrink(const Image& image, int factor);

}  // namespace cprsim
