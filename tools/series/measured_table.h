// SPDX-License-Identifier: BSD-3-Clause
// Measured numbers from a CSV file: one header line `name [unit],...`, then rows. Lines that start
// with # say where the numbers come from and are skipped.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace cprsim {

/// The file cannot be read, or is no table; says where and why.
class TableError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct MeasuredColumn {
  std::string name;
  std::string unit;            ///< as in the header, empty if it names none
  std::vector<double> values;  ///< in that unit; NaN where the cell says that there is none
};

struct MeasuredTable {
  std::string path;
  std::vector<MeasuredColumn> columns;
  std::vector<int> lines;  ///< of the file, per row

  std::size_t rows() const { return lines.size(); }

  const MeasuredColumn* find(const std::string& name) const;
  std::vector<std::string> names() const;
};

/// What is in a file. @throws TableError
std::string table_text(const std::string& path);

/// Cells that are empty, nan, NA, - or ? are numbers that are not there; any other text is an
/// error.
/// @throws TableError
MeasuredTable read_measured_table(const std::string& path);

/// The same from memory. @param name stands for the file in messages
MeasuredTable parse_measured_table(const std::string& text, const std::string& name);

/// How many SI units one of `unit` is, and which SI unit that is: "cm" is 0.01 "m".
struct SiUnit {
  double factor = 1;
  std::string name;
};

std::optional<SiUnit> si_unit(const std::string& unit);

}  // namespace cprsim
