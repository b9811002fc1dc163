// SPDX-License-Identifier: BSD-3-Clause
// A state as a sequence of numbers. Whoever has state says once, in visit(), of what it consists;
// the same visit writes a checkpoint, reads it back bit for bit, and hashes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/math/types.h"

namespace cprsim {

class Archive {
 public:
  virtual ~Archive() = default;

  virtual bool reading() const = 0;
  /// Of a trivial type, without padding.
  virtual void bytes(void* data, std::size_t size) = 0;

  template <class T>
  requires std::is_arithmetic_v<T>

  void operator()(T& number) { bytes(&number, sizeof number); }

  /// A file may hold any byte for it.
  void operator()(bool& flag) {
    auto byte = static_cast<unsigned char>(flag ? 1 : 0);
    bytes(&byte, 1);
    flag = byte != 0;
  }

  /// Matrices of fixed size.
  template <int Rows, int Columns>

  requires(Rows > 0 && Columns > 0) void operator()(Eigen::Matrix<double, Rows, Columns>& m) {
    bytes(m.data(), static_cast<std::size_t>(m.size()) * sizeof(double));
  }

  void operator()(Pose& X) {
    (*this)(X.R);
    (*this)(X.p);
  }

  /// Sizes are those of the robot: one that differs belongs to another robot.
  void operator()(VecX& v) {
    expect(static_cast<std::size_t>(v.size()));
    bytes(v.data(), static_cast<std::size_t>(v.size()) * sizeof(double));
  }

  void operator()(MatX& m) {
    expect(static_cast<std::size_t>(m.size()));
    bytes(m.data(), static_cast<std::size_t>(m.size()) * sizeof(double));
  }

  /// Structs that hold nothing but doubles, as many as there are.
  template <class T>
  void doubles(std::vector<T>& list) {
    static_assert(sizeof(T) % sizeof(double) == 0);
    expect(list.size());
    bytes(list.data(), list.size() * sizeof(T));
  }

  /// The same, as many as were written: one at least, at most `most`.
  template <class T>
  void resized_doubles(std::vector<T>& list, std::size_t most) {
    static_assert(sizeof(T) % sizeof(double) == 0);
    list.resize(1 + count(list.size() - 1, most - 1));
    bytes(list.data(), list.size() * sizeof(T));
  }

  void operator()(std::string& text) {
    constexpr std::size_t kMost = 4096;
    text.resize(count(text.size(), kMost));
    bytes(text.data(), text.size());
  }

  /// How many follow: of what is there, or as written. @throws StateError beyond `most`
  std::size_t count(std::size_t present, std::size_t most);
  /// @throws StateError unless just as many were written
  void expect(std::size_t present);
};

}  // namespace cprsim
