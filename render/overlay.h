// SPDX-License-Identifier: BSD-3-Clause
// What is written on a picture: name, time, caption, legend.
#pragma once

#include <string>

#include "render/font.h"
#include "render/renderer.h"

namespace cprsim {

class Overlay {
 public:
  /// @param dark  dark letters, for a light background
  explicit Overlay(bool dark = true);

  void draw(Image& image, const FrameDecor& decor, double time, const Vec2& color_range) const;

 private:
  void draw_legend(Image& image, ColorBy by, const Vec2& range, double unit) const;

  Font regular_, bold_;
  Color ink_, faint_;
};

/// "t = 1.25 s", with "at half speed" words if the film is not in real time.
std::string time_text(double time, double speed);

/// A scene's name as people write it: six_rods becomes "six rods".
std::string title_of(const std::string& scene_name);

}  // namespace cprsim
