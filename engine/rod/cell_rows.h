// SPDX-License-Identifier: BSD-3-Clause
// Rows of sensitivities of a cell, whole columns at a time, and the elimination of its lifted
// unknowns. Local to the including file, as engine/section/small_vector.h, which comes first.
#pragma once

#include <cmath>

#include "engine/section/small_vector.h"

namespace {  // NOLINT: as small_vector.h

// Rows of sensitivities: three rows of W columns.
template <int W>
struct alignas(64) Rows {
  double r[3][W];
};

template <int W>
inline void set_zero(Rows<W>& A) {
  for (auto& row : A.r)
    for (int c = 0; c < W; ++c)
      row[c] = 0;
}

template <int W>
inline void add_scaled(Rows<W>& A, double s, const Rows<W>& B) {
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < W; ++c)
      A.r[i][c] += s * B.r[i][c];
}

// A += s M B
template <int W>
inline void add_product(Rows<W>& A, double s, const M3& M, const Rows<W>& B) {
  for (int i = 0; i < 3; ++i) {
    const double x = s * M.a[3 * i], y = s * M.a[3 * i + 1], z = s * M.a[3 * i + 2];
    for (int c = 0; c < W; ++c)
      A.r[i][c] += x * B.r[0][c] + y * B.r[1][c] + z * B.r[2][c];
  }
}

// A += a × B
template <int W>
inline void add_cross(Rows<W>& A, V3 a, const Rows<W>& B) {
  for (int c = 0; c < W; ++c) {
    A.r[0][c] += a.y * B.r[2][c] - a.z * B.r[1][c];
    A.r[1][c] += a.z * B.r[0][c] - a.x * B.r[2][c];
    A.r[2][c] += a.x * B.r[1][c] - a.y * B.r[0][c];
  }
}

// adds a 3×3 block into columns first .. first + 2
template <int W>
inline void add_block(Rows<W>& A, int first, double s, const M3& M) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      A.r[i][first + j] += s * M.a[3 * i + j];
}

// diag(C) R^T: from a world wrench to section strains
inline M3 compliance_of_axes(const M3& R, const double* C) {
  M3 CRt = transpose(R);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      CRt.a[3 * i + j] *= C[i];
  return CRt;
}

// one + diag(C) K
inline M3 softened(const double* C, const M3& K, double one) {
  M3 A = one * identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      A.a[3 * i + j] += C[i] * K.a[3 * i + j];
  return A;
}

// Gauss-Jordan with row pivoting on an LC × W array whose first LC columns are the matrix. Fixed
// loops over whole rows, so that they vectorise.
template <int LC, int W>
[[gnu::noinline]] bool eliminate(double (*A)[W]) {
  for (int k = 0; k < LC; ++k) {
    int pivot = k;
    for (int i = k + 1; i < LC; ++i)
      if (fabs(A[i][k]) > fabs(A[pivot][k])) pivot = i;
    if (!(fabs(A[pivot][k]) > 1e-300)) return false;
    if (pivot != k)
      for (int c = 0; c < W; ++c) {
        const double t = A[k][c];
        A[k][c] = A[pivot][c];
        A[pivot][c] = t;
      }
    const double s = 1 / A[k][k];
    for (int c = 0; c < W; ++c)
      A[k][c] *= s;
    for (int i = 0; i < LC; ++i) {
      if (i == k) continue;
      const double f = A[i][k];
      for (int c = 0; c < W; ++c)
        A[i][c] -= f * A[k][c];
    }
  }
  return true;
}

}  // namespace
