// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/checkpoint.h"

#include <fmt/core.h>

#include <charconv>
#include <fstream>

#include "engine/math/state_text.h"
#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

constexpr std::string_view kMagic = "cprsim-state/1";
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30;

/// Takes "NAME value\n" off the front. @return the value
std::string_view take_line(std::string_view& text, std::string_view name) {
  const std::size_t end = text.substr(0, 4096).find('\n');
  if (end == std::string_view::npos || text.substr(0, name.size()) != name)
    throw StateError(fmt::format("no '{}' where it belongs", name));
  std::string_view value = text.substr(name.size(), end - name.size());
  text.remove_prefix(end + 1);
  if (!value.empty() && value.front() == ' ') value.remove_prefix(1);
  return value;
}

template <class Number>
Number to_number(std::string_view text, int base_or_nothing = 10) {
  Number number{};
  std::from_chars_result parsed{};
  if constexpr (std::is_integral_v<Number>)
    parsed = std::from_chars(text.data(), text.data() + text.size(), number, base_or_nothing);
  else
    parsed = std::from_chars(text.data(), text.data() + text.size(), number);
  if (parsed.ec != std::errc{} || parsed.ptr != text.data() + text.size())
    throw StateError(fmt::format("'{}' is no number", text));
  return number;
}

std::string head_of(const Checkpoint& c) {
  const std::uint64_t check = fnv1a(c.outputs, fnv1a(c.simulation));
  return fmt::format(
      "{}\nscene {}\nprogram {}\ntime {}\nsimulation {}\noutputs {}\ncheck {:016x}\n", kMagic,
      c.scene_hash, c.program, shortest(c.time), c.simulation.size(), c.outputs.size(), check);
}

}  // namespace

std::string to_text(const Checkpoint& c) {
  return head_of(c) + c.simulation + c.outputs;
}

Checkpoint parse_checkpoint(std::string_view text) {
  const std::string_view whole = text;
  Checkpoint c;
  if (!take_line(text, kMagic).empty()) throw StateError("not a state of this program");
  c.scene_hash = take_line(text, "scene");
  c.program = take_line(text, "program");
  c.time = to_number<double>(take_line(text, "time"));
  const auto simulation = to_number<std::size_t>(take_line(text, "simulation"));
  const auto outputs = to_number<std::size_t>(take_line(text, "outputs"));
  const auto check = to_number<std::uint64_t>(take_line(text, "check"), 16);
  if (simulation > text.size() || outputs != text.size() - simulation)
    throw StateError("cut off, or longer than it says");
  c.simulation = text.substr(0, simulation);
  c.outputs = text.substr(simulation);
  // the check is of what follows the head; the head is what this program writes, or was changed
  if (fnv1a(c.outputs, fnv1a(c.simulation)) != check || !whole.starts_with(head_of(c)))
    throw StateError("changed since it was written");
  return c;
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw StateError(path.string() + ": no such file, or not a regular one");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > kMostBytes) throw StateError(path.string() + ": larger than 1 GiB");
  std::ifstream stream(path, std::ios::binary);
  std::string text(static_cast<std::size_t>(size), '\0');
  if (!stream.read(text.data(), static_cast<std::streamsize>(size)))
    throw StateError(path.string() + ": cannot be read");
  try {
    return parse_checkpoint(text);
  } catch (const StateError& wrong) {
    throw StateError(path.string() + ": " + wrong.what());
  }
}

}  // namespace cprsim
