// SPDX-License-Identifier: BSD-3-Clause
// Strict reading of values: the whole text must be the value, numbers must be finite, and the
// machine's language settings have no influence.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/math/types.h"

namespace cprsim {

/// An index of the scene, which counts from 0 and has -1 for nothing, as the library's lists want
/// it.
inline std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

std::string_view trim(std::string_view text);

/// Pieces between white space.
std::vector<std::string_view> split_words(std::string_view text);

/// Pieces between occurrences of `at`; one piece, perhaps empty, if there is none.
std::vector<std::string> split(std::string_view text, char at);

/// A finite number; infinities only if allowed. Empty if the text is anything else.
std::optional<double> parse_number(std::string_view text, bool allow_infinite = false);

std::optional<long long> parse_integer(std::string_view text);

/// true, false, 1, 0
std::optional<bool> parse_bool(std::string_view text);

/// All numbers of a white-space separated list; empty optional if one of them is not a number.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

std::optional<Vec3> parse_vec3(std::string_view text);

struct Keyframe {
  double time = 0, value = 0;
};

/// "0 0, 1 0.05, 2 0.05": pairs of time and value, separated by commas.
std::optional<std::vector<Keyframe>> parse_keyframes(std::string_view text);

/// Shortest text that reads back as the same number.
std::string format_number(double value);

/// Roll, pitch, yaw about the fixed axes x, y, z, as in SDF.
Mat3 rotation_from_rpy(double roll, double pitch, double yaw);

/// A rotation that turns the z axis onto `direction` (unit).
Mat3 rotation_onto(const Vec3& direction);

}  // namespace cprsim
