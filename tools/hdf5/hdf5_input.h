// SPDX-License-Identifier: BSD-3-Clause
// Reading arrays and texts from an HDF5 file, whoever wrote it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/hdf5/hdf5_id.h"

namespace cprsim {

class Hdf5Input {
 public:
  /// @throws Hdf5Error, as do all members
  explicit Hdf5Input(const std::string& path);

  bool has(const std::string& path) const;
  /// What a group holds, in the order in which it was made, if the file knows that.
  std::vector<std::string> names(const std::string& group) const;
  /// Extents of an array; empty for a single number, nothing at all for what is no array.
  std::vector<std::size_t> shape(const std::string& path) const;
  /// All numbers of an array, the last index fastest.
  std::vector<double> numbers(const std::string& path) const;
  /// Those of one index of the first extent.
  std::vector<double> row(const std::string& path, std::size_t index) const;
  /// An attribute; empty if there is none, or none that is text.
  std::string text(const std::string& path, const std::string& attribute) const;

 private:
  Hdf5Id file_;
};

}  // namespace cprsim
