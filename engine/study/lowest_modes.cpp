// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/lowest_modes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

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

/// Columns that lean on no mode in particular, the same every time.
MatX scattered(Eigen::Index rows, Eigen::Index columns) {
  MatX X(rows, columns);
  std::uint64_t state = 0x9e3779b97f4a7c15u;
  for (Eigen::Index j = 0; j < columns; ++j)
    for (Eigen::Index i = 0; i < rows; ++i) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      X(i, j) = static_cast<double>(state >> 11) * 0x1p-52 - 1;
    }
  return X;
}

/// Largest mu of M x = mu A x, ascending, A-orthonormal; false if `count` of them did not settle.
bool iterate_subspace(const MatX& M, const CholeskyFactor& A, Eigen::Index count,
                      SymmetricModes& upper) {
  constexpr int kMostPasses = 100;
  constexpr double kSettled = 1e-13;  // of mu, whose error is the square of the vectors'
  const Eigen::Index p = std::max(2 * count, count + 8);
  MatX X = scattered(M.rows(), p);
  VecX before = VecX::Zero(count);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const MatX MX = M * X;
    const MatX Y = A.solve(MX);
    // Rayleigh-Ritz on the columns of Y = A^-1 M X
    MatX a = Y.transpose() * MX, m = Y.transpose() * (M * Y);
    a = 0.5 * (a + a.transpose()).eval();
    m = 0.5 * (m + m.transpose()).eval();
    const VecX unit = a.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    a = (unit.asDiagonal() * a * unit.asDiagonal()).eval();
    m = (unit.asDiagonal() * m * unit.asDiagonal()).eval();
    if (!is_positive_definite(a)) return false;  // fewer motions have inertia than columns
    const SymmetricModes ritz = symmetric_modes(m, a);
    X = Y * unit.asDiagonal() * ritz.vectors;
    const VecX mu = ritz.values.tail(count);
    if (((mu - before).array().abs() <= kSettled * mu.array().abs()).all()) {
      upper = {mu, X.rightCols(count)};
      return true;
    }
    before = mu;
  }
  return false;
}

}  // namespace

SymmetricModes lowest_modes(const MatX& K, const MatX& M, int count) {
  constexpr Eigen::Index kSmall = 80;  // rows; below, the full decomposition is as fast
  SymmetricModes lowest;
  const Eigen::Index n = K.rows();
  if (n == 0 || count <= 0 || !(M.diagonal().maxCoeff() > 0)) return lowest;
  MatX stiffness = K;
  stiffness.diagonal() += kTrace * K.diagonal().cwiseAbs();
  const double shift = find_shift(stiffness, M);
  stiffness += shift * M;
  SymmetricModes upper;
  const bool few = n > kSmall && 4 * std::max(2 * count, count + 8) < n;
  if (!few || !iterate_subspace(M, CholeskyFactor(stiffness), count, upper))
    upper = symmetric_modes(M, stiffness);
  const Eigen::Index found = upper.values.size();
  Eigen::Index kept = 0;
  while (kept < std::min<Eigen::Index>(found, count) &&
         upper.values[found - 1 - kept] > kNoInertia * upper.values[found - 1])
    ++kept;
  lowest.values.resize(kept);
  lowest.vectors.resize(n, kept);
  for (Eigen::Index i = 0; i < kept; ++i) {
    const double mu = upper.values[found - 1 - i];
    lowest.values[i] = 1 / mu - shift;
    lowest.vectors.col(i) = upper.vectors.col(found - 1 - i) / std::sqrt(mu);
  }
  return lowest;
}

}  // namespace cprsim
