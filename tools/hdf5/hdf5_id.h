// SPDX-License-Identifier: BSD-3-Clause
// What the HDF5 library hands out: a number for every open file, data set, type. It is given back
// when its owner goes.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace cprsim {

/// The library's own words, or those of the system call that failed below it.
class Hdf5Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Hdf5Id {
 public:
  Hdf5Id() = default;
  /// Takes what a call of the library returned. @throws Hdf5Error if that call failed
  explicit Hdf5Id(std::int64_t id);
  ~Hdf5Id();
  Hdf5Id(const Hdf5Id&) = delete;
  Hdf5Id& operator=(const Hdf5Id&) = delete;

  Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)) {}

  Hdf5Id& operator=(Hdf5Id&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }

  /// For the library's functions.
  operator std::int64_t() const { return id_; }

  /// Gives it back now. @throws Hdf5Error if something could not be written
  void close();

 private:
  std::int64_t id_ = -1;
};

/// The answer of a call, if it succeeded. @throws Hdf5Error
int checked(int status);

/// "1.10.8"
std::string hdf5_library_version();

/// Before the first call: the library prints nothing and does nothing when the program ends.
void start_hdf5();

}  // namespace cprsim
