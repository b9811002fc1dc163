// SPDX-License-Identifier: BSD-3-Clause
// How far a trajectory is from a reference, at the reference's instants.
//   e_k = |x(t_k) - r(t_k)|, for attitudes the angle of the turn between them             (1)
// Nothing is extrapolated: instants that either side does not cover are left out and counted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/series/series.h"

namespace cprsim {

/// Of the errors (1); in the quantity's unit, attitudes in rad.
struct ErrorNumbers {
  double rms = 0, mean = 0, median = 0, percentile_95 = 0;
  double max = 0, max_time = 0;
  double last = 0;   ///< at the last instant compared
  double bias = 0;   ///< size of the mean of x - r; of attitudes: of the mean rotation vector
  double range = 0;  ///< largest distance of the reference from where it began
};

/// One quantity, compared.
struct QuantityComparison {
  SeriesQuantity quantity, reference;
  std::vector<double> time, error;             ///< instants that both sides cover, and (1) there
  std::vector<QuantityValue> value, expected;  ///< x and r
  std::size_t outside = 0;                     ///< instants of the reference left out
  ErrorNumbers numbers;
};

/// @param lag added to the reference's instants before the trajectory is looked at, s
QuantityComparison compare_quantity(const Series& series, const SeriesQuantity& quantity,
                                    const Series& reference, const SeriesQuantity& expected,
                                    double lag = 0);

/// The same from values that are known at each instant.
ErrorNumbers error_numbers(QuantityKind kind, const std::vector<double>& time,
                           const std::vector<QuantityValue>& value,
                           const std::vector<QuantityValue>& expected);

/// A pair of quantities that are the same thing.
struct QuantityPair {
  SeriesQuantity quantity, reference;
};

/// How late the trajectory is: the shift tau that makes the sum over all pairs of
///   mean |x(t + tau) - r(t)|² / mean |r - mean r|²                                      (2)
/// least, sought over a tenth of the reference's duration to both sides.
struct Lag {
  double seconds = 0;
  double before = 0, after = 0;  ///< root of (2) without and with the shift, per pair
};

/// Nothing if the reference does not move, or has less than five instants.
std::optional<Lag> estimate_lag(const Series& series, const Series& reference,
                                const std::vector<QuantityPair>& pairs);

}  // namespace cprsim
