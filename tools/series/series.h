// SPDX-License-Identifier: BSD-3-Clause
// Numbers over time: what a run recorded, or what was measured. SI units.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/types.h"

namespace cprsim {

struct SeriesColumn {
  std::string name;  ///< a channel: robot::platform.position.x
  std::string unit;  ///< SI, empty if unknown
  std::vector<double> values;
};

struct Series {
  std::string path;
  std::vector<double> time;  ///< s, increasing
  std::vector<SeriesColumn> columns;

  std::size_t size() const { return time.size(); }
};

enum class QuantityKind { kScalar, kVector, kAttitude };

/// Columns that belong together: three components, the four of a quaternion x y z w, or one number.
struct SeriesQuantity {
  std::string name;  ///< without the component: robot::platform.position
  std::string unit;  ///< of its error: rad for attitudes
  QuantityKind kind = QuantityKind::kScalar;
  std::array<std::size_t, 4> columns{};  ///< of the series

  std::size_t width() const {
    return kind == QuantityKind::kScalar ? 1 : kind == QuantityKind::kVector ? 3 : 4;
  }
};

/// A value of a quantity; the first width() entries count.
using QuantityValue = Vec4;

/// Of x y z w, of any length but 0.
inline Quat quaternion(const QuantityValue& v) {
  return Quat(v[3], v[0], v[1], v[2]).normalized();
}

/// Groups columns by the names of their components: .x .y .z, and for orientations .x .y .z .w.
std::vector<SeriesQuantity> quantities_of(const Series& series);

QuantityValue value_at(const Series& series, const SeriesQuantity& quantity, std::size_t row);

/// Linear between samples, along the shortest arc for attitudes. Nothing before the first sample or
/// after the last, nor next to a number that is not there.
std::optional<QuantityValue> interpolate(const Series& series, const SeriesQuantity& quantity,
                                         double time);

/// How far b is from a: a length, or an angle in rad.
double distance(QuantityKind kind, const QuantityValue& a, const QuantityValue& b);

}  // namespace cprsim
