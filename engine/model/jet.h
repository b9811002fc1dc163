// SPDX-License-Identifier: BSD-3-Clause
// Second-order Taylor arithmetic (Griewank & Walther, Evaluating Derivatives, 2nd ed. 2008, chapter
// 13): what is computed with these numbers comes with its derivatives.
#pragma once

#include <cmath>

namespace cprsim {

/// A value with its first and second derivative with respect to time.
struct Jet {
  double value = 0, rate = 0, acceleration = 0;
};

inline Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.rate + b.rate, a.acceleration + b.acceleration};
}

inline Jet operator-(const Jet& a, const Jet& b) {
  return {a.value - b.value, a.rate - b.rate, a.acceleration - b.acceleration};
}

inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.rate * b.value + a.value * b.rate,
          a.acceleration * b.value + 2 * a.rate * b.rate + a.value * b.acceleration};
}

/// f(a), from f and its derivatives at a.
inline Jet chain(const Jet& a, double f, double f1, double f2) {
  return {f, f1 * a.rate, f2 * a.rate * a.rate + f1 * a.acceleration};
}

inline bool is_constant(const Jet& a) {
  return a.rate == 0 && a.acceleration == 0;
}

inline Jet power(const Jet& a, const Jet& b) {
  const double f = std::pow(a.value, b.value);
  if (is_constant(a) && is_constant(b)) return {f, 0, 0};
  if (is_constant(b)) {
    const double n = b.value;
    // 0 · pow(0, -1) is 0 here: a² has derivatives at 0
    const double f1 = n == 0 ? 0 : n * std::pow(a.value, n - 1);
    const double f2 = n == 0 || n == 1 ? 0 : n * (n - 1) * std::pow(a.value, n - 2);
    return chain(a, f, f1, f2);
  }
  const double x = a.value;
  const Jet exponent = b * chain(a, std::log(x), 1 / x, -1 / (x * x));
  return chain(exponent, f, f, f);
}

}  // namespace cprsim
