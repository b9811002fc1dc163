// SPDX-License-Identifier: BSD-3-Clause
#include "engine/fit/confidence.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace cprsim {

namespace {

using Svd = Eigen::JacobiSVD<MatX>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A parameter belongs to a flat direction if it has more than this share in it; rounding gives
// others shares of about the derivatives' error.
constexpr double kShare = 1e-3;

VecX lengths(const MatX& J) {
  return J.colwise().norm().transpose();
}

VecX reciprocal(const VecX& d, double floor) {
  return d.unaryExpr([floor](double x) { return x > floor ? 1 / x : 0.0; });
}

/// Continued fraction of the incomplete beta function (DLMF 8.17.22) by Lentz's method.
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  double c = 1, d = 1 - (a + b) * x / (a + 1);
  d = 1 / (std::abs(d) < kTiny ? kTiny : d);
  double h = d;
  for (int m = 1; m < 1000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double change = 1;
    for (const double term : {even, odd}) {
      d = 1 + term * d;
      d = 1 / (std::abs(d) < kTiny ? kTiny : d);
      c = 1 + term / c;
      if (std::abs(c) < kTiny) c = kTiny;
      change = d * c;
      h *= change;
    }
    if (std::abs(change - 1) < 1e-15) break;
  }
  return h;
}

/// Regularised incomplete beta function I_x(a, b).
double beta_probability(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(a, b, x) / a;
  return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

/// Probability of |T| > t.
double beyond(double t, int freedom) {
  if (freedom <= 0) return std::erfc(t / std::sqrt(2.0));
  const double nu = freedom;
  return beta_probability(0.5 * nu, 0.5, nu / (nu + t * t));
}

}  // namespace

double student_t(double level, int freedom) {
  double low = 0, high = 1;
  while (beyond(high, freedom) > 1 - level && high < 1e300)
    high *= 2;
  for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (beyond(middle, freedom) > 1 - level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

GaussNewtonStep gauss_newton_step(const MatX& J, const VecX& r, double rank_tolerance) {
  GaussNewtonStep result;
  const VecX scale = reciprocal(lengths(J), 0);
  const Svd svd(J * scale.asDiagonal(), Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VecX inverse = reciprocal(svd.singularValues(), rank_tolerance);
  result.step =
      -(scale.asDiagonal() * (svd.matrixV() * inverse.cwiseProduct(svd.matrixU().transpose() * r)));
  const double freedom = static_cast<double>(J.rows() - J.cols());
  const double sigma = freedom > 0 ? r.norm() / std::sqrt(freedom) : 0;
  const MatX half = scale.asDiagonal() * svd.matrixV() * inverse.asDiagonal();
  result.standard_error = sigma * half.rowwise().norm();
  return result;
}

Confidence confidence(const MatX& J_all, const VecX& r, const ConfidenceOptions& options) {
  const Eigen::Index n = J_all.cols();
  const auto fixed = [&](Eigen::Index j) { return options.fixed[static_cast<std::size_t>(j)]; };
  MatX J = J_all;
  Eigen::Index counted = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    if (fixed(j)) J.col(j).setZero();
    counted += fixed(j) ? 0 : 1;
  }
  Confidence result;
  result.observable.assign(static_cast<std::size_t>(n), Observability::kObservable);
  result.freedom = static_cast<int>(r.size() - counted);
  result.reduced_chi_square = result.freedom > 0 ? r.squaredNorm() / result.freedom : kNan;
  result.sigma = options.sigma_known ? 1 : std::sqrt(result.reduced_chi_square);

  // columns that are nothing but the error of the differences have no direction to speak of
  const VecX D = lengths(J);
  VecX scale = VecX::Zero(n);
  double worst = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    const double error = options.derivative_error[j];
    if (fixed(j)) continue;
    if (D[j] > 3 * error) {
      scale[j] = 1 / D[j];
      worst = std::max(worst, error / D[j]);
      continue;
    }
    result.observable[static_cast<std::size_t>(j)] = Observability::kNoInfluence;
    result.combinations.push_back(VecX::Unit(n, j));
  }
  result.rank_tolerance = std::clamp(10 * worst, 1e-9, 1e-2);

  const Svd svd(J * scale.asDiagonal(), Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VecX& S = svd.singularValues();
  const Eigen::Index columns = (scale.array() > 0).count();
  const double smallest = columns > 0 ? S[columns - 1] : 0;
  result.condition = smallest > 0 ? S[0] / smallest : std::numeric_limits<double>::infinity();
  VecX inverse = VecX::Zero(S.size());
  for (Eigen::Index k = 0; k < columns; ++k) {
    if (S[k] > result.rank_tolerance * S[0]) {
      inverse[k] = 1 / S[k];
      continue;
    }
    const VecX share = svd.matrixV().col(k);
    for (Eigen::Index j = 0; j < n; ++j)
      if (std::abs(share[j]) > kShare)
        result.observable[static_cast<std::size_t>(j)] = Observability::kDependent;
    result.combinations.push_back((scale.asDiagonal() * share).normalized());
  }

  // (1) in what can be observed
  const MatX half = scale.asDiagonal() * svd.matrixV() * inverse.asDiagonal();
  const MatX C = half * half.transpose();
  const double t = student_t(options.level, options.sigma_known ? 0 : std::max(result.freedom, 1));
  result.standard_error.resize(n);
  result.half_width.resize(n);
  result.correlation = MatX::Constant(n, n, kNan);
  for (Eigen::Index j = 0; j < n; ++j) {
    auto& state = result.observable[static_cast<std::size_t>(j)];
    const bool known = !fixed(j) && state == Observability::kObservable;
    result.standard_error[j] = known ? result.sigma * std::sqrt(C(j, j)) : kNan;
    result.half_width[j] = t * result.standard_error[j];
    if (known && result.half_width[j] > options.widest[j]) state = Observability::kTooUncertain;
    for (Eigen::Index k = 0; k <= j; ++k) {
      if (std::isnan(result.standard_error[j]) || std::isnan(result.standard_error[k])) continue;
      result.correlation(j, k) = result.correlation(k, j) =
          j == k ? 1 : C(j, k) / std::sqrt(C(j, j) * C(k, k));
    }
  }
  return result;
}

}  // namespace cprsim
