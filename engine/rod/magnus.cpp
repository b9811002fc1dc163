// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/magnus.h"

#include <cmath>

#include "engine/math/so3.h"

namespace cprsim {
namespace {

const double kA2 = std::sqrt(15.0) / 3, kA3 = 10.0 / 3;

Vec3 bracket(const Vec3& a, const Vec3& b) {
  return b.cross(a);
}

}  // namespace

Vec3 magnus_step(double h, const Mat3& u) {
  const Vec3 a1 = h * u.col(1), a2 = kA2 * h * (u.col(2) - u.col(0)),
             a3 = kA3 * h * (u.col(2) - 2 * u.col(1) + u.col(0));
  const Vec3 C1 = bracket(a1, a2), C2 = bracket(a1, 2 * a3 + C1) / -60;
  return a1 + a3 / 12 + bracket(-20 * a1 - a3 + C1, a2 + C2) / 240;
}

// d[a, b] = b^ da - a^ db
Eigen::Matrix<double, 3, 9> magnus_tangent(double h, const Mat3& u) {
  const Vec3 a1 = h * u.col(1), a2 = kA2 * h * (u.col(2) - u.col(0)),
             a3 = kA3 * h * (u.col(2) - 2 * u.col(1) + u.col(0));
  const Vec3 C1 = bracket(a1, a2), C2 = bracket(a1, 2 * a3 + C1) / -60;
  const Vec3 left = -20 * a1 - a3 + C1, right = a2 + C2;
  const Mat3 I = Mat3::Identity(), A1 = hat(a1), L = hat(left), Q = hat(right);
  // by a1, a2, a3
  const Mat3 C1_1 = hat(a2), C1_2 = -A1;
  const Mat3 C2_1 = (hat(2 * a3 + C1) - A1 * C1_1) / -60, C2_2 = A1 * C1_2 / 60, C2_3 = A1 / 30;
  const Mat3 by_1 = I + (Q * (C1_1 - 20 * I) - L * C2_1) / 240,
             by_2 = (Q * C1_2 - L * (I + C2_2)) / 240, by_3 = I / 12 - (Q + L * C2_3) / 240;
  Eigen::Matrix<double, 3, 9> by_u;
  by_u << h * (kA3 * by_3 - kA2 * by_2), h * (by_1 - 2 * kA3 * by_3), h * (kA3 * by_3 + kA2 * by_2);
  return by_u;
}

}  // namespace cprsim
