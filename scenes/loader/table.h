// SPDX-License-Identifier: BSD-3-Clause
// Numbers in columns, in a file beside the scene: comma-separated values, as `cprsim` itself
// records them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/loader/reading.h"

namespace cprsim {

struct Table {
  std::vector<std::string> names;         ///< of the columns; empty if the file gives none
  std::vector<std::vector<double>> rows;  ///< all of one width, finite
  std::vector<int> lines;                 ///< of the rows in the file, from 1

  /// A column by its name, with or without its unit ("x [m]"), or by its number, from 1.
  std::optional<std::size_t> column(std::string_view name) const;
};

/// A first line without a number holds names; empty lines and lines that start with # are passed
/// over. Nothing after an error, which is reported at the attribute, or at the text of the node if
/// that is null.
std::optional<Table> read_table(Reading& reading, const Node& node, const Attribute* file);

/// What is wrong with the table, at the same place.
void complain_of_table(Reading& reading, const Node& node, const Attribute* file,
                       const std::string& problem);

/// Why the column does not hold fractions of a rod's length, from 0 to 1; nothing where it does.
std::string check_fractions(const Table& table, std::size_t column);

}  // namespace cprsim
