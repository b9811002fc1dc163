// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/strains_at_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cprsim {
namespace {

/// Whether stages are all of one order and apart, as those of Gauss's tables are.
bool of_one_kind(const ArcTableau& table) {
  bool apart = table.c[0] > 0;
  for (int i = 1; i < table.stages; ++i)
    apart = apart && table.c[i] > table.c[i - 1];
  return apart;
}

}  // namespace

// Lagrange's polynomials. Of explicit tables the first stage and the last count.
Vec6 StrainsAtNodes::fitted(std::size_t first, std::size_t last, std::size_t node) const {
  const auto S = static_cast<std::size_t>(table_.stages);
  const std::size_t stride = of_one_kind(table_) ? 1 : std::max<std::size_t>(1, S - 1);
  std::array<double, 2 * kMaxStages> x{};
  std::array<std::size_t, 2 * kMaxStages> stage{};
  std::size_t n = 0;
  for (std::size_t cell = first; cell <= last; ++cell)
    for (std::size_t i = 0; i < S; i += stride) {
      const double at = grid_[cell] + (grid_[cell + 1] - grid_[cell]) * table_.c[i] - grid_[node];
      if (n > 0 && at <= x[n - 1]) continue;
      x[n] = at;
      stage[n++] = cell * S + i;
    }
  Vec6 sum = Vec6::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < n; ++j)
      if (j != i) weight *= x[j] / (x[j] - x[i]);
    sum += weight * at_stage_(stage[i]);
  }
  return sum;
}

Vec6 StrainsAtNodes::between(std::size_t node) const {
  const Vec6 left = fitted(node - 1, node - 1, node), right = fitted(node, node, node),
             mean = 0.5 * (left + right), both = fitted(node - 1, node, node);
  Vec6 out = mean;
  for (int i = 0; i < 6; ++i)
    if (std::abs(both[i] - mean[i]) <= std::abs(left[i] - right[i])) out[i] = both[i];
  return out;
}

// One cell further in, both kinds can be compared.
Vec6 StrainsAtNodes::at_end(std::size_t node) const {
  constexpr double kAsMuch = 10;
  const std::size_t cells = grid_.size() - 1, own = node == 0 ? 0 : cells - 1;
  const Vec6 alone = fitted(own, own, node);
  if (cells < 2) return alone;
  const std::size_t inner = node == 0 ? 1 : cells - 1, first = std::min(own, inner - 1);
  const Vec6 apart = fitted(inner - 1, inner - 1, inner) - fitted(inner, inner, inner),
             both = fitted(first, first + 1, node);
  Vec6 out = alone;
  for (int i = 0; i < 6; ++i)
    if (std::abs(both[i] - alone[i]) <= kAsMuch * std::abs(apart[i])) out[i] = both[i];
  return out;
}

Vec6 StrainsAtNodes::operator()(std::size_t node) const {
  return node == 0 || node + 1 == grid_.size() ? at_end(node) : between(node);
}

}  // namespace cprsim
