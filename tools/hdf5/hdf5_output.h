// SPDX-License-Identifier: BSD-3-Clause
// An HDF5 file that grows: arrays whose first extent is time, cut into compressed chunks. The file
// holds no date, so that the same numbers give the same bytes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tools/hdf5/hdf5_id.h"

namespace cprsim {

using Hdf5Attributes = std::vector<std::pair<std::string, std::string>>;

class Hdf5Output {
 public:
  /// Creates the file, over one that is there. @throws Hdf5Error, as do all members
  explicit Hdf5Output(const std::filesystem::path& path);

  /// An array without rows. @param path  rods/leg/position: groups are made as needed and keep the
  /// order in which they came
  /// @param shape of a row @param chunk_rows compressed together
  /// @return its number for append()
  std::size_t create(const std::string& path, const std::vector<std::size_t>& shape,
                     std::size_t chunk_rows, const Hdf5Attributes& attributes);
  void append(std::size_t array, std::size_t rows, std::span<const double> numbers);
  /// A small array that does not grow.
  void write(const std::string& path, std::span<const double> numbers,
             const Hdf5Attributes& attributes);
  /// Of the whole file.
  void annotate(const Hdf5Attributes& attributes);

  /// What was appended is in the file now, which can be read even if nothing follows.
  void flush();
  void close();

 private:
  struct Array {
    Hdf5Id set;
    std::vector<std::size_t> shape;
    std::size_t rows = 0;
  };

  Hdf5Id file_;
  std::vector<Array> arrays_;  ///< closed before the file
};

}  // namespace cprsim
