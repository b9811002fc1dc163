// SPDX-License-Identifier: BSD-3-Clause
// Arrays over time that come side by side, row after row, and are wanted one after another. They
// wait in a file without a name, which is gone if the process dies: memory does not grow with the
// run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace cprsim {

class Spool {
 public:
  /// @param folder in whose file system there is room @param widths bytes of a row, per array
  /// @throws OutputError, as do all members
  Spool(const std::filesystem::path& folder, std::vector<std::size_t> widths,
        std::size_t block_rows);
  ~Spool();
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  /// The next block: `rows` rows of every array. All blocks but the last have block_rows.
  /// @param data  per array
  void append(std::size_t rows, const std::vector<const void*>& data);

  std::uint64_t rows() const { return rows_; }

  /// Of an array as a whole.
  std::uint64_t bytes(std::size_t array) const { return rows_ * widths_[array]; }

  /// Reads on from a place in the array. @return how many bytes, 0 at the end
  std::size_t read(std::size_t array, std::uint64_t position, void* to, std::size_t most) const;

 private:
  std::filesystem::path folder_;
  std::vector<std::size_t> widths_, before_;  ///< before_: widths of all arrays before it
  std::size_t row_bytes_ = 0, block_rows_ = 0;
  std::uint64_t rows_ = 0;
  int descriptor_ = -1;
};

/// Hands an array on in pieces of at most 64 KiB.
template <class Take>
void for_each_piece(const Spool& spool, std::size_t array, Take&& take) {
  std::vector<char> piece(1 << 16);
  std::uint64_t position = 0;
  while (const std::size_t size = spool.read(array, position, piece.data(), piece.size())) {
    take(piece.data(), size);
    position += size;
  }
}

}  // namespace cprsim
