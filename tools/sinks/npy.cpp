// SPDX-License-Identifier: BSD-3-Clause
// Layout: numpy.org/doc/stable/reference/generated/numpy.lib.format.html: magic, version, a 16-bit
// length, a Python dictionary padded with blanks so that the numbers begin at a multiple of 64.
#include "tools/sinks/npy.h"

#include <stdexcept>

namespace cprsim {

std::string npy_header(std::uint64_t rows, const std::vector<std::size_t>& row_shape) {
  std::string shape = "(" + std::to_string(rows) + ",";
  for (const std::size_t extent : row_shape)
    shape += " " + std::to_string(extent) + ",";
  std::string text = "{'descr': '<f8', 'fortran_order': False, 'shape': " + shape + "), }";
  constexpr std::size_t kBefore = 10, kAlignment = 64;
  while ((kBefore + text.size() + 1) % kAlignment != 0)
    text += ' ';
  text += '\n';
  if (text.size() > 0xffff) throw std::invalid_argument("an array of too many extents");
  std::string header = "\x93NUMPY";
  header +=
      {'\x01', '\x00', static_cast<char>(text.size() & 0xff), static_cast<char>(text.size() >> 8)};
  return header + text;
}

}  // namespace cprsim
