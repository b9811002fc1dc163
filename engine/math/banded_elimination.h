// SPDX-License-Identifier: BSD-3-Clause
// Gaussian elimination with row interchanges of a banded system with more unknowns than rows,
//   A x + B w = 0,   A: rows × columns in a band, B: few dense columns.
// The first unknowns are eliminated one after another; what is left are the last rows on the last
// unknowns. Cost: rows × (lower + 1) × (2 lower + upper + 1 + columns of B).
// Source: Golub & Van Loan, "Matrix computations", 4th ed., section 4.3.3.
#pragma once

#include <vector>

#include "engine/math/types.h"

namespace cprsim {

class BandedElimination {
 public:
  /// All entries become zero. @param lower, upper how far below and above the diagonal A reaches.
  void reset(int rows, int columns, int lower, int upper, int dense);

  /// An entry of A; must lie in the band.
  double& at(int row, int column) { return A_[place(row, column)]; }

  /// An entry of B.
  double& dense(int row, int column) { return B_[position(row * dense_ + column)]; }

  /// Divides every row by its largest entry of A, so that pivots compare like with like.
  void scale_rows();

  /// Eliminates the first `count` unknowns. @return false where a pivot vanishes or is not a
  /// number.
  bool eliminate(int count);

  /// What is left after elimination: rows from `count` on, in the unknowns from `count` on.
  MatX remaining() const;
  MatX remaining_dense() const;

  /// All unknowns as columns. @param last the unknowns that were not eliminated, one column for
  /// each case. @param w the same cases' w.
  MatX substitute(const MatX& last, const MatX& w) const;

 private:
  static std::size_t position(int i) { return static_cast<std::size_t>(i); }

  // row r holds the columns r - lower .. r + upper + lower: interchanges widen it
  std::size_t place(int row, int column) const {
    return position(row * width_ + column - row + lower_);
  }

  int rows_ = 0, columns_ = 0, lower_ = 0, upper_ = 0, dense_ = 0, width_ = 0, count_ = 0;
  std::vector<double> A_, B_;
};

}  // namespace cprsim
