// SPDX-License-Identifier: BSD-3-Clause
#include "engine/math/linear_solve.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace cprsim {
namespace {

/// Numbers without a pattern, the same on every machine.
MatX numbers(Eigen::Index rows, Eigen::Index columns) {
  MatX A(rows, columns);
  for (Eigen::Index i = 0; i < A.size(); ++i)
    A.data()[i] = std::sin(1.7 * static_cast<double>(i * i + 1));
  return A;
}

TEST(LinearSolve, SquareSystemIsMet) {
  const MatX A = numbers(9, 9);
  const VecX b = numbers(9, 1);
  VecX x;
  ASSERT_TRUE(solve_square(A, b, 1e-12, x));
  EXPECT_LT((A * x - b).norm(), 1e-12);
}

TEST(LinearSolve, SingularSquareSystemIsRefused) {
  MatX A = numbers(5, 5);
  A.row(3) = A.row(1) + A.row(2);
  VecX x;
  EXPECT_FALSE(solve_square(A, numbers(5, 1), 1e-12, x));
  A(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solve_square(A, numbers(5, 1), 1e-12, x));
}

TEST(LinearSolve, LeastNormSolutionIsOrthogonalToTheKernel) {
  const MatX A = numbers(6, 4) * numbers(4, 6);
  const VecX b = A * numbers(6, 1);
  const VecX x = least_norm_solution(A, b, 1e-10);
  EXPECT_LT((A * x - b).norm(), 1e-10);
  Eigen::FullPivLU<MatX> lu(A);
  lu.setThreshold(1e-10);
  const MatX kernel = lu.kernel();
  ASSERT_EQ(kernel.cols(), 2);
  EXPECT_LT((kernel.transpose() * x).norm(), 1e-10);
}

TEST(LinearSolve, GeneralSolutionIsAllThereIs) {
  const MatX A = numbers(5, 9), B = numbers(5, 3);
  MatX X;
  ASSERT_TRUE(general_solution(A, B, X));
  ASSERT_EQ(X.rows(), 9);
  ASSERT_EQ(X.cols(), 4 + 3);
  EXPECT_LT((A * X.leftCols(4)).norm(), 1e-13);
  EXPECT_LT((A * X.rightCols(3) + B).norm(), 1e-13);
  EXPECT_GT(conditioning(X.leftCols(4)), 1e-2);  // four directions, not fewer
  MatX incomplete = A;
  incomplete.row(4).setZero();
  EXPECT_FALSE(general_solution(incomplete, MatX::Zero(5, 0), X));
  incomplete(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(general_solution(incomplete, MatX::Zero(5, 0), X));
}

TEST(LinearSolve, SymmetricSystemIsMet) {
  const MatX B = numbers(7, 7);
  const MatX N = B.transpose() * B + MatX::Identity(7, 7);
  const VecX b = numbers(7, 1);
  EXPECT_LT((N * solve_symmetric(N, b) - b).norm(), 1e-12);
}

TEST(LinearSolve, TallQrFactorsAndCompletes) {
  const TallQr::Mat12x6 A = numbers(12, 6);
  const TallQr qr(A);
  EXPECT_LT((qr.Q1 * qr.R - A).norm(), 2e-15 * A.norm());
  Mat12 Q;
  Q << qr.Q1, qr.Q2;
  EXPECT_LT((Q.transpose() * Q - Mat12::Identity()).norm(), 5e-15);
  EXPECT_EQ(Mat6(qr.R.triangularView<Eigen::StrictlyLower>()).norm(), 0);
}

TEST(LinearSolve, TallQrOfDependentColumnsStaysOrthonormal) {
  TallQr::Mat12x6 A = numbers(12, 6);
  A.col(4).setZero();
  const TallQr qr(A);
  EXPECT_LT((qr.Q1 * qr.R - A).norm(), 2e-15 * A.norm());
  EXPECT_LT((qr.Q1.transpose() * qr.Q1 - Mat6::Identity()).norm(), 5e-15);
}

}  // namespace
}  // namespace cprsim
