// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/csv.h"

#include <array>
#include <charconv>

namespace cprsim {

namespace {

void append_number(std::string& line, double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  line.append(digits.data(), end);
}

/// Quoted as in RFC 4180 if the name holds a comma or a quote, e.g. contact(a,b).
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

std::string shortest(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<Channel>& channels)
    : file_(path) {
  line_ = "time [s]";
  for (const Channel& channel : channels) {
    line_ += ',' + cell(channel.name + " [" + channel.unit + "]");
  }
  line_ += '\n';
  file_.write(line_);
}

void CsvWriter::write_row(double time, std::span<const double> values) {
  line_.clear();
  append_number(line_, time);
  for (const double value : values) {
    line_ += ',';
    append_number(line_, value);
  }
  line_ += '\n';
  file_.write(line_);
  ++rows_;
}

void CsvWriter::finish() {
  file_.commit();
}

}  // namespace cprsim
