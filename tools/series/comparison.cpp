// SPDX-License-Identifier: BSD-3-Clause
#include "tools/series/comparison.h"

#include <algorithm>
#include <cmath>

#include "engine/math/so3.h"

namespace cprsim {

namespace {

/// x - r, for attitudes the rotation vector from r to x.
Vec4 difference(QuantityKind kind, const QuantityValue& x, const QuantityValue& r) {
  if (kind != QuantityKind::kAttitude) return x - r;
  const Quat a(x[3], x[0], x[1], x[2]), b(r[3], r[0], r[1], r[2]);
  Vec4 result = Vec4::Zero();
  result.head<3>() = log_so3((a.normalized() * b.normalized().conjugate()).toRotationMatrix());
  return result;
}

/// Between the samples of a sorted list, linearly.
double quantile(const std::vector<double>& sorted, double fraction) {
  const double at = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double rest = at - static_cast<double>(below);
  return (1 - rest) * sorted[below] + rest * sorted[above];
}

/// (2) for one shift; nothing if too little of the reference is still covered.
std::optional<double> relative_error(const Series& series, const Series& reference,
                                     const std::vector<QuantityPair>& pairs, double lag) {
  constexpr double kLeastCovered = 0.5;
  double sum = 0;
  std::size_t moving = 0;
  for (const QuantityPair& pair : pairs) {
    const QuantityComparison c =
        compare_quantity(series, pair.quantity, reference, pair.reference, lag);
    const auto covered = static_cast<double>(c.time.size());
    if (covered < kLeastCovered * static_cast<double>(reference.size()) || covered < 2)
      return std::nullopt;
    // from the first value on, so that what stands still has a spread of exactly 0
    Vec4 mean = c.expected[0];
    for (const QuantityValue& r : c.expected)
      mean += (r - c.expected[0]) / covered;
    double spread = 0, error = 0;
    for (std::size_t k = 0; k < c.time.size(); ++k) {
      // a quaternion's chord is half the angle, near enough for a scale
      spread += (c.expected[k] - mean).squaredNorm() / covered;
      error += c.error[k] * c.error[k] / covered;
    }
    if (spread <= 0) continue;
    ++moving;
    sum += error / spread;
  }
  if (moving == 0) return std::nullopt;
  return sum / static_cast<double>(moving);
}

}  // namespace

ErrorNumbers error_numbers(QuantityKind kind, const std::vector<double>& time,
                           const std::vector<QuantityValue>& value,
                           const std::vector<QuantityValue>& expected) {
  ErrorNumbers numbers;
  if (time.empty()) return numbers;
  const auto count = static_cast<double>(time.size());
  std::vector<double> errors;
  Vec4 bias = Vec4::Zero();
  double squares = 0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    const double e = distance(kind, value[k], expected[k]);
    errors.push_back(e);
    squares += e * e / count;
    numbers.mean += e / count;
    bias += difference(kind, value[k], expected[k]) / count;
    numbers.range = std::max(numbers.range, distance(kind, expected[k], expected[0]));
    if (e <= numbers.max && k > 0) continue;
    numbers.max = e;
    numbers.max_time = time[k];
  }
  numbers.rms = std::sqrt(squares);
  numbers.bias = bias.norm();
  numbers.last = errors.back();
  std::sort(errors.begin(), errors.end());
  numbers.median = quantile(errors, 0.5);
  numbers.percentile_95 = quantile(errors, 0.95);
  return numbers;
}

QuantityComparison compare_quantity(const Series& series, const SeriesQuantity& quantity,
                                    const Series& reference, const SeriesQuantity& expected,
                                    double lag) {
  QuantityComparison result{quantity, expected, {}, {}, {}, {}, 0, {}};
  for (std::size_t k = 0; k < reference.size(); ++k) {
    const QuantityValue r = value_at(reference, expected, k);
    const auto x = interpolate(series, quantity, reference.time[k] + lag);
    if (!x || !r.allFinite()) {
      ++result.outside;
      continue;
    }
    result.time.push_back(reference.time[k]);
    result.value.push_back(*x);
    result.expected.push_back(r);
    result.error.push_back(distance(quantity.kind, *x, r));
  }
  result.numbers = error_numbers(quantity.kind, result.time, result.value, result.expected);
  return result;
}

std::optional<Lag> estimate_lag(const Series& series, const Series& reference,
                                const std::vector<QuantityPair>& pairs) {
  constexpr double kReach = 0.1;  // of the duration
  constexpr int kShifts = 50;     // to each side, then golden section between two of them
  constexpr int kSections = 40;
  if (reference.size() < 5) return std::nullopt;
  const auto unshifted = relative_error(series, reference, pairs, 0);
  if (!unshifted) return std::nullopt;
  const double reach = kReach * (reference.time.back() - reference.time.front());
  double best = 0, least = *unshifted;
  for (int i = -kShifts; i <= kShifts; ++i) {
    const double lag = reach * i / kShifts;
    const auto found = relative_error(series, reference, pairs, lag);
    if (found && *found < least) {
      least = *found;
      best = lag;
    }
  }
  const double ratio = (std::sqrt(5.0) - 1) / 2;
  double low = best - reach / kShifts, high = best + reach / kShifts;
  const auto at = [&](double lag) {
    return relative_error(series, reference, pairs, lag)
        .value_or(std::numeric_limits<double>::max());
  };
  for (int i = 0; i < kSections; ++i) {
    const double a = high - ratio * (high - low), b = low + ratio * (high - low);
    (at(a) < at(b) ? high : low) = at(a) < at(b) ? b : a;
  }
  const double middle = 0.5 * (low + high);
  if (at(middle) < least) {
    best = middle;
    least = at(middle);
  }
  return Lag{best, std::sqrt(*unshifted), std::sqrt(least)};
}

}  // namespace cprsim
