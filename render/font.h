// SPDX-License-Identifier: BSD-3-Clause
// Text in pictures: DejaVu Sans if the machine has it (Debian package fonts-dejavu-core), otherwise
// the plain letters that are built in.
#pragma once

#include <memory>
#include <string>

#include "render/image.h"
#include "render/palette.h"

namespace cprsim {

class Font {
 public:
  explicit Font(bool bold = false);
  ~Font();
  Font(Font&&) noexcept;

  /// Is it the real font and not the plain letters?
  bool smooth() const;

  /// In pixels, of UTF-8 text at `size` pixels from the lowest to the highest letter.
  double width(const std::string& text, double size) const;

  /// Starts at x with its base line at y, counted from the upper left corner; cut at the picture's
  /// edge.
  void draw(Image& image, double x, double y, double size, const std::string& text,
            const Color& color, double opacity = 1) const;

 private:
  struct Face;
  std::unique_ptr<Face> face_;
};

/// Mixes a colour into one pixel; does nothing outside the picture.
void blend(Image& image, int x, int y, const Color& color, double opacity);

}  // namespace cprsim
