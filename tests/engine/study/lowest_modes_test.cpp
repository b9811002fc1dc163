// SPDX-License-Identifier: BSD-3-Clause
// Lowest eigenvalues of a chain of masses and springs, known in closed form.
#include "engine/study/lowest_modes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cprsim {
namespace {

constexpr Eigen::Index kMasses = 300;

// 1e-12 of each mass's own stiffness is added, which is 2e-8 of the softest motion's
constexpr double kStiffening = 2e-8;

/// Unit springs between unit masses, both ends held: lambda_k = 2 - 2 cos(k pi / (n + 1)).
MatX chain() {
  MatX K = MatX::Zero(kMasses, kMasses);
  for (Eigen::Index i = 0; i < kMasses; ++i) {
    K(i, i) = 2;
    if (i > 0) K(i, i - 1) = K(i - 1, i) = -1;
  }
  return K;
}

double of_chain(Eigen::Index k) {
  return 2 - 2 * std::cos(static_cast<double>(k + 1) * std::numbers::pi / (kMasses + 1));
}

void expect_modes(const MatX& K, const MatX& M, const SymmetricModes& modes, int count) {
  ASSERT_EQ(modes.values.size(), count);
  const MatX residual = K * modes.vectors - M * modes.vectors * modes.values.asDiagonal();
  EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-7 * modes.values.cwiseAbs().maxCoeff());
  EXPECT_LT((modes.vectors.transpose() * M * modes.vectors - MatX::Identity(count, count))
                .cwiseAbs()
                .maxCoeff(),
            1e-9);
}

TEST(LowestModes, OfAChain) {
  const MatX K = chain(), M = MatX::Identity(kMasses, kMasses);
  const SymmetricModes modes = lowest_modes(K, M, 7);
  expect_modes(K, M, modes, 7);
  for (Eigen::Index k = 0; k < 7; ++k)
    EXPECT_NEAR(modes.values[k] / of_chain(k), 1, kStiffening) << k;
}

TEST(LowestModes, CountNegativeOnes) {
  const MatX M = MatX::Identity(kMasses, kMasses),
             K = chain() - 0.5 * (of_chain(2) + of_chain(3)) * M;
  const SymmetricModes modes = lowest_modes(K, M, 6);
  expect_modes(K, M, modes, 6);
  EXPECT_LT(modes.values[2], 0);
  EXPECT_GT(modes.values[3], 0);
}

TEST(LowestModes, LeaveOutWhatHasNoInertia) {
  const MatX K = chain();
  MatX M = MatX::Zero(kMasses, kMasses);
  M(0, 0) = M(150, 150) = 1;
  EXPECT_EQ(lowest_modes(K, M, 6).values.size(), 2);
}

TEST(LowestModes, TwinsAreBothFound) {
  MatX K = MatX::Zero(2 * kMasses, 2 * kMasses);
  K.topLeftCorner(kMasses, kMasses) = K.bottomRightCorner(kMasses, kMasses) = chain();
  const SymmetricModes modes = lowest_modes(K, MatX::Identity(2 * kMasses, 2 * kMasses), 4);
  ASSERT_EQ(modes.values.size(), 4);
  for (Eigen::Index k = 0; k < 4; ++k)
    EXPECT_NEAR(modes.values[k] / of_chain(k / 2), 1, kStiffening) << k;
}

}  // namespace
}  // namespace cprsim
