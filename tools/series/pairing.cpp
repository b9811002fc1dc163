// SPDX-License-Identifier: BSD-3-Clause
#include "tools/series/pairing.h"

#include <fmt/core.h>

#include "tools/series/measured_table.h"

namespace cprsim {

const SeriesQuantity* counterpart(const std::vector<SeriesQuantity>& all,
                                  const SeriesQuantity& reference) {
  const SeriesQuantity* found = nullptr;
  for (const SeriesQuantity& q : all) {
    if (q.name == reference.name && q.kind == reference.kind) return &q;
    if (!q.name.ends_with("." + reference.name) || q.kind != reference.kind) continue;
    if (found != nullptr) {
      throw PairingError(fmt::format("'{}' of the reference fits {} and {}: say which by --map",
                                     reference.name, found->name, q.name));
    }
    found = &q;
  }
  return found;
}

void convert_units(Series& reference, const QuantityPair& pair, const Series& run,
                   const std::vector<std::string>& silent_units) {
  for (std::size_t i = 0; i < pair.quantity.width(); ++i) {
    SeriesColumn& column = reference.columns[pair.reference.columns[i]];
    const std::string& wanted = run.columns[pair.quantity.columns[i]].unit;
    if (column.unit.empty() && !wanted.empty()) {
      for (const std::string& unit : silent_units) {
        if (si_unit(unit)->name != wanted) continue;
        for (double& value : column.values)
          value *= si_unit(unit)->factor;
      }
      column.unit = wanted;
    }
    if (!wanted.empty() && column.unit != wanted) {
      throw PairingError(fmt::format("{}: '{}' is in {}, the run's {} in {}", reference.path,
                                     column.name, column.unit, pair.quantity.name, wanted));
    }
  }
}

}  // namespace cprsim
