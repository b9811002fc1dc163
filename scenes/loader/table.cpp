// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/table.h"

#include <algorithm>

#include "scenes/loader/files.h"
#include "scenes/loader/values.h"

namespace cprsim {
namespace {

constexpr std::size_t kMostNumbers = 2'000'000;

const std::string& name_of_file(const Node& node, const Attribute* file) {
  return file ? file->value : node.text;
}

Diagnostic& complain(Reading& r, const Node& node, const Attribute* file, const std::string& code,
                     const std::string& message) {
  return file ? r.report.bad_value(code, node, *file, message)
              : r.report.bad_text(code, node, message);
}

/// Why the text is no table, or nothing.
std::string parse(const std::string& text, Table& table) {
  int line = 0;
  std::size_t numbers = 0;
  for (const std::string& whole : split(text, '\n')) {
    ++line;
    const std::string_view content = trim(whole);
    if (content.empty() || content[0] == '#') continue;
    const std::vector<std::string> fields = split(content, ',');
    std::vector<double> values;
    std::size_t wrong = fields.size();
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (const auto value = parse_number(trim(fields[i])))
        values.push_back(*value);
      else
        wrong = std::min(wrong, i);
    const std::string where = "line " + std::to_string(line) + ": ";
    if (values.empty() && table.rows.empty() && table.names.empty()) {
      for (const std::string& field : fields)
        table.names.emplace_back(trim(field));
      continue;
    }
    if (wrong < fields.size())
      return where + "'" + std::string(trim(fields[wrong])).substr(0, 40) + "' is not a number";
    const std::size_t width = table.rows.empty()
                                  ? (table.names.empty() ? values.size() : table.names.size())
                                  : table.rows.front().size();
    if (values.size() != width)
      return where + std::to_string(values.size()) + " numbers, not " + std::to_string(width);
    numbers += values.size();
    if (numbers > kMostNumbers) return "more than " + std::to_string(kMostNumbers) + " numbers";
    table.rows.push_back(std::move(values));
    table.lines.push_back(line);
  }
  return table.rows.empty() ? "it holds no numbers" : "";
}

}  // namespace

std::optional<std::size_t> Table::column(std::string_view name) const {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name || trim(std::string_view(names[i]).substr(0, names[i].find(" ["))) == name)
      return i;
  const auto number = parse_number(name);
  const std::size_t width = rows.empty() ? 0 : rows.front().size();
  if (number && *number >= 1 && *number <= static_cast<double>(width) &&
      *number == static_cast<double>(static_cast<std::size_t>(*number)))
    return static_cast<std::size_t>(*number) - 1;
  return std::nullopt;
}

std::optional<Table> read_table(Reading& r, const Node& node, const Attribute* file) {
  const std::string& name = name_of_file(node, file);
  const auto in = static_cast<std::size_t>(std::max(node.place.file, 0));
  const FoundFile found = find_resource(name, r.folders[in], r.roots);
  if (!found.code.empty()) {
    Diagnostic& d = complain(r, node, file, found.code, found.message);
    for (const std::string& place : found.tried)
      d.details.push_back("tried " + place);
    return std::nullopt;
  }
  FileContent content = read_file(found.path);
  if (!content.code.empty()) {
    complain(r, node, file, content.code, "'" + name + "' " + content.message);
    return std::nullopt;
  }
  Table table;
  const std::string problem = parse(content.text, table);
  if (!problem.empty()) {
    complain_of_table(r, node, file, problem);
    return std::nullopt;
  }
  const auto& known = r.report.files();
  if (std::none_of(known.begin(), known.end(),
                   [&](const SourceFile& other) { return other.path == found.path; }))
    r.report.add_file(found.path, std::move(content.text));
  return table;
}

void complain_of_table(Reading& r, const Node& node, const Attribute* file,
                       const std::string& problem) {
  complain(r, node, file, "E110", "'" + name_of_file(node, file) + "', " + problem);
}

std::string check_fractions(const Table& table, std::size_t column) {
  constexpr std::size_t kMostLines = 10'000;
  if (table.rows.size() > kMostLines) return "more than " + std::to_string(kMostLines) + " lines";
  for (std::size_t i = 1; i < table.rows.size(); ++i)
    if (table.rows[i][column] <= table.rows[i - 1][column])
      return "line " + std::to_string(table.lines[i]) + ": s does not ascend";
  if (table.rows.front()[column] != 0 || table.rows.back()[column] != 1)
    return "s does not go from 0 to 1: it is a fraction of the rod's length";
  return "";
}

}  // namespace cprsim
