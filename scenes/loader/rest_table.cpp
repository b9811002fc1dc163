// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/rest_table.h"

#include <algorithm>

#include "scenes/loader/files.h"
#include "scenes/loader/values.h"

namespace cprsim {
namespace {

constexpr std::size_t kMostLines = 10'000;

/// Why the text is no such table, or nothing.
std::string parse(const std::string& text, std::vector<RestSample>& samples) {
  int number = 0;
  for (const std::string& line : split(text, '\n')) {
    ++number;
    const std::string_view content = trim(line);
    if (content.empty() || content[0] == '#') continue;
    const std::vector<std::string> fields = split(content, ',');
    std::vector<double> values;
    for (const std::string& field : fields)
      if (const auto value = parse_number(trim(field))) values.push_back(*value);
    const std::string where = "line " + std::to_string(number) + ": ";
    if (values.empty() && samples.empty()) continue;  // names
    if (values.size() != 4 || fields.size() != 4) return where + "not four numbers s,kx,ky,kz";
    if (!samples.empty() && values[0] <= samples.back().s) return where + "s does not ascend";
    if (samples.size() == kMostLines)
      return "more than " + std::to_string(kMostLines) + " lines";
    samples.push_back({values[0], {values[1], values[2], values[3]}});
  }
  if (samples.size() < 2) return "fewer than two lines s,kx,ky,kz";
  if (samples.front().s != 0 || samples.back().s != 1)
    return "s does not go from 0 to 1: it is a fraction of the rod's length";
  return "";
}

}  // namespace

std::vector<RestSample> read_rest_table(Reading& r, const Node& node) {
  const auto in = static_cast<std::size_t>(std::max(node.place.file, 0));
  const FoundFile found = find_resource(node.text, r.folders[in], r.roots);
  if (!found.code.empty()) {
    Diagnostic& d = r.report.bad_text(found.code, node, found.message);
    for (const std::string& place : found.tried)
      d.details.push_back("tried " + place);
    return {};
  }
  FileContent content = read_file(found.path);
  if (!content.code.empty()) {
    r.report.bad_text(content.code, node, "'" + node.text + "' " + content.message);
    return {};
  }
  std::vector<RestSample> samples;
  const std::string problem = parse(content.text, samples);
  if (!problem.empty()) {
    r.report.bad_text("E110", node, "'" + node.text + "', " + problem);
    return {};
  }
  const auto& known = r.report.files();
  if (std::none_of(known.begin(), known.end(),
                   [&](const SourceFile& file) { return file.path == found.path; }))
    r.report.add_file(found.path, std::move(content.text));
  return samples;
}

}  // namespace cprsim
