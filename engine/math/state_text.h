// SPDX-License-Identifier: BSD-3-Clause
// The three archives: a state as text (bytes), read back, and as one number.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "engine/math/archive.h"

namespace cprsim {

/// A state that cannot be read: damaged, or of another robot.
class StateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class StateWriter final : public Archive {
 public:
  bool reading() const override { return false; }

  void bytes(void* data, std::size_t size) override;

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// @throws StateError where the text ends too early
class StateReader final : public Archive {
 public:
  explicit StateReader(std::string_view text) : text_(text) {}

  bool reading() const override { return true; }

  void bytes(void* data, std::size_t size) override;

  /// @throws StateError unless all was read
  void finish() const;

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

/// FNV-1a, 64 bits (Fowler, Noll, Vo; IETF draft-eastlake-fnv).
std::uint64_t fnv1a(std::string_view text, std::uint64_t value = 0xcbf29ce484222325U);

class StateHash final : public Archive {
 public:
  bool reading() const override { return false; }

  void bytes(void* data, std::size_t size) override;

  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace cprsim
