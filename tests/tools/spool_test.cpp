// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/spool.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/tools/scratch_folder.h"
#include "tools/sinks/output_file.h"

namespace cprsim {
namespace {

/// Row k of array i holds width / 4 times the number 1000 i + k.
std::vector<int> rows_of(int array, std::size_t first, std::size_t count, std::size_t numbers) {
  std::vector<int> rows;
  for (std::size_t k = first; k < first + count; ++k)
    rows.insert(rows.end(), numbers, 1000 * array + static_cast<int>(k));
  return rows;
}

TEST(Spool, GivesEveryArrayBackWhole) {
  const ScratchFolder folder;
  Spool spool(folder.path(), {4, 12, 0, 8}, 10);
  for (const std::size_t rows : {10u, 10u, 10u, 7u}) {
    const auto first = static_cast<std::size_t>(spool.rows());
    const auto a = rows_of(0, first, rows, 1), b = rows_of(1, first, rows, 3),
               d = rows_of(3, first, rows, 2);
    spool.append(rows, {a.data(), b.data(), nullptr, d.data()});
  }
  EXPECT_EQ(spool.rows(), 37u);
  EXPECT_EQ(spool.bytes(1), 37u * 12);
  for (const auto& [array, numbers] : {std::pair{0, 1}, {1, 3}, {3, 2}}) {
    std::string all;
    for_each_piece(spool, static_cast<std::size_t>(array),
                   [&](const char* data, std::size_t size) { all.append(data, size); });
    const auto expected = rows_of(array, 0, 37, static_cast<std::size_t>(numbers));
    ASSERT_EQ(all.size(), expected.size() * 4);
    EXPECT_EQ(std::memcmp(all.data(), expected.data(), all.size()), 0) << array;
  }
  EXPECT_EQ(spool.read(2, 0, nullptr, 10), 0u);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nobody sees the file";
}

TEST(Spool, WithoutAFolderIsRefused) {
  EXPECT_THROW(Spool("/nowhere/at/all", {8}, 10), OutputError);
}

}  // namespace
}  // namespace cprsim
