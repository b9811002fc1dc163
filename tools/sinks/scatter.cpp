// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/scatter.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cprsim {

namespace {

constexpr double kPlot = 560;  // side of the square that the axes' longer range fills, pixels
constexpr double kLeft = 80, kTop = 44, kBottom = 56, kLegend = 250;
constexpr double kMargin = 0.05;  // around the points, of the longer range

struct Frame {
  Vec2 low, high;
  double scale = 1;  ///< pixels per unit, on both axes

  Vec2 at(const Vec2& p) const {
    return {kLeft + scale * (p.x() - low.x()), kTop + scale * (high.y() - p.y())};
  }

  double width() const { return scale * (high.x() - low.x()); }

  double height() const { return scale * (high.y() - low.y()); }
};

Frame frame_of(const Scatter& scatter) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Frame frame{Vec2::Constant(kInfinity), Vec2::Constant(-kInfinity)};
  for (const ScatterGroup& group : scatter.groups)
    for (const Vec2& p : group.points) {
      frame.low = frame.low.cwiseMin(p);
      frame.high = frame.high.cwiseMax(p);
    }
  if (!(frame.low.x() <= frame.high.x())) frame = {Vec2::Zero(), Vec2::Zero()};
  double range = (frame.high - frame.low).maxCoeff();
  if (!(range > 0)) range = 0.1;
  // a line of points still gets a band to lie in
  for (int i = 0; i < 2; ++i) {
    const double missing = std::max(0.0, 0.4 * range - (frame.high[i] - frame.low[i]));
    frame.low[i] -= 0.5 * missing + kMargin * range;
    frame.high[i] += 0.5 * missing + kMargin * range;
  }
  frame.scale = kPlot / (frame.high - frame.low).maxCoeff();
  return frame;
}

/// 1, 2 or 5 times a power of ten, for at most `count` steps.
double tick_step(double range, double count) {
  const double rough = range / count, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) return factor * power;
  return 10 * power;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else
      safe += c;
  }
  return safe;
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     escaped(text));
}

std::string line(double x1, double y1, double x2, double y2) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", x1, y1,
                     x2, y2);
}

std::string axes(const Scatter& scatter, const Frame& frame) {
  const double right = kLeft + frame.width(), bottom = kTop + frame.height();
  std::string grid = "<g stroke=\"#dddddd\">\n", words;
  for (int i = 0; i < 2; ++i) {
    const double step = tick_step((frame.high - frame.low).maxCoeff(), 8);
    const auto first = static_cast<long>(std::ceil(frame.low[i] / step));
    for (long k = first; static_cast<double>(k) * step <= frame.high[i]; ++k) {
      Vec2 p = frame.low;
      p[i] = static_cast<double>(k) * step;
      const Vec2 at = frame.at(p);
      const std::string label = fmt::format("{:.6g}", p[i]);
      if (i == 0) {
        grid += line(at.x(), kTop, at.x(), bottom);
        words += text_at(at.x(), bottom + 18, "middle", label);
      } else {
        grid += line(kLeft, at.y(), right, at.y());
        words += text_at(kLeft - 8, at.y() + 4, "end", label);
      }
    }
  }
  words += text_at(kLeft + frame.width() / 2, bottom + 40, "middle", scatter.x_label);
  words += fmt::format(
      "<text transform=\"translate(20 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
      kTop + frame.height() / 2, escaped(scatter.y_label));
  return grid + "</g>\n" +
         fmt::format(
             "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
             "fill=\"none\" stroke=\"#444444\"/>\n",
             kLeft, kTop, frame.width(), frame.height()) +
         words;
}

double radius_of(const Scatter& scatter) {
  std::size_t count = 1;
  for (const ScatterGroup& group : scatter.groups)
    count += group.points.size();
  return std::clamp(0.35 * kPlot / std::sqrt(static_cast<double>(count)), 1.2, 5.0);
}

std::string dots(const Scatter& scatter, const Frame& frame) {
  const double radius = radius_of(scatter);
  std::string text;
  for (const ScatterGroup& group : scatter.groups) {
    // thousands of points: a round cap each, in one path
    text += fmt::format(
        "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{:.1f}\" stroke-linecap=\"round\" d=\"",
        group.color, 2 * radius);
    for (const Vec2& p : group.points) {
      const Vec2 at = frame.at(p);
      text += fmt::format("M{:.1f} {:.1f}h.01", at.x(), at.y());
    }
    text += "\"/>\n";
  }
  return text;
}

std::string legend(const Scatter& scatter, const Frame& frame) {
  const double x = kLeft + frame.width() + 24;
  double y = kTop + 12;
  std::string text;
  // as they are drawn: the last on top
  for (auto group = scatter.groups.rbegin(); group != scatter.groups.rend(); ++group) {
    text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\"/>\n", x, y - 4,
                        group->color);
    text += text_at(x + 14, y, "start", fmt::format("{}: {}", group->name, group->points.size()));
    y += 22;
  }
  y += 8;
  for (const std::string& note : scatter.notes) {
    text += text_at(x - 5, y, "start", note);
    y += 18;
  }
  return text;
}

}  // namespace

std::string to_svg(const Scatter& scatter) {
  const Frame frame = frame_of(scatter);
  const double width = kLeft + frame.width() + kLegend;
  const double height = kTop + std::max(frame.height(), 200.0) + kBottom;
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
             "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"13\">\n"
             "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"white\"/>\n",
             width, height) +
         text_at(kLeft, kTop - 18, "start", scatter.title) + axes(scatter, frame) +
         dots(scatter, frame) + legend(scatter, frame) + "</svg>\n";
}

}  // namespace cprsim
