// SPDX-License-Identifier: BSD-3-Clause
// NumPy's file format for one array, version 1.0.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cprsim {

/// What comes before the numbers of an array of doubles, the last index fastest.
std::string npy_header(std::uint64_t rows, const std::vector<std::size_t>& row_shape);

}  // namespace cprsim
