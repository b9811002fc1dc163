// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/rest_table.h"

#include "scenes/loader/table.h"

namespace cprsim {
namespace {

/// Why the table is none of rest curvatures, or nothing.
std::string take(const Table& table, std::vector<RestSample>& samples) {
  if (table.rows.front().size() != 4) return "its lines are not four numbers s,kx,ky,kz";
  if (table.rows.size() < 2) return "fewer than two lines s,kx,ky,kz";
  const std::string problem = check_fractions(table, 0);
  if (problem.empty())
    for (const std::vector<double>& row : table.rows)
      samples.push_back({row[0], {row[1], row[2], row[3]}});
  return problem;
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
