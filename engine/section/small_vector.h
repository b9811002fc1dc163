// SPDX-License-Identifier: BSD-3-Clause
// Three-vectors and 3×3 matrices for the inner kernels only. The kernels are compiled several times
// for different vector widths, so everything here lives in the including file's anonymous
// namespace: no symbol compiled for a wide machine can end up serving a narrow one. Outside the
// kernels use Eigen.
#pragma once

#include <cmath>

// What is inlined is not left to the compiler, whose choice depends on what else a file holds: an
// effect compiled in would slow down those who do not ask for it (tests/effects).
namespace {  // NOLINT: on purpose, see above

struct V3 {
  double x, y, z;
};

struct M3 {
  double a[9];  // row-major
};

[[gnu::always_inline]] inline V3 load(const double* p) {
  return {p[0], p[1], p[2]};
}

[[gnu::always_inline]] inline void store(double* p, V3 v) {
  p[0] = v.x;
  p[1] = v.y;
  p[2] = v.z;
}

[[gnu::always_inline]] inline V3 operator+(V3 a, V3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

[[gnu::always_inline]] inline V3 operator-(V3 a, V3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

[[gnu::always_inline]] inline V3 operator*(double s, V3 a) {
  return {s * a.x, s * a.y, s * a.z};
}

[[gnu::always_inline]] inline double dot(V3 a, V3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

[[gnu::always_inline]] inline V3 cross(V3 a, V3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

[[gnu::always_inline]] inline V3 scaled(const double* d, V3 a) {
  return {d[0] * a.x, d[1] * a.y, d[2] * a.z};
}

[[gnu::always_inline]] inline M3 load_matrix(const double* p) {
  M3 A;
  for (int i = 0; i < 9; ++i)
    A.a[i] = p[i];
  return A;
}

[[gnu::always_inline]] inline void store_matrix(double* p, const M3& A) {
  for (int i = 0; i < 9; ++i)
    p[i] = A.a[i];
}

[[gnu::always_inline]] inline V3 operator*(const M3& A, V3 v) {
  return {A.a[0] * v.x + A.a[1] * v.y + A.a[2] * v.z, A.a[3] * v.x + A.a[4] * v.y + A.a[5] * v.z,
          A.a[6] * v.x + A.a[7] * v.y + A.a[8] * v.z};
}

[[gnu::always_inline]] inline V3 transposed_times(const M3& A, V3 v) {
  return {A.a[0] * v.x + A.a[3] * v.y + A.a[6] * v.z, A.a[1] * v.x + A.a[4] * v.y + A.a[7] * v.z,
          A.a[2] * v.x + A.a[5] * v.y + A.a[8] * v.z};
}

[[gnu::always_inline]] inline M3 operator*(const M3& A, const M3& B) {
  M3 C;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      C.a[3 * i + j] =
          A.a[3 * i] * B.a[j] + A.a[3 * i + 1] * B.a[3 + j] + A.a[3 * i + 2] * B.a[6 + j];
  return C;
}

[[gnu::always_inline]] inline M3 operator+(const M3& A, const M3& B) {
  M3 C;
  for (int i = 0; i < 9; ++i)
    C.a[i] = A.a[i] + B.a[i];
  return C;
}

[[gnu::always_inline]] inline M3 operator*(double s, const M3& A) {
  M3 C;
  for (int i = 0; i < 9; ++i)
    C.a[i] = s * A.a[i];
  return C;
}

[[gnu::always_inline]] inline M3 transpose(const M3& A) {
  return {{A.a[0], A.a[3], A.a[6], A.a[1], A.a[4], A.a[7], A.a[2], A.a[5], A.a[8]}};
}

[[gnu::always_inline]] inline M3 hat(V3 v) {
  return {{0, -v.z, v.y, v.z, 0, -v.x, -v.y, v.x, 0}};
}

[[gnu::always_inline]] inline M3 outer(V3 a, V3 b) {
  return {{a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.x, a.y * b.y, a.y * b.z, a.z * b.x, a.z * b.y,
           a.z * b.z}};
}

[[gnu::always_inline]] inline M3 identity() {
  return {{1, 0, 0, 0, 1, 0, 0, 0, 1}};
}

/// Coefficients of exp and of the right Jacobian of SO(3), see engine/math/so3.h (2).
struct RotationCoefficients {
  double A, B, A_slope, B_slope;
};

[[gnu::noinline]] inline RotationCoefficients rotation_coefficients(double x) {  // x = |theta|²
  if (x < 0.25) {
    return {
        1. / 2 -
            x * (1. / 24 - x * (1. / 720 - x * (1. / 40320 - x * (1. / 3628800 - x / 479001600.)))),
        1. / 6 - x * (1. / 120 -
                      x * (1. / 5040 - x * (1. / 362880 - x * (1. / 39916800 - x / 6227020800.)))),
        -1. / 12 + x * (1. / 180 - x * (1. / 6720 - x * (1. / 453600 - x / 47900160.))),
        -1. / 60 + x * (1. / 1260 - x * (1. / 60480 - x * (1. / 4989600 - x / 622702080.)))};
  }
  const double t = sqrt(x), s = sin(t), c = cos(t);
  return {(1 - c) / x, (t - s) / (x * t), (t * s - 2 * (1 - c)) / (x * x),
          (3 * s - 2 * t - t * c) / (x * x * t)};
}

[[gnu::always_inline]] inline M3 rotation_exp(V3 theta, const RotationCoefficients& k) {
  const M3 T = hat(theta);
  return identity() + (1 - dot(theta, theta) * k.B) * T + k.A * (T * T);
}

[[gnu::always_inline]] inline M3 right_jacobian(V3 theta, const RotationCoefficients& k) {
  const M3 T = hat(theta);
  return identity() + (-k.A) * T + k.B * (T * T);
}

/// d(J_r(theta) w)/dtheta.
[[gnu::always_inline]] inline M3 right_jacobian_derivative(V3 theta, V3 w,
                                                           const RotationCoefficients& k) {
  const V3 tw = cross(theta, w);
  return k.A * hat(w) + (-k.A_slope) * outer(tw, theta) + (-k.B) * (hat(tw) + hat(theta) * hat(w)) +
         k.B_slope * outer(cross(theta, tw), theta);
}

}  // namespace
