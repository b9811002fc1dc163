// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/lowest_modes.h"

#include <cmath>

namespace cprsim {
namespace {

constexpr double kNoInertia = 1e-14;

// A motion with neither stiffness nor inertia, like the spin of a rod between two balls, would
// leave the right side singular; this much stiffness, relative to each coordinate's own, sends it
// to infinity.
constexpr double kTrace = 1e-12;

double find_shift(const MatX& K, const MatX& M) {
  if (is_positive_definite(K)) return 0;
  double shift = 1e-9 * K.diagonal().cwiseAbs().maxCoeff() / M.diagonal().maxCoeff();
  while (!is_positive_definite(K + shift * M) && shift < 1e300)
    shift *= 10;
  return shift;
}

}  // namespace

SymmetricModes lowest_modes(const MatX& K, const MatX& M) {
  SymmetricModes lowest;
  if (K.rows() == 0 || !(M.diagonal().maxCoeff() > 0)) return lowest;
  MatX stiffness = K;
  stiffness.diagonal() += kTrace * K.diagonal().cwiseAbs();
  const double shift = find_shift(stiffness, M);
  const SymmetricModes all = symmetric_modes(M, stiffness + shift * M);
  const Eigen::Index n = all.values.size();
  Eigen::Index count = 0;
  while (count < n && all.values[n - 1 - count] > kNoInertia * all.values[n - 1])
    ++count;
  lowest.values.resize(count);
  lowest.vectors.resize(n, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double mu = all.values[n - 1 - i];
    lowest.values[i] = 1 / mu - shift;
    lowest.vectors.col(i) = all.vectors.col(n - 1 - i) / std::sqrt(mu);
  }
  return lowest;
}

}  // namespace cprsim
