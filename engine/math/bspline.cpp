// SPDX-License-Identifier: BSD-3-Clause
#include "engine/math/bspline.h"

#include <algorithm>
#include <cassert>

#include "engine/math/linear_solve.h"

namespace cprsim {
namespace {

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

BsplineSpace::BsplineSpace(int degree, const std::vector<double>& breaks) : degree_(degree) {
  assert(degree >= 0 && degree <= kMaxDegree && breaks.size() >= 2);
  knots_.assign(index(degree), breaks.front());
  knots_.insert(knots_.end(), breaks.begin(), breaks.end());
  knots_.insert(knots_.end(), index(degree), breaks.back());
}

// The last i with t_i <= x < t_i+1, or of the last piece.
int BsplineSpace::span(double x) const {
  const auto first = knots_.begin() + degree_, last = knots_.end() - degree_ - 1;
  if (x >= *last)
    return static_cast<int>(std::lower_bound(first, last, *last) - knots_.begin()) - 1;
  return static_cast<int>(std::upper_bound(first, last, std::max(x, *first)) - knots_.begin()) - 1;
}

BasisValues BsplineSpace::basis(double x) const {
  BasisValues out;
  const int at = span(x);
  out.first = at - degree_;
  // the functions of the degree reached so far stand at the end: value[p - k .. p]
  double* N = out.value + degree_;
  N[0] = 1;
  for (int k = 1; k <= degree_; ++k) {
    double below[kMaxDegree + 1];
    std::copy_n(N, k, below);
    --N;
    for (int j = 0; j <= k; ++j) {
      const int i = at - k + j;  // B_i,k of (1), from below[j - 1] = B_i,k-1 and below[j]
      double value = 0, slope = 0;
      if (j > 0) {
        const double width = knots_[index(i + k)] - knots_[index(i)];
        value += (x - knots_[index(i)]) / width * below[j - 1];
        slope += k / width * below[j - 1];
      }
      if (j < k) {
        const double width = knots_[index(i + k + 1)] - knots_[index(i + 1)];
        value += (knots_[index(i + k + 1)] - x) / width * below[j];
        slope -= k / width * below[j];  // (2)
      }
      N[j] = value;
      if (k == degree_) out.slope[j] = slope;
    }
  }
  if (weights_.size() > 0) make_rational(out);
  return out;
}

void BsplineSpace::weigh(const VecX& weights) {
  assert(weights.size() == size() && weights.minCoeff() > 0);
  weights_ = weights;
}

void BsplineSpace::make_rational(BasisValues& basis) const {
  double W = 0, W_slope = 0;
  for (int j = 0; j <= degree_; ++j) {
    const double w = weights_[basis.first + j];
    W += basis.value[j] *= w;
    W_slope += basis.slope[j] *= w;
  }
  for (int j = 0; j <= degree_; ++j) {
    basis.value[j] /= W;
    basis.slope[j] = (basis.slope[j] - basis.value[j] * W_slope) / W;
  }
}

std::vector<double> BsplineSpace::greville() const {
  std::vector<double> points;
  for (int i = 0; i < size(); ++i) {
    if (degree_ == 0) {
      points.push_back(0.5 * (knots_[index(i)] + knots_[index(i + 1)]));
      continue;
    }
    double sum = 0;
    for (int k = 1; k <= degree_; ++k)
      sum += knots_[index(i + k)];
    points.push_back(sum / degree_);
  }
  // sums round: the ends are exact
  if (degree_ > 0) {
    points.front() = knots_.front();
    points.back() = knots_.back();
  }
  return points;
}

BsplineSpace BsplineSpace::derivatives() const {
  assert(degree_ > 0);
  BsplineSpace out;
  out.degree_ = degree_ - 1;
  out.knots_.assign(knots_.begin() + 1, knots_.end() - 1);
  return out;
}

MatX BsplineSpace::interpolate(const MatX& values) const {
  const std::vector<double> points = greville();
  MatX A = MatX::Zero(size(), size());
  for (int i = 0; i < size(); ++i) {
    const BasisValues b = basis(points[index(i)]);
    for (int j = 0; j <= degree_; ++j)
      A(i, b.first + j) = b.value[j];
  }
  return solve_columns(A, values);
}

// sum_i w_i B_j(x_i) = integral of B_j = (t_j+p+1 - t_j) / (p + 1)
VecX BsplineSpace::greville_weights() const {
  const std::vector<double> points = greville();
  MatX A = MatX::Zero(size(), size());
  VecX integral(size());
  for (int i = 0; i < size(); ++i) {
    const BasisValues b = basis(points[index(i)]);
    for (int j = 0; j <= degree_; ++j)
      A(b.first + j, i) = b.value[j];
    integral[i] = (knots_[index(i + degree_ + 1)] - knots_[index(i)]) / (degree_ + 1);
  }
  return solve_columns(A, integral);
}

}  // namespace cprsim
