// SPDX-License-Identifier: BSD-3-Clause
// Measurements and trajectories are read or refused with a reason.
#include <string>

#include "tests/fuzz/target.h"
#include "tools/series/read_series.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cprsim;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const MeasuredTable table = parse_measured_table(text, "fuzz.csv");
    for (const MeasuredColumn& column : table.columns)
      require(column.values.size() == table.rows(), "columns are as long as the table");
  } catch (const TableError& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
  try {
    parse_series(text, "fuzz.csv");
  } catch (const TableError& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
  return 0;
}
