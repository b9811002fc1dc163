// SPDX-License-Identifier: BSD-3-Clause
// Channels over time as comma-separated values: one header line with units, no comments, every
// number the shortest text that reads back to the same double.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/model/channel.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

class CsvWriter {
 public:
  CsvWriter(const std::filesystem::path& path, const std::vector<Channel>& channels);

  void write_row(double time, std::span<const double> values);
  void finish();

  long rows() const { return rows_; }

 private:
  OutputFile file_;
  std::string line_;
  long rows_ = 0;
};

/// The shortest decimal that std::from_chars reads back exactly.
std::string shortest(double value);

}  // namespace cprsim
