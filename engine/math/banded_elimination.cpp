// SPDX-License-Identifier: BSD-3-Clause
#include "engine/math/banded_elimination.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace cprsim {

void BandedElimination::reset(int rows, int columns, int lower, int upper, int dense) {
  rows_ = rows;
  columns_ = columns;
  lower_ = lower;
  upper_ = upper;
  dense_ = dense;
  width_ = 2 * lower + upper + 1;
  count_ = 0;
  A_.assign(position(rows * width_), 0.0);
  B_.assign(position(rows * dense), 0.0);
}

void BandedElimination::scale_rows() {
  for (int r = 0; r < rows_; ++r) {
    double* row = &A_[position(r * width_)];
    double largest = 0;
    for (int i = 0; i <= lower_ + upper_; ++i)
      largest = std::max(largest, std::abs(row[i]));
    if (!(largest > 0)) continue;
    const double factor = 1 / largest;
    for (int i = 0; i <= lower_ + upper_; ++i)
      row[i] *= factor;
    for (int i = 0; i < dense_; ++i)
      dense(r, i) *= factor;
  }
}

bool BandedElimination::eliminate(int count) {
  count_ = count;
  int reached = 0;  // last column that a pivot row has entries in so far
  for (int c = 0; c < count; ++c) {
    const int last_row = std::min(rows_ - 1, c + lower_);
    int pivot = c;
    for (int r = c + 1; r <= last_row; ++r)
      if (std::abs(at(r, c)) > std::abs(at(pivot, c))) pivot = r;
    reached = std::max(reached, std::min(columns_ - 1, pivot + upper_));
    const int entries = reached - c + 1;
    double* top = &at(c, c);
    if (pivot != c) {
      std::swap_ranges(top, top + entries, &at(pivot, c));
      std::swap_ranges(&dense(c, 0), &dense(c, 0) + dense_, &dense(pivot, 0));
    }
    if (top[0] == 0 || !std::isfinite(top[0])) return false;
    for (int r = c + 1; r <= last_row; ++r) {
      double* row = &at(r, c);
      if (row[0] == 0) continue;
      const double factor = row[0] / top[0];
      row[0] = 0;
      for (int i = 1; i < entries; ++i)
        row[i] -= factor * top[i];
      for (int i = 0; i < dense_; ++i)
        dense(r, i) -= factor * dense(c, i);
    }
  }
  return true;
}

MatX BandedElimination::remaining() const {
  MatX out = MatX::Zero(rows_ - count_, columns_ - count_);
  for (int r = count_; r < rows_; ++r)
    for (int c = std::max(count_, r - lower_); c <= std::min(columns_ - 1, r + lower_ + upper_);
         ++c)
      out(r - count_, c - count_) = A_[place(r, c)];
  return out;
}

MatX BandedElimination::remaining_dense() const {
  MatX out(rows_ - count_, dense_);
  for (int r = count_; r < rows_; ++r)
    for (int c = 0; c < dense_; ++c)
      out(r - count_, c) = B_[position(r * dense_ + c)];
  return out;
}

MatX BandedElimination::substitute(const MatX& last, const MatX& w) const {
  assert(last.rows() == columns_ - count_ && w.rows() == dense_);
  const Eigen::Index cases = last.cols();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> x(columns_, cases);
  x.bottomRows(last.rows()) = last;
  for (int c = count_ - 1; c >= 0; --c) {
    double* out = x.row(c).data();
    std::fill_n(out, cases, 0.0);
    for (int i = 0; i < dense_; ++i)
      for (Eigen::Index k = 0; k < cases; ++k)
        out[k] -= B_[position(c * dense_ + i)] * w(i, k);
    const double* row = &A_[place(c, c)];
    const int entries = std::min(columns_ - 1, c + lower_ + upper_) - c + 1;
    for (int j = 1; j < entries; ++j) {
      if (row[j] == 0) continue;
      const double* known = x.row(c + j).data();
      for (Eigen::Index k = 0; k < cases; ++k)
        out[k] -= row[j] * known[k];
    }
    for (Eigen::Index k = 0; k < cases; ++k)
      out[k] /= row[0];
  }
  return x;
}

}  // namespace cprsim
