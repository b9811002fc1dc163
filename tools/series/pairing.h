// SPDX-License-Identifier: BSD-3-Clause
// Which quantity of a trajectory is which of another, and in which units both are.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "tools/series/comparison.h"

namespace cprsim {

/// Two trajectories that cannot be compared as they are; says why, for people.
class PairingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Of `all` the quantity that `reference` is: of the same name, or the only one that ends like it;
/// nullptr if there is none. @throws PairingError if several end like it
const SeriesQuantity* counterpart(const std::vector<SeriesQuantity>& all,
                                  const SeriesQuantity& reference);

/// Columns of the pair that name no unit are taken to be in the one of `silent_units` that fits,
/// else in SI. @throws PairingError if they name another kind of unit than the run
void convert_units(Series& reference, const QuantityPair& pair, const Series& run,
                   const std::vector<std::string>& silent_units);

}  // namespace cprsim
