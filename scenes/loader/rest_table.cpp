// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/rest_table.h"

#include "scenes/loader/table.h"

namespace cprsim {
namespace {

constexpr std::size_t kMostLines = 10'000;

/// Why the table is none of rest curvatures, or nothing.
std::string take(const Table& table, std::vector<RestSample>& samples) {
  if (table.rows.front().size() != 4) return "its lines are not four numbers s,kx,ky,kz";
  if (table.rows.size() < 2) return "fewer than two lines s,kx,ky,kz";
  if (table.rows.size() > kMostLines) return "more than " + std::to_string(kMostLines) + " lines";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& row = table.rows[i];
    if (i > 0 && row[0] <= table.rows[i - 1][0])
      return "line " + std::to_string(table.lines[i]) + ": s does not ascend";
    samples.push_back({row[0], {row[1], row[2], row[3]}});
  }
  if (samples.front().s != 0 || samples.back().s != 1)
    return "s does not go from 0 to 1: it is a fraction of the rod's length";
  return "";
}

}  // namespace

std::vector<RestSample> read_rest_table(Reading& r, const Node& node) {
  std::vector<RestSample> samples;
  const auto table = read_table(r, node, nullptr);
  if (!table) return samples;
  const std::string problem = take(*table, samples);
  if (problem.empty()) return samples;
  complain_of_table(r, node, nullptr, problem);
  return {};
}

}  // namespace cprsim
