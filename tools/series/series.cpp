// SPDX-License-Identifier: BSD-3-Clause
#include "tools/series/series.h"

#include <algorithm>
#include <cmath>

namespace cprsim {

namespace {

/// Relative to a step: times are sums of rounded steps.
constexpr double kRoundOff = 1e-9;

/// Index of the column called NAME.COMPONENT, or nothing.
std::optional<std::size_t> component(const Series& series, const std::string& name,
                                     const char* letter) {
  for (std::size_t i = 0; i < series.columns.size(); ++i)
    if (series.columns[i].name == name + "." + letter) return i;
  return std::nullopt;
}

std::optional<SeriesQuantity> group_of(const Series& series, const std::string& column) {
  if (!column.ends_with(".x")) return std::nullopt;
  SeriesQuantity quantity;
  quantity.name = column.substr(0, column.size() - 2);
  const auto x = component(series, quantity.name, "x"), y = component(series, quantity.name, "y"),
             z = component(series, quantity.name, "z"), w = component(series, quantity.name, "w");
  if (!y || !z) return std::nullopt;
  quantity.columns = {*x, *y, *z, w.value_or(0)};
  quantity.kind = w ? QuantityKind::kAttitude : QuantityKind::kVector;
  quantity.unit = w ? "rad" : series.columns[*x].unit;
  return quantity;
}

}  // namespace

std::vector<SeriesQuantity> quantities_of(const Series& series) {
  std::vector<SeriesQuantity> all;
  std::vector<bool> taken(series.columns.size(), false);
  for (const SeriesColumn& column : series.columns) {
    if (const auto group = group_of(series, column.name)) {
      for (std::size_t i = 0; i < group->width(); ++i)
        taken[group->columns[i]] = true;
      all.push_back(*group);
    }
  }
  for (std::size_t i = 0; i < series.columns.size(); ++i) {
    if (taken[i]) continue;
    const SeriesColumn& column = series.columns[i];
    all.push_back({column.name, column.unit, QuantityKind::kScalar, {i, 0, 0, 0}});
  }
  return all;
}

QuantityValue value_at(const Series& series, const SeriesQuantity& quantity, std::size_t row) {
  QuantityValue value = QuantityValue::Zero();
  for (std::size_t i = 0; i < quantity.width(); ++i)
    value[static_cast<Eigen::Index>(i)] = series.columns[quantity.columns[i]].values[row];
  return value;
}

std::optional<QuantityValue> interpolate(const Series& series, const SeriesQuantity& quantity,
                                         double time) {
  const std::vector<double>& t = series.time;
  if (t.empty()) return std::nullopt;
  auto after = std::lower_bound(t.begin(), t.end(), time);
  // within round-off of a sample that sample is meant
  const double step = t.size() > 1 ? (t.back() - t.front()) / static_cast<double>(t.size() - 1) : 0;
  const double slack = kRoundOff * std::max(step, std::abs(time));
  if (after == t.end() && time <= t.back() + slack) --after;
  if (after == t.end()) return std::nullopt;
  const auto b = static_cast<std::size_t>(after - t.begin());
  if (std::abs(t[b] - time) <= slack) {
    const QuantityValue value = value_at(series, quantity, b);
    return value.allFinite() ? std::optional(value) : std::nullopt;
  }
  if (b == 0) return std::nullopt;
  const QuantityValue from = value_at(series, quantity, b - 1), to = value_at(series, quantity, b);
  if (!from.allFinite() || !to.allFinite()) return std::nullopt;
  const double fraction = (time - t[b - 1]) / (t[b] - t[b - 1]);
  if (quantity.kind != QuantityKind::kAttitude)
    return QuantityValue((1 - fraction) * from + fraction * to);
  const Quat q = quaternion(from).slerp(fraction, quaternion(to));
  return QuantityValue(q.x(), q.y(), q.z(), q.w());
}

double distance(QuantityKind kind, const QuantityValue& a, const QuantityValue& b) {
  if (kind != QuantityKind::kAttitude) return (a - b).norm();
  // 2 atan2 keeps the digits of small angles that 2 acos|<a, b>| loses
  return quaternion(a).angularDistance(quaternion(b));
}

}  // namespace cprsim
