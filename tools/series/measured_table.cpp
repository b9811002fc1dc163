// SPDX-License-Identifier: BSD-3-Clause
#include "tools/series/measured_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "scenes/loader/files.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

/// Cells of a line, quotes as in RFC 4180 taken off.
std::vector<std::string> split_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells)
    cell = std::string(trim(cell));
  return cells;
}

bool says_nothing(const std::string& cell) {
  static const std::set<std::string> words{"", "nan", "NaN", "NAN", "NA", "n/a", "-", "?"};
  return words.count(cell) > 0;
}

/// "tip x [cm]" in name and unit.
MeasuredColumn header_of(const std::string& cell) {
  const std::size_t open = cell.rfind('[');
  if (cell.empty() || cell.back() != ']' || open == std::string::npos) return {cell, "", {}};
  return {std::string(trim(cell.substr(0, open))),
          std::string(trim(cell.substr(open + 1, cell.size() - open - 2))),
          {}};
}

void read_header(MeasuredTable& table, const std::string& line, int number) {
  for (const std::string& cell : split_cells(line)) {
    MeasuredColumn column = header_of(cell);
    const std::string place = fmt::format("{}:{}: ", table.path, number);
    if (column.name.empty())
      throw TableError(place + fmt::format("column {} has no name", table.columns.size() + 1));
    if (parse_number(column.name))
      throw TableError(place + "the first line holds numbers; it must name the columns");
    if (table.find(column.name) != nullptr)
      throw TableError(place + "two columns are called '" + column.name + "'");
    if (!column.unit.empty() && !si_unit(column.unit))
      throw TableError(place + "the unit [" + column.unit + "] of column '" + column.name +
                       "' is not known");
    table.columns.push_back(std::move(column));
  }
}

void read_row(MeasuredTable& table, const std::string& line, int number) {
  const std::vector<std::string> cells = split_cells(line);
  if (cells.size() != table.columns.size()) {
    throw TableError(fmt::format("{}:{}: {} cells, but the header names {} columns", table.path,
                                 number, cells.size(), table.columns.size()));
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    double value = std::numeric_limits<double>::quiet_NaN();
    if (!says_nothing(cells[i])) {
      const auto parsed = parse_number(cells[i]);
      if (!parsed) {
        throw TableError(fmt::format("{}:{}: '{}' in column '{}' is not a number", table.path,
                                     number, cells[i], table.columns[i].name));
      }
      value = *parsed;
    }
    table.columns[i].values.push_back(value);
  }
  table.lines.push_back(number);
}

}  // namespace

const MeasuredColumn* MeasuredTable::find(const std::string& name) const {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const MeasuredColumn& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

std::vector<std::string> MeasuredTable::names() const {
  std::vector<std::string> all;
  for (const MeasuredColumn& column : columns)
    all.push_back(column.name);
  return all;
}

MeasuredTable parse_measured_table(const std::string& text, const std::string& name) {
  MeasuredTable table;
  table.path = name;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line(trim(text.substr(at, end - at)));
    at = end + 1;
    ++number;
    if (line.empty() || line.front() == '#') continue;
    if (table.columns.empty())
      read_header(table, line, number);
    else
      read_row(table, line, number);
  }
  if (table.columns.empty()) throw TableError(name + ": the table is empty");
  if (table.lines.empty()) throw TableError(name + ": the table has a header but no rows");
  return table;
}

std::string table_text(const std::string& path) {
  const FileContent content = read_file(path);
  if (!content.code.empty()) {
    throw TableError(path + (content.code == "E101" ? ": cannot be opened: " : ": the file ") +
                     content.message);
  }
  return content.text;
}

MeasuredTable read_measured_table(const std::string& path) {
  return parse_measured_table(table_text(path), path);
}

std::optional<SiUnit> si_unit(const std::string& unit) {
  struct Entry {
    const char* name;
    double factor;
    const char* si;
  };

  static constexpr double kDegree = std::numbers::pi / 180;
  static constexpr Entry kUnits[] = {
      {"1", 1, "1"},           {"%", 0.01, "1"},       {"m", 1, "m"},
      {"cm", 0.01, "m"},       {"mm", 0.001, "m"},     {"um", 1e-6, "m"},
      {"s", 1, "s"},           {"ms", 0.001, "s"},     {"rad", 1, "rad"},
      {"deg", kDegree, "rad"}, {"m/s", 1, "m/s"},      {"cm/s", 0.01, "m/s"},
      {"mm/s", 0.001, "m/s"},  {"rad/s", 1, "rad/s"},  {"deg/s", kDegree, "rad/s"},
      {"N", 1, "N"},           {"mN", 0.001, "N"},     {"kN", 1000, "N"},
      {"N m", 1, "N m"},       {"Nm", 1, "N m"},       {"N mm", 0.001, "N m"},
      {"Nmm", 0.001, "N m"},   {"mN m", 0.001, "N m"}, {"1/m", 1, "1/m"},
      {"1/mm", 1000, "1/m"},   {"J", 1, "J"},          {"mJ", 0.001, "J"},
      {"kg", 1, "kg"},         {"g", 0.001, "kg"},     {"Pa", 1, "Pa"},
      {"MPa", 1e6, "Pa"},      {"GPa", 1e9, "Pa"},     {"Hz", 1, "Hz"}};
  for (const Entry& entry : kUnits)
    if (unit == entry.name) return SiUnit{entry.factor, entry.si};
  return std::nullopt;
}

}  // namespace cprsim
