// SPDX-License-Identifier: BSD-3-Clause
#include "engine/math/archive.h"

#include <bit>

#include "engine/math/state_text.h"

namespace cprsim {

static_assert(std::endian::native == std::endian::little, "states are written as they lie");

std::size_t Archive::count(std::size_t present, std::size_t most) {
  std::uint64_t n = present;
  bytes(&n, sizeof n);
  if (n > most) throw StateError("the state counts more of something than there can be");
  return static_cast<std::size_t>(n);
}

void Archive::expect(std::size_t present) {
  std::uint64_t n = present;
  bytes(&n, sizeof n);
  if (n != present) throw StateError("the state is that of another robot");
}

void StateWriter::bytes(void* data, std::size_t size) {
  text_.append(static_cast<const char*>(data), size);
}

void StateReader::bytes(void* data, std::size_t size) {
  if (size > text_.size() - at_) throw StateError("the state ends too early");
  std::copy_n(text_.data() + at_, size, static_cast<char*>(data));
  at_ += size;
}

void StateReader::finish() const {
  if (at_ != text_.size()) throw StateError("the state goes on after its end");
}

void StateHash::bytes(void* data, std::size_t size) {
  value_ = fnv1a({static_cast<const char*>(data), size}, value_);
}

std::uint64_t fnv1a(std::string_view text, std::uint64_t value) {
  for (const char c : text)
    value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return value;
}

}  // namespace cprsim
