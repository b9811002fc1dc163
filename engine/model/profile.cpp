// SPDX-License-Identifier: BSD-3-Clause
// Functions of time.
//   smoothstep  x = (t - start) / (end - start),  s(x) = x³ (10 - 15 x + 6 x²)            (1)
//               the quintic with zero first and second derivative at both ends
//   trapezoid   from D to 0 in the time T with acceleration a: D = v (T - v / a) gives the
//               speed v = 2 D / (T + sqrt(T² - 4 D / a)) in between                        (5)
//   chirp       A sin 2 pi (f0 x + (f1 - f0) x² / (2 T)),  x = t - start                   (6)
//   keyframes   cubic Hermite between (t_i, y_i, m_i) and (t_{i+1}, y_{i+1}, m_{i+1})      (2)
//   pchip       slopes of Fritsch & Carlson (SIAM J. Numer. Anal. 17, 1980) in the weighted
//   harmonic form of
//               Fritsch & Butland (1984): monotone data give a monotone curve               (3)
//   cubic       slopes of the natural spline, from a tridiagonal system                     (4)
#include "engine/model/profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cprsim {

namespace {

// whether t lies after `instant`, seen from the right, or from the left if `before`
bool reached(double t, double instant, bool before) {
  return before ? t > instant : t >= instant;
}

ProfileValue ramp(const ProfileTerm& term, double t, bool before) {
  if (!reached(t, term.start, before)) return {term.from, 0, 0};
  if (reached(t, term.end, before)) return {term.to, 0, 0};
  const double rate = (term.to - term.from) / (term.end - term.start);
  return {term.from + rate * (t - term.start), rate, 0};
}

ProfileValue smoothstep(const ProfileTerm& term, double t) {
  if (t <= term.start) return {term.from, 0, 0};
  if (t >= term.end) return {term.to, 0, 0};
  const double width = term.end - term.start, rise = term.to - term.from;
  const double x = (t - term.start) / width;
  const double s = x * x * x * (10 + x * (-15 + 6 * x));  // (1)
  const double s_x = 30 * x * x * (1 - x) * (1 - x);
  const double s_xx = 60 * x * (1 - x) * (1 - 2 * x);
  return {term.from + rise * s, rise * s_x / width, rise * s_xx / (width * width)};
}

ProfileValue sine(const ProfileTerm& term, double t, bool before) {
  if (!reached(t, term.start, before) || reached(t, term.end, before)) return {};
  const double w = 2 * std::numbers::pi * term.frequency;
  const double angle = w * (t - term.start) + term.phase;
  const double s = term.amplitude * std::sin(angle), c = term.amplitude * std::cos(angle);
  return {s, w * c, -w * w * s};
}

/// Speed of the middle part and duration of the first and last one; (5) for D > 0.
struct Trapezoid {
  double speed, ramp, acceleration;
};

Trapezoid trapezoid_of(const ProfileTerm& term) {
  const double T = term.end - term.start, D = std::abs(term.to - term.from);
  const double a = term.acceleration, sign = term.to < term.from ? -1 : 1;
  const double speed = 2 * D / (T + std::sqrt(std::max(0.0, T * T - 4 * D / a)));
  return {sign * speed, speed / a, sign * a};
}

ProfileValue trapezoid(const ProfileTerm& term, double t, bool before) {
  if (!reached(t, term.start, before)) return {term.from, 0, 0};
  if (reached(t, term.end, before)) return {term.to, 0, 0};
  const auto [v, ramp, a] = trapezoid_of(term);
  if (!reached(t, term.start + ramp, before)) {
    const double x = t - term.start;
    return {term.from + 0.5 * a * x * x, a * x, a};
  }
  if (reached(t, term.end - ramp, before)) {
    const double x = term.end - t;
    return {term.to - 0.5 * a * x * x, a * x, -a};
  }
  return {term.from + v * (t - term.start - 0.5 * ramp), v, 0};
}

ProfileValue chirp(const ProfileTerm& term, double t, bool before) {
  if (!reached(t, term.start, before) || reached(t, term.end, before)) return {};
  const double w0 = 2 * std::numbers::pi * term.frequency;
  const double growth =
      2 * std::numbers::pi * (term.last_frequency - term.frequency) / (term.end - term.start);
  const double x = t - term.start, angle = x * (w0 + 0.5 * growth * x), w = w0 + growth * x;  // (6)
  const double s = term.amplitude * std::sin(angle), c = term.amplitude * std::cos(angle);
  return {s, w * c, growth * c - w * w * s};
}

ProfileValue formula(const ProfileTerm& term, double t) {
  const Jet x = term.expression.evaluate(t);
  return {x.value, x.rate, x.acceleration};
}

ProfileValue hermite(const ProfileTerm& term, std::size_t i, double t) {
  const double h = term.times[i + 1] - term.times[i], x = (t - term.times[i]) / h;
  const double d = (term.values[i + 1] - term.values[i]) / h;
  const double a = term.slopes[i], b = term.slopes[i + 1];
  // (2) in powers of x
  const double c2 = 3 * d - 2 * a - b, c3 = a + b - 2 * d;
  return {term.values[i] + h * x * (a + x * (c2 + x * c3)), a + x * (2 * c2 + 3 * x * c3),
          (2 * c2 + 6 * x * c3) / h};
}

ProfileValue keyframes(const ProfileTerm& term, double t, bool before) {
  const auto& times = term.times;
  if (times.empty()) return {};
  if (!reached(t, times.front(), before)) return {term.values.front(), 0, 0};
  if (reached(t, times.back(), before) && term.interpolation != Interpolation::kStep)
    return {term.values.back(), 0, 0};
  // the interval that t lies in, from the side asked for
  const auto after = before ? std::lower_bound(times.begin(), times.end(), t)
                            : std::upper_bound(times.begin(), times.end(), t);
  const std::size_t i = static_cast<std::size_t>(after - times.begin()) - 1;
  if (term.interpolation == Interpolation::kStep) return {term.values[i], 0, 0};
  if (term.interpolation != Interpolation::kLinear) return hermite(term, i, t);
  const double rate = (term.values[i + 1] - term.values[i]) / (times[i + 1] - times[i]);
  return {term.values[i] + rate * (t - times[i]), rate, 0};
}

ProfileValue evaluate_term(const ProfileTerm& term, double t, bool before) {
  switch (term.shape) {
    case ShapeOfTime::kConstant:
      return {term.value, 0, 0};
    case ShapeOfTime::kStep:
      return {reached(t, term.start, before) ? term.to : term.from, 0, 0};
    case ShapeOfTime::kRamp:
      return ramp(term, t, before);
    case ShapeOfTime::kSmoothstep:
      return smoothstep(term, t);
    case ShapeOfTime::kTrapezoid:
      return trapezoid(term, t, before);
    case ShapeOfTime::kSine:
      return sine(term, t, before);
    case ShapeOfTime::kChirp:
      return chirp(term, t, before);
    case ShapeOfTime::kExpression:
      return formula(term, t);
    case ShapeOfTime::kKeyframes:
      return keyframes(term, t, before);
  }
  return {};
}

// instants at which one term is not twice continuously differentiable
std::vector<double> corners(const ProfileTerm& term) {
  switch (term.shape) {
    case ShapeOfTime::kStep:
      return {term.start};
    case ShapeOfTime::kRamp:
    case ShapeOfTime::kSine:
    case ShapeOfTime::kChirp:
      return {term.start, term.end};
    case ShapeOfTime::kTrapezoid: {
      const double ramp = trapezoid_of(term).ramp;
      return {term.start, term.start + ramp, term.end - ramp, term.end};
    }
    case ShapeOfTime::kKeyframes:
      if (term.interpolation == Interpolation::kCubic && !term.times.empty())
        return {term.times.front(), term.times.back()};
      return term.times;
    default:
      return {};
  }
}

// (3); the slope at an end is that of the parabola through three points, limited to keep the shape
double end_slope(double h0, double h1, double d0, double d1) {
  const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (slope * d0 <= 0) return 0;
  if (d0 * d1 < 0 && std::abs(slope) > 3 * std::abs(d0)) return 3 * d0;
  return slope;
}

std::vector<double> pchip_slopes(const std::vector<double>& h, const std::vector<double>& d) {
  const std::size_t n = h.size() + 1;
  std::vector<double> m(n, 0);
  if (n == 2) return {d[0], d[0]};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (d[i - 1] * d[i] <= 0) continue;
    const double w1 = 2 * h[i] + h[i - 1], w2 = h[i] + 2 * h[i - 1];
    m[i] = (w1 + w2) / (w1 / d[i - 1] + w2 / d[i]);
  }
  m[0] = end_slope(h[0], h[1], d[0], d[1]);
  m[n - 1] = end_slope(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
  return m;
}

// (4): m_{i-1}/h_{i-1} + 2 m_i (1/h_{i-1} + 1/h_i) + m_{i+1}/h_i = 3 (d_{i-1}/h_{i-1} + d_i/h_i)
std::vector<double> spline_slopes(const std::vector<double>& h, const std::vector<double>& d,
                                  const EndSlopes* given) {
  const std::size_t n = h.size() + 1;
  std::vector<double> diagonal(n), right(n), upper(n, 0);
  diagonal[0] = 2 / h[0];
  right[0] = 3 * d[0] / h[0];
  upper[0] = 1 / h[0];
  if (given) {
    diagonal[0] = 1;
    right[0] = given->first;
    upper[0] = 0;
  }
  for (std::size_t i = 1; i < n; ++i) {
    const bool last = i + 1 == n;
    if (last && given) {
      diagonal[i] = 1;
      right[i] = given->last;
      break;
    }
    const double lower = 1 / h[i - 1];
    diagonal[i] = 2 / h[i - 1] + (last ? 0 : 2 / h[i]);
    right[i] = 3 * d[i - 1] / h[i - 1] + (last ? 0 : 3 * d[i] / h[i]);
    if (!last) upper[i] = 1 / h[i];
    const double factor = lower / diagonal[i - 1];
    diagonal[i] -= factor * upper[i - 1];
    right[i] -= factor * right[i - 1];
  }
  std::vector<double> m(n);
  m[n - 1] = right[n - 1] / diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;)
    m[i] = (right[i] - upper[i] * m[i + 1]) / diagonal[i];
  return m;
}

}  // namespace

