// SPDX-License-Identifier: BSD-3-Clause
#include "render/image.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wconversion"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace cprsim {

namespace {

void append(void* bytes, void* data, int size) {
  const auto* first = static_cast<const std::uint8_t*>(data);
  auto& all = *static_cast<std::vector<std::uint8_t>*>(bytes);
  all.insert(all.end(), first, first + size);
}

}  // namespace

void write_png(const std::string& path, const Image& image) {
  if (image.width <= 0 || image.height <= 0)
    throw std::runtime_error(path + ": the picture is empty");
  std::vector<std::uint8_t> rgb;
  rgb.reserve(image.pixels.size() / 4 * 3);
  for (std::size_t i = 0; i + 3 < image.pixels.size(); i += 4) {
    rgb.insert(rgb.end(), {image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
  }
  std::vector<std::uint8_t> bytes;
  if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, rgb.data(),
                              3 * image.width)) {
    throw std::runtime_error(path + ": the picture could not be encoded");
  }
  const std::string part = path + ".part";
  std::FILE* file = std::fopen(part.c_str(), "wb");
  bool good = file != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int why = errno;
  if (file != nullptr) good = std::fclose(file) == 0 && good;
  if (!good || std::rename(part.c_str(), path.c_str()) != 0) {
    const std::string reason = std::strerror(good ? errno : why);
    std::remove(part.c_str());
    throw std::runtime_error(path + ": cannot write the picture: " + reason);
  }
}

Image shrink(const Image& image, int factor) {
  if (factor <= 1) return image;
  Image small(image.width / factor, image.height / factor);
  const int area = factor * factor;
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      int sum[4] = {0, 0, 0, 0};
      for (int j = 0; j < factor; ++j) {
        const std::uint8_t* from = image.at(x * factor, y * factor + j);
        for (int i = 0; i < 4 * factor; ++i)
          sum[i % 4] += from[i];
      }
      std::uint8_t* to = small.at(x, y);
      for (int c = 0; c < 4; ++c)
        to[c] = static_cast<std::uint8_t>((sum[c] + area / 2) / area);
    }
  }
  return small;
}

}  // namespace cprsim
