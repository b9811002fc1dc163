// SPDX-License-Identifier: BSD-3-Clause
#include "render/palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace cprsim {

namespace {

/// Linear interpolation in a table of equally spaced 24-bit colours.
template <std::size_t N>
Color between(const std::array<unsigned, N>& table, double x) {
  const auto rgb = [&](std::size_t i) -> Color {
    const unsigned c = table[i];
    return Color(static_cast<float>(c >> 16 & 255U), static_cast<float>(c >> 8 & 255U),
                 static_cast<float>(c & 255U)) /
           255.0F;
  };
  const double at = (std::isfinite(x) ? std::clamp(x, 0.0, 1.0) : 0.0) * (N - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), N - 2);
  const auto t = static_cast<float>(at - static_cast<double>(i));
  return rgb(i) * (1 - t) + rgb(i + 1) * t;
}

}  // namespace

Color viridis(double x) {
  // every seventeenth of the 256 published colours
  static constexpr std::array<unsigned, 16> kTable{
      0x440154, 0x481A6C, 0x472F7D, 0x414487, 0x39568C, 0x31688E, 0x2A788E, 0x23888E,
      0x1F988B, 0x22A884, 0x35B779, 0x54C568, 0x7AD151, 0xA5DB36, 0xD2E21B, 0xFDE725};
  return between(kTable, x);
}

Color diverging(double x) {
  static constexpr std::array<unsigned, 7> kTable{0x0B4F9E, 0x3F8EC7, 0x9CC6E0, 0xE6E3DE,
                                                  0xF3B98A, 0xE07B39, 0xA63A06};
  return between(kTable, x);
}

Color accent(std::size_t i) {
  static constexpr std::array<std::array<float, 3>, 6> kColors{{{0.84F, 0.30F, 0.05F},
                                                                {0.00F, 0.45F, 0.70F},
                                                                {0.00F, 0.62F, 0.45F},
                                                                {0.80F, 0.47F, 0.65F},
                                                                {0.90F, 0.62F, 0.00F},
                                                                {0.34F, 0.71F, 0.91F}}};
  const std::array<float, 3>& c = kColors[i % kColors.size()];
  return {c[0], c[1], c[2]};
}

bool is_signed(ColorBy by) {
  return by == ColorBy::kTension;
}

Color color_of(ColorBy by, double value, const Vec2& range) {
  const double span = range.y() - range.x();
  const double x = span > 0 ? (value - range.x()) / span : 0.0;
  return is_signed(by) ? diverging(x) : viridis(x);
}

std::string quantity_name(ColorBy by) {
  switch (by) {
    case ColorBy::kBendingMoment:
      return "bending moment";
    case ColorBy::kCurvature:
      return "curvature";
    case ColorBy::kTension:
      return "tension";
    case ColorBy::kStrainEnergy:
      return "strain energy";
    case ColorBy::kNone:
      break;
  }
  return "";
}

std::string quantity_unit(ColorBy by) {
  switch (by) {
    case ColorBy::kBendingMoment:
      return "N\u00B7m";
    case ColorBy::kCurvature:
      return "1/m";
    case ColorBy::kTension:
      return "N";
    case ColorBy::kStrainEnergy:
      return "J/m";
    case ColorBy::kNone:
      break;
  }
  return "";
}

double nice_ceiling(double x) {
  if (!(x > 0) || !std::isfinite(x)) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (double step : {1.0, 2.0, 5.0}) {
    if (x <= step * power * (1 + 1e-9)) return step * power;
  }
  return 10 * power;
}

std::vector<double> ticks(const Vec2& range) {
  const double span = range.y() - range.x();
  if (!(span > 0) || !std::isfinite(span)) return {range.x()};
  const double spacing = nice_ceiling(span / 5.01);
  std::vector<double> all;
  for (double k = std::ceil(range.x() / spacing - 1e-6);
       k * spacing <= range.y() + 1e-6 * spacing && all.size() < 12; ++k) {
    all.push_back(k * spacing);
  }
  return all;
}

std::string tick_text(double value, double spacing) {
  std::array<char, 40> text{};
  const double magnitude = std::max(std::abs(value), spacing);
  if (magnitude != 0 && (magnitude >= 1e5 || spacing < 1e-4)) {
    std::snprintf(text.data(), text.size(), "%.3g", value);
  } else {
    const int digits =
        spacing > 0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(spacing) - 1e-9)), 0, 6)
                    : 3;
    std::snprintf(text.data(), text.size(), "%.*f", digits, value + 0.0);
  }
  return text.data();
}

}  // namespace cprsim
