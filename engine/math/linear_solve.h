// SPDX-License-Identifier: BSD-3-Clause
// Dense linear systems. Eigen's decompositions, instantiated once: they are most of what a file
// that uses them takes to compile.
#pragma once

#include "engine/math/types.h"

namespace cprsim {

/// Solution of A x = b by LU with partial pivoting, or nothing where the smallest pivot is below
/// `smallest_pivot` times the largest.
bool solve_square(const MatX& A, const VecX& b, double smallest_pivot, VecX& x);

/// Of all x with the least |A x - b|, the shortest; columns count as dependent below `threshold`
/// (relative to the largest pivot of a QR decomposition with column pivoting).
VecX least_norm_solution(const MatX& A, const VecX& b, double threshold);

/// The same for every column of B.
MatX least_norm_solutions(const MatX& A, const MatX& B, double threshold);

/// Solution of N x = b for symmetric N, positive definite or nearly so (LDL^T with pivoting).
VecX solve_symmetric(const MatX& N, const VecX& b);

/// Solution of A X = B by LU with partial pivoting; A must be regular.
MatX solve_columns(const MatX& A, const MatX& B);

/// All x with A x + B y = 0 for A with fewer rows than columns, row by row with the largest entry
/// of each as its pivot: x = X [z; y], where z are the entries of x that no pivot was taken for.
/// The scale of rows does not matter, that of columns does.
/// @return false if no pivot is left: a row vanishes, or is no number.
bool general_solution(const MatX& A, const MatX& B, MatX& X);

bool is_positive_definite(const MatX& A);

/// A = L L^T, factored once to be solved with often.
class CholeskyFactor {
 public:
  /// @param A symmetric
  explicit CholeskyFactor(const MatX& A);

  bool positive_definite() const { return positive_definite_; }

  /// A^-1 B, for positive definite A.
  MatX solve(const MatX& B) const;

 private:
  MatX L_;
  bool positive_definite_ = false;
};

/// Smallest over largest singular value; 0 for an empty matrix.
double conditioning(const MatX& A);

/// Eigenvalues (ascending) and vectors of K x = lambda M x for symmetric K and positive definite M;
/// vectors are M-orthonormal columns.
struct SymmetricModes {
  VecX values;
  MatX vectors;
};

SymmetricModes symmetric_modes(const MatX& K, const MatX& M);

/// Orthonormal columns that span what the rows of C leave free; rows count as dependent below
/// `threshold`.
MatX kernel_of(const MatX& C, double threshold);

/// Z^T A and Z^T A Z with Z = kernel_of(C, threshold), which is not formed: few rows of C make this
/// much cheaper than products of full matrices.
MatX onto_kernel(const MatX& C, double threshold, const MatX& A);
MatX between_kernel(const MatX& C, double threshold, const MatX& A);

/// A (12 × 6) = Q1 R with orthonormal columns Q1 and upper triangular R; the columns of Q2 complete
/// those of Q1 to a basis. By Householder reflections.
struct TallQr {
  using Mat12x6 = Eigen::Matrix<double, 12, 6>;
  explicit TallQr(const Mat12x6& A);
  Mat12x6 Q1, Q2;
  Mat6 R;
};

}  // namespace cprsim
