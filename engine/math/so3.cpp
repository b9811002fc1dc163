// SPDX-License-Identifier: BSD-3-Clause
#include "engine/math/so3.h"

#include <cmath>

namespace cprsim {
namespace {

/// A, B of (2) and their derivatives by |theta|, divided by |theta|.
struct Coefficients {
  double A, B, A_slope, B_slope;
};

Coefficients jacobian_coefficients(double x) {  // x = |theta|²
  if (x < 0.25) {
    // Taylor; the first neglected term is below 1e-17 at x = 0.25
    const double A =
        1. / 2 -
        x * (1. / 24 - x * (1. / 720 - x * (1. / 40320 - x * (1. / 3628800 - x / 479001600.))));
    const double B =
        1. / 6 - x * (1. / 120 -
                      x * (1. / 5040 - x * (1. / 362880 - x * (1. / 39916800 - x / 6227020800.))));
    const double As =
        -1. / 12 + x * (1. / 180 - x * (1. / 6720 - x * (1. / 453600 - x / 47900160.)));
    const double Bs =
        -1. / 60 + x * (1. / 1260 - x * (1. / 60480 - x * (1. / 4989600 - x / 622702080.)));
    return {A, B, As, Bs};
  }
  const double t = std::sqrt(x), s = std::sin(t), c = std::cos(t);
  return {(1 - c) / x, (t - s) / (x * t), (t * s - 2 * (1 - c)) / (x * x),
          (3 * s - 2 * t - t * c) / (x * x * t)};
}

}  // namespace

Mat3 hat(const Vec3& a) {
  Mat3 A;
  A << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return A;
}

Mat3 exp_so3(const Vec3& theta) {
  const double x = theta.squaredNorm();
  const Coefficients k = jacobian_coefficients(x);
  const Mat3 T = hat(theta);
  // sin t / t = 1 - x B
  return Mat3::Identity() + (1 - x * k.B) * T + k.A * (T * T);
}

Vec3 log_so3(const Mat3& R) {
  Quat q(R);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double n = q.vec().norm();
  if (n < 1e-8) return 2 * q.vec();
  return (2 * std::atan2(n, q.w()) / n) * q.vec();
}

Mat3 right_jacobian(const Vec3& theta) {
  const Coefficients k = jacobian_coefficients(theta.squaredNorm());
  const Mat3 T = hat(theta);
  return Mat3::Identity() - k.A * T + k.B * (T * T);
}

Mat3 right_jacobian_inverse(const Vec3& theta) {
  const double x = theta.squaredNorm();
  const Mat3 T = hat(theta);
  double c;  // (1 - (t/2) cot(t/2)) / t²
  if (x < 0.25) {
    c = 1. / 12 +
        x * (1. / 720 + x * (1. / 30240 +
                             x * (1. / 1209600 + x * (1. / 47900160 + x * 691. / 1307674368000.))));
  } else {
    const double t = std::sqrt(x);
    c = (1 - 0.5 * t / std::tan(0.5 * t)) / x;
  }
  return Mat3::Identity() + 0.5 * T + c * (T * T);
}

Mat3 right_jacobian_derivative(const Vec3& theta, const Vec3& w) {
  const Coefficients k = jacobian_coefficients(theta.squaredNorm());
  const Vec3 tw = theta.cross(w);
  const Vec3 ttw = theta.cross(tw);
  return k.A * hat(w) - k.A_slope * tw * theta.transpose() - k.B * (hat(tw) + hat(theta) * hat(w)) +
         k.B_slope * ttw * theta.transpose();
}

// R = I + hat(c) + hat(c)² / (1 + a . b), c = a × b; where the directions are nearly opposite, half
// a turn about their common normal takes a to -a, and the rest is short.
Mat3 rotation_between(const Vec3& from, const Vec3& to) {
  const Vec3 a = from.normalized(), b = to.normalized();
  const double cosine = a.dot(b);
  if (cosine > -0.9) {
    const Mat3 C = hat(a.cross(b));
    return Mat3::Identity() + C + C * C / (1 + cosine);
  }
  Vec3 across = a.cross(a.cross(b));  // across a, in the plane of both
  if (across.norm() < 1e-12) {
    across.setZero();
    Eigen::Index weakest = 0;
    a.cwiseAbs().minCoeff(&weakest);
    across[weakest] = 1;
    across -= across.dot(a) * a;
  }
  const Vec3 axis = a.cross(across).normalized();
  const Mat3 half = 2 * axis * axis.transpose() - Mat3::Identity();
  return rotation_between(-a, b) * half;
}

Mat3 orthonormalized(const Mat3& R) {
  return Quat(R).normalized().toRotationMatrix();
}

}  // namespace cprsim
