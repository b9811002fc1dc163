// SPDX-License-Identifier: BSD-3-Clause
#include "render/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace cprsim {

namespace {

void fill(Image& image, double x0, double y0, double x1, double y1, const Color& color,
          double opacity) {
  for (int y = static_cast<int>(std::lround(y0)); y < static_cast<int>(std::lround(y1)); ++y) {
    for (int x = static_cast<int>(std::lround(x0)); x < static_cast<int>(std::lround(x1)); ++x) {
      blend(image, x, y, color, opacity);
    }
  }
}

/// Small numbers are shown in thousandths: 0.002 N·m is 2 mN·m.
double unit_factor(double largest) {
  return largest < 0.0099 && largest > 0 ? 1000 : 1;
}

}  // namespace

Overlay::Overlay(bool dark)
    : bold_(true),
      ink_(dark ? Color(0.13F, 0.15F, 0.19F) : Color(0.95F, 0.96F, 0.97F)),
      faint_(dark ? Color(0.36F, 0.39F, 0.44F) : Color(0.74F, 0.77F, 0.80F)) {}

std::string title_of(const std::string& scene_name) {
  std::string title = scene_name;
  std::replace(title.begin(), title.end(), '_', ' ');
  return title;
}

std::string time_text(double time, double speed) {
  std::array<char, 80> text{};
  // never "-0.00"
  std::snprintf(text.data(), text.size(), "t = %.2f s", std::abs(time) < 5e-3 ? 0.0 : time);
  std::string whole = text.data();
  if (speed > 0 && std::abs(speed - 1) > 1e-9) {
    std::snprintf(text.data(), text.size(), "   %.4g\u00D7 real time", speed);
    whole += text.data();
  }
  return whole;
}

void Overlay::draw(Image& image, const FrameDecor& decor, double time,
                   const Vec2& color_range) const {
  const double unit = std::max(image.height / 720.0, 0.4), margin = 36 * unit;
  double y = margin + 20 * unit;
  if (!decor.scene_name.empty()) {
    bold_.draw(image, margin, y, 30 * unit, title_of(decor.scene_name), ink_);
    y += 32 * unit;
  }
  if (decor.show_time) {
    regular_.draw(image, margin, y, 23 * unit, time_text(time, decor.speed), faint_);
  }
  if (!decor.overlay.empty()) {
    regular_.draw(image, margin, image.height - margin, 22 * unit, decor.overlay, ink_);
  }
  if (decor.color_by != ColorBy::kNone) draw_legend(image, decor.color_by, color_range, unit);
}

void Overlay::draw_legend(Image& image, ColorBy by, const Vec2& range, double unit) const {
  const double margin = 36 * unit, size = 19 * unit;
  const double bar_width = 14 * unit, bar_height = 230 * unit;
  const double factor = unit_factor(std::max(std::abs(range.x()), std::abs(range.y())));
  const Vec2 shown = factor * range;
  const std::string heading = quantity_name(by);
  std::string in_unit = quantity_unit(by);
  if (factor > 1) in_unit.insert(in_unit.begin(), 'm');
  const double column = std::max(regular_.width(heading, size), bar_width + 60 * unit);
  const double left = image.width - margin - column, top = margin + 52 * unit;
  regular_.draw(image, left, margin + 14 * unit, size, heading, ink_);
  regular_.draw(image, left, margin + 35 * unit, size, in_unit, faint_);
  for (int row = 0; row < static_cast<int>(bar_height); ++row) {
    const double value = shown.y() - (row + 0.5) / bar_height * (shown.y() - shown.x());
    fill(image, left, top + row, left + bar_width, top + row + 1, color_of(by, value, shown), 1);
  }
  const std::vector<double> marks = ticks(shown);
  const double spacing = marks.size() > 1 ? marks[1] - marks[0] : 1;
  for (double value : marks) {
    const double at =
        top + bar_height * (shown.y() - value) / std::max(shown.y() - shown.x(), 1e-300);
    fill(image, left + bar_width, at - 0.5, left + bar_width + 5 * unit, at + 0.5, faint_, 1);
    regular_.draw(image, left + bar_width + 10 * unit, at + 0.32 * size, size,
                  tick_text(value, spacing), ink_);
  }
}

}  // namespace cprsim