ProfileValue Profile::evaluate(double t, bool before) const {
  ProfileValue sum;
  for (const ProfileTerm& term : terms) {
    const ProfileValue v = evaluate_term(term, t, before);
    sum.value += v.value;
    sum.rate += v.rate;
    sum.acceleration += v.acceleration;
  }
  return sum;
}

std::vector<double> Profile::breakpoints(double end) const {
  std::vector<double> instants;
  for (const ProfileTerm& term : terms)
    for (const double t : corners(term))
      if (t >= 0 && t <= end) instants.push_back(t);
  std::sort(instants.begin(), instants.end());
  instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
  return instants;
}

double least_acceleration(const ProfileTerm& trapezoid) {
  const double T = trapezoid.end - trapezoid.start;
  return 4 * std::abs(trapezoid.to - trapezoid.from) / (T * T);
}

void finish_keyframes(ProfileTerm& term, const EndSlopes* ends) {
  const std::size_t n = term.times.size();
  term.slopes.assign(n, 0);
  const bool smooth =
      term.interpolation == Interpolation::kPchip || term.interpolation == Interpolation::kCubic;
  if (n < 2 || !smooth) return;
  std::vector<double> h(n - 1), d(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h[i] = term.times[i + 1] - term.times[i];
    d[i] = (term.values[i + 1] - term.values[i]) / h[i];
  }
  term.slopes =
      term.interpolation == Interpolation::kPchip ? pchip_slopes(h, d) : spline_slopes(h, d, ends);
}

}  // namespace cprsim
