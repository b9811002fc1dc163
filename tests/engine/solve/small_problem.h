// SPDX-License-Identifier: BSD-3-Clause
// A Problem from a function and its Jacobian, to try solvers on. Fraction holds the start's
// residual open, relaxation drags with a unit stiffness.
#pragma once

#include <Eigen/LU>
#include <functional>
#include <vector>

#include "engine/math/types.h"
#include "engine/solve/problem.h"

namespace cprsim {

class SmallProblem final : public Problem {
 public:
  using Function = std::function<VecX(const VecX& x, double fraction)>;
  using Jacobian = std::function<MatX(const VecX& x)>;

  SmallProblem(VecX start, Function f, Jacobian J)
      : x(start), f_(std::move(f)), J_(std::move(J)), start_(std::move(start)) {}

  VecX x;
  double smallest_mu = 0;         ///< find_direction fails below it
  bool moved_blindly = false;     ///< move() without a direction
  std::vector<double> fractions;  ///< as set

  ProblemResidual evaluate() override {
    ++evaluations_;
    ProblemResidual residual;
    r_ = f_(x, fraction_);
    if (drag_ > 0) r_ += drag_ * (x - relaxed_from_);
    residual.finite = r_.allFinite();
    residual.merit = 0.5 * r_.squaredNorm();
    residual.largest = residual.finite ? r_.cwiseAbs().maxCoeff() : 1e300;
    return residual;
  }

  bool find_direction(double mu) override {
    ++factorizations_;
    d_.resize(0);
    r_linear_ = r_;
    x_linear_ = x;
    if (mu < smallest_mu) return false;
    MatX J = J_(x);
    J.diagonal().array() += drag_;
    if (mu == 0) {
      const Eigen::FullPivLU<MatX> lu(J);
      if (!lu.isInvertible()) return false;
      d_ = -lu.solve(r_);
    } else {
      MatX N = J.transpose() * J;
      N.diagonal().array() += mu;
      d_ = -N.lu().solve(J.transpose() * r_);
    }
    return d_.allFinite();
  }

  double predicted_merit() const override {
    return 0.5 * (J_(x_linear_) * d_ + r_linear_).squaredNorm();
  }

  void keep() override { kept_ = x; }

  void move(double alpha) override {
    if (d_.size() == 0) {
      moved_blindly = true;
      return;
    }
    x = kept_ + alpha * d_;
  }

  void mark() override { mark_ = x; }

  void return_to_mark() override { x = mark_; }

  void remember() override { remembered_ = x; }

  void recall() override { x = remembered_; }

  void set_fraction(double fraction) override {
    fraction_ = fraction;
    fractions.push_back(fraction);
  }

  void set_relaxation(double drag) override {
    drag_ = drag;
    relaxed_from_ = x;
  }

  void set_softness(double) override {}

  bool wants_soft_start() const override { return false; }

  void break_symmetry() override {}

  void restart() override { x = start_; }

  std::string worst_row() const override { return "the worst row"; }

  double growth() const override { return 1; }

  long section_evaluations() const override { return evaluations_; }

  long work() const override { return evaluations_; }

  long factorizations() const override { return factorizations_; }

 private:
  Function f_;
  Jacobian J_;
  VecX start_, kept_, mark_, remembered_, r_, d_, relaxed_from_, x_linear_, r_linear_;
  double fraction_ = 1, drag_ = 0;
  long evaluations_ = 0, factorizations_ = 0;
};

inline VecX vector1(double x) {
  return VecX::Constant(1, x);
}

/// f(x) = 0 in one unknown.
inline SmallProblem scalar_problem(double start, const std::function<double(double)>& f,
                                   const std::function<double(double)>& slope) {
  return {vector1(start), [f](const VecX& x, double) { return vector1(f(x[0])); },
          [slope](const VecX& x) -> MatX { return vector1(slope(x[0])); }};
}

/// Rosenbrock's valley as a root: 10 (y - x²) = 0, 1 - x = 0.
inline SmallProblem rosenbrock() {
  const auto f = [](const VecX& x, double) -> VecX {
    return Vec2(10 * (x[1] - x[0] * x[0]), 1 - x[0]);
  };
  const auto J = [](const VecX& x) -> MatX {
    MatX m(2, 2);
    m << -20 * x[0], 10, -1, 0;
    return m;
  };
  return {Vec2(-1.2, 1), f, J};
}

}  // namespace cprsim
