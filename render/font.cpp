// SPDX-License-Identifier: BSD-3-Clause
#include "render/font.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <tuple>
#include <vector>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_easy_font.h>
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

namespace cprsim {

namespace {

constexpr int kSteps = 4;  // glyphs are placed to a quarter of a pixel

/// Code points of UTF-8; a broken byte becomes a question mark.
std::vector<int> decode(const std::string& text) {
  std::vector<int> codes;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    const int more = lead < 0x80       ? 0
                     : lead >> 5 == 6  ? 1
                     : lead >> 4 == 14 ? 2
                     : lead >> 3 == 30 ? 3
                                       : -1;
    int code = more == 0 ? lead : lead & (0x3F >> more);
    bool good = more >= 0;
    for (int k = 0; k < more && good; ++k) {
      good = i < text.size() && (static_cast<unsigned char>(text[i]) >> 6) == 2;
      if (good) code = code << 6 | (static_cast<unsigned char>(text[i++]) & 0x3F);
    }
    codes.push_back(good ? code : '?');
  }
  return codes;
}

/// The nearest thing the plain letters have.
std::string to_ascii(const std::string& text) {
  std::string plain;
  for (int code : decode(text)) {
    if (code == 0xB7) {
      plain += ' ';
    } else if (code == 0xD7) {
      plain += 'x';
    } else if (code == 0x2212) {
      plain += '-';
    } else {
      plain += code >= 32 && code < 127 ? static_cast<char>(code) : '?';
    }
  }
  return plain;
}

constexpr double kPlainHeight = 12;  // of stb_easy_font's line, in its units

}  // namespace

struct Font::Face {
  struct Glyph {
    int x = 0, y = 0, width = 0, height = 0;
    std::vector<unsigned char> coverage;
  };

  std::vector<unsigned char> file;
  stbtt_fontinfo info{};
  bool smooth = false;
  std::map<std::tuple<int, int, int>, Glyph> glyphs;  // by code point, size in 1/64 pixel, quarter

  const Glyph& glyph(int code, double size, int quarter) {
    const auto key = std::tuple(code, static_cast<int>(std::lround(64 * size)), quarter);
    const auto found = glyphs.find(key);
    if (found != glyphs.end()) return found->second;
    Glyph made;
    const float scale = stbtt_ScaleForPixelHeight(&info, static_cast<float>(size));
    unsigned char* bitmap =
        stbtt_GetCodepointBitmapSubpixel(&info, scale, scale, static_cast<float>(quarter) / kSteps,
                                         0, code, &made.width, &made.height, &made.x, &made.y);
    if (bitmap != nullptr) {
      made.coverage.assign(bitmap, bitmap + made.width * made.height);
      stbtt_FreeBitmap(bitmap, nullptr);
    }
    return glyphs.emplace(key, std::move(made)).first->second;
  }

  double advance(int code, int next, double scale) const {
    int wide = 0, bearing = 0;
    stbtt_GetCodepointHMetrics(&info, code, &wide, &bearing);
    return scale * (wide + (next ? stbtt_GetCodepointKernAdvance(&info, code, next) : 0));
  }
};

Font::Font(bool bold) : face_(std::make_unique<Face>()) {
  const std::string name = bold ? "DejaVuSans-Bold.ttf" : "DejaVuSans.ttf";
  for (const char* folder :
       {"/usr/share/fonts/truetype/dejavu/", "/usr/share/fonts/dejavu/", "/usr/share/fonts/TTF/"}) {
    std::ifstream in(folder + name, std::ios::binary);
    if (!in) continue;
    face_->file.assign(std::istreambuf_iterator<char>(in), {});
    face_->smooth =
        !face_->file.empty() && stbtt_InitFont(&face_->info, face_->file.data(), 0) != 0;
    if (face_->smooth) break;
  }
}

Font::~Font() = default;
Font::Font(Font&&) noexcept = default;

bool Font::smooth() const {
  return face_->smooth;
}

double Font::width(const std::string& text, double size) const {
  if (!face_->smooth) {
    std::string plain = to_ascii(text);
    return stb_easy_font_width(plain.data()) * size / kPlainHeight;
  }
  const double scale = stbtt_ScaleForPixelHeight(&face_->info, static_cast<float>(size));
  const std::vector<int> codes = decode(text);
  double sum = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    sum += face_->advance(codes[i], i + 1 < codes.size() ? codes[i + 1] : 0, scale);
  }
  return sum;
}

void Font::draw(Image& image, double x, double y, double size, const std::string& text,
                const Color& color, double opacity) const {
  if (!face_->smooth) {
    // letters made of rectangles, four corners of {x, y, z, colour} each
    std::string plain = to_ascii(text);
    std::vector<std::array<float, 4>> corners(4 * (64 + 16 * plain.size()));
    const int quads = stb_easy_font_print(0, 0, plain.data(), nullptr, corners.data(),
                                          static_cast<int>(corners.size() * sizeof(corners[0])));
    const double scale = size / kPlainHeight;
    for (std::size_t q = 0; q < static_cast<std::size_t>(quads); ++q) {
      const auto &a = corners[4 * q], &b = corners[4 * q + 2];
      const double top = y - 0.6 * size;
      for (int j = static_cast<int>(top + scale * a[1]); j < static_cast<int>(top + scale * b[1]);
           ++j) {
        for (int i = static_cast<int>(x + scale * a[0]); i < static_cast<int>(x + scale * b[0]);
             ++i) {
          blend(image, i, j, color, opacity);
        }
      }
    }
    return;
  }
  const double scale = stbtt_ScaleForPixelHeight(&face_->info, static_cast<float>(size));
  const std::vector<int> codes = decode(text);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const double whole = std::floor(x);
    const int quarter = static_cast<int>(kSteps * (x - whole));
    const Face::Glyph& glyph = face_->glyph(codes[i], size, quarter);
    for (int v = 0; v < glyph.height; ++v) {
      for (int u = 0; u < glyph.width; ++u) {
        const auto at = static_cast<std::size_t>(v * glyph.width + u);
        blend(image, static_cast<int>(whole) + glyph.x + u,
              static_cast<int>(std::lround(y)) + glyph.y + v, color,
              opacity * glyph.coverage[at] / 255.0);
      }
    }
    x += face_->advance(codes[i], i + 1 < codes.size() ? codes[i + 1] : 0, scale);
  }
}

void blend(Image& image, int x, int y, const Color& color, double opacity) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height || opacity <= 0) return;
  std::uint8_t* pixel = image.at(x, y);
  const auto a = static_cast<float>(std::min(opacity, 1.0));
  for (int c = 0; c < 3; ++c) {
    const float mixed = (1 - a) * pixel[c] + 255 * a * color[c];
    pixel[c] = static_cast<std::uint8_t>(mixed + 0.5F);
  }
}

}  // namespace cprsim
