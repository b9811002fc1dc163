// SPDX-License-Identifier: BSD-3-Clause
#include "engine/math/linear_solve.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace cprsim {

bool solve_square(const MatX& A, const VecX& b, double smallest_pivot, VecX& x) {
  const Eigen::PartialPivLU<MatX> lu(A);
  const VecX pivots = lu.matrixLU().diagonal().cwiseAbs();
  if (!(pivots.minCoeff() > smallest_pivot * pivots.maxCoeff())) return false;
  x = lu.solve(b);
  return true;
}

VecX least_norm_solution(const MatX& A, const VecX& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<MatX> qr;
  qr.setThreshold(threshold);
  qr.compute(A);
  return qr.solve(b);
}

MatX least_norm_solutions(const MatX& A, const MatX& B, double threshold) {
  if (A.rows() == 0) return MatX::Zero(A.cols(), B.cols());
  Eigen::CompleteOrthogonalDecomposition<MatX> qr;
  qr.setThreshold(threshold);
  qr.compute(A);
  return qr.solve(B);
}

VecX solve_symmetric(const MatX& N, const VecX& b) {
  return N.ldlt().solve(b);
}

MatX solve_columns(const MatX& A, const MatX& B) {
  return A.partialPivLu().solve(B);
}

bool general_solution(const MatX& A, const MatX& B, MatX& X) {
  const Eigen::Index r = A.rows(), c = A.cols(), all = c + B.cols();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> M(r, all);
  M.leftCols(c) = A;
  M.rightCols(B.cols()) = B;
  std::vector<Eigen::Index> entry(static_cast<std::size_t>(c));  // of x, as columns are swapped
  std::iota(entry.begin(), entry.end(), Eigen::Index{0});
  for (Eigen::Index k = 0; k < r; ++k) {
    Eigen::Index best = k;
    for (Eigen::Index j = k + 1; j < c; ++j)
      if (std::abs(M(k, j)) > std::abs(M(k, best))) best = j;
    if (!(std::abs(M(k, best)) > 1e-300)) return false;
    if (best != k) {
      M.col(k).swap(M.col(best));
      std::swap(entry[static_cast<std::size_t>(k)], entry[static_cast<std::size_t>(best)]);
    }
    M.row(k).tail(all - k) /= double(M(k, k));
    for (Eigen::Index i = k + 1; i < r; ++i)
      if (M(i, k) != 0) M.row(i).tail(all - k) -= double(M(i, k)) * M.row(k).tail(all - k);
  }
  for (Eigen::Index k = r; k-- > 1;)
    for (Eigen::Index i = 0; i < k; ++i)
      M.row(i).tail(all - r) -= double(M(i, k)) * M.row(k).tail(all - r);
  X.setZero(c, all - r);
  for (Eigen::Index k = 0; k < c; ++k) {
    const Eigen::Index x = entry[static_cast<std::size_t>(k)];
    if (k < r)
      X.row(x) = -M.row(k).tail(all - r);
    else
      X(x, k - r) = 1;
  }
  return true;
}

bool is_positive_definite(const MatX& A) {
  return CholeskyFactor(A).positive_definite();
}

CholeskyFactor::CholeskyFactor(const MatX& A) : L_(A) {
  const Eigen::LLT<Eigen::Ref<MatX>> factor(L_);  // in place
  positive_definite_ = factor.info() == Eigen::Success;
}

MatX CholeskyFactor::solve(const MatX& B) const {
  MatX X = B;
  L_.triangularView<Eigen::Lower>().solveInPlace(X);
  L_.triangularView<Eigen::Lower>().transpose().solveInPlace(X);
  return X;
}

double conditioning(const MatX& A) {
  if (A.size() == 0) return 0;
  // by the smaller Gram matrix: ratios below 1e-8 are noise, and 0 to whoever asks
  const MatX gram = A.rows() < A.cols() ? MatX(A * A.transpose()) : MatX(A.transpose() * A);
  const VecX values =
      Eigen::SelfAdjointEigenSolver<MatX>(gram, Eigen::EigenvaluesOnly).eigenvalues();
  const double largest = values.maxCoeff();
  return largest > 0 ? std::sqrt(std::max(0.0, values.minCoeff()) / largest) : 0;
}

SymmetricModes symmetric_modes(const MatX& K, const MatX& M) {
  const Eigen::LLT<MatX> llt(M);
  const auto L = llt.matrixL();
  MatX A = L.solve(K);
  A = L.solve(A.transpose()).eval();
  const Eigen::SelfAdjointEigenSolver<MatX> solver(0.5 * (A + A.transpose()));
  return {solver.eigenvalues(), llt.matrixU().solve(solver.eigenvectors())};
}

MatX kernel_of(const MatX& C, double threshold) {
  const Eigen::Index n = C.cols();
  if (C.rows() == 0) return MatX::Identity(n, n);
  Eigen::ColPivHouseholderQR<MatX> qr(C.transpose());
  qr.setThreshold(threshold);
  const Eigen::Index free = n - qr.rank();
  if (free == 0) return MatX(n, 0);  // Eigen would step from a null pointer
  MatX Z = MatX::Zero(n, free);
  Z.bottomRows(free).setIdentity();
  return qr.householderQ() * Z;
}

MatX onto_kernel(const MatX& C, double threshold, const MatX& A) {
  if (C.rows() == 0) return A;
  Eigen::ColPivHouseholderQR<MatX> qr(C.transpose());
  qr.setThreshold(threshold);
  if (A.cols() == 0) return MatX(C.cols() - qr.rank(), 0);
  MatX turned = A;
  turned.applyOnTheLeft(qr.householderQ().adjoint());
  return turned.bottomRows(C.cols() - qr.rank());
}

MatX between_kernel(const MatX& C, double threshold, const MatX& A) {
  const MatX rows = onto_kernel(C, threshold, A);
  return onto_kernel(C, threshold, rows.transpose()).transpose();
}

// Reflections H_k = I - 2 v v^T make A upper triangular; Q = H_0 ... H_5.
TallQr::TallQr(const Mat12x6& A) {
  Mat12x6 work = A;
  Eigen::Matrix<double, 12, 6> v = Mat12x6::Zero();
  for (Eigen::Index k = 0; k < 6; ++k) {
    double tail = 0;
    for (Eigen::Index i = k; i < 12; ++i)
      tail += work(i, k) * work(i, k);
    const double length = std::sqrt(tail);
    for (Eigen::Index i = k; i < 12; ++i)
      v(i, k) = work(i, k);
    v(k, k) += std::copysign(length, work(k, k));
    const double norm = v.col(k).norm();
    if (norm > 0) v.col(k) /= norm;
    for (Eigen::Index c = k; c < 6; ++c)
      work.col(c) -= 2 * v.col(k).dot(work.col(c)) * v.col(k);
  }
  R = Mat6::Zero();
  for (Eigen::Index c = 0; c < 6; ++c)
    for (Eigen::Index r = 0; r <= c; ++r)
      R(r, c) = work(r, c);
  Q1.setIdentity();
  Q2.setZero();
  Q2.bottomRows<6>().setIdentity();
  for (Eigen::Index k = 5; k >= 0; --k)
    for (Eigen::Index c = 0; c < 6; ++c) {
      Q1.col(c) -= 2 * v.col(k).dot(Q1.col(c)) * v.col(k);
      Q2.col(c) -= 2 * v.col(k).dot(Q2.col(c)) * v.col(k);
    }
}

}  // namespace cprsim
