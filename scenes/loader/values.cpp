// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/values.h"

#include <charconv>
#include <cmath>

#include "engine/math/so3.h"

namespace cprsim {

namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

}  // namespace

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_space(text.front()))
    text.remove_prefix(1);
  while (!text.empty() && is_space(text.back()))
    text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> split_words(std::string_view text) {
  std::vector<std::string_view> words;
  std::size_t i = 0;
  while (i < text.size()) {
    while (i < text.size() && is_space(text[i]))
      ++i;
    const std::size_t start = i;
    while (i < text.size() && !is_space(text[i]))
      ++i;
    if (i > start) words.push_back(text.substr(start, i - start));
  }
  return words;
}

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::optional<double> parse_number(std::string_view text, bool allow_infinite) {
  text = trim(text);
  if (allow_infinite && (text == "inf" || text == "INF" || text == "+inf")) return HUGE_VAL;
  if (allow_infinite && (text == "-inf" || text == "-INF")) return -HUGE_VAL;
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && (text.front() == '-' || text.front() == '+')) return std::nullopt;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

std::optional<long long> parse_integer(std::string_view text) {
  text = trim(text);
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<bool> parse_bool(std::string_view text) {
  text = trim(text);
  if (text == "true" || text == "1") return true;
  if (text == "false" || text == "0") return false;
  return std::nullopt;
}

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view word : split_words(text)) {
    const auto value = parse_number(word);
    if (!value) return std::nullopt;
    numbers.push_back(*value);
  }
  return numbers;
}

std::optional<Vec3> parse_vec3(std::string_view text) {
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 3) return std::nullopt;
  return Vec3((*numbers)[0], (*numbers)[1], (*numbers)[2]);
}

std::optional<std::vector<Keyframe>> parse_keyframes(std::string_view text) {
  std::vector<Keyframe> frames;
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    const auto pair = parse_numbers(text.substr(0, comma));
    if (!pair || pair->size() != 2) return std::nullopt;
    frames.push_back({(*pair)[0], (*pair)[1]});
    if (comma == std::string_view::npos) return frames;
    text.remove_prefix(comma + 1);
  }
  return std::nullopt;
}

std::string format_number(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return error == std::errc() ? std::string(buffer, end) : std::string("?");
}

Mat3 rotation_from_rpy(double roll, double pitch, double yaw) {
  return exp_so3({0, 0, yaw}) * exp_so3({0, pitch, 0}) * exp_so3({roll, 0, 0});
}

Mat3 rotation_onto(const Vec3& direction) {
  return rotation_between(Vec3::UnitZ(), direction);
}

}  // namespace cprsim
