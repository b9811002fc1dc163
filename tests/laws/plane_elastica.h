// SPDX-License-Identifier: BSD-3-Clause
// A heavy rod in a plane, clamped at its base, free at its tip, that slides without friction on
// pegs. It shares nothing with cprsim. With the heading theta measured from x towards z, the force
// n that the part beyond s exerts, and m the moment about the normal of the plane, x to z:
//   x' = cos(theta),  z' = sin(theta),  theta' = m / EI,  m' = n_x sin(theta) - n_z cos(theta)  (1)
//   n(s) = sum over the pegs beyond s of F_i u_i,  n_z - w (L - s) besides                      (2)
// A peg is an ellipse (a point, if its axes are 0). At its place s_i the rod's axis is one radius r
// off the surface point of the direction phi_i, whose outward normal is u_i:
//   (x, z)(s_i) = c + (a cos(phi), b sin(phi)) + r u,  u ~ (cos(phi) / a, sin(phi) / b),
//   u . (cos(theta), sin(theta)) = 0                                                           (3)
// Unknowns: the moment at the base and F_i, phi_i, s_i; conditions: (3) and m(L) = 0.
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <vector>

namespace cprsim {

struct Peg {
  double x = 0, z = 0, a = 0, b = 0;  ///< centre, semi-axes, m
};

struct HeldRod {
  double EI = 1, w = 0, length = 1, radius = 0;  ///< N m², N/m, m, m
  double x = 0, z = 0, heading = 0;              ///< of the base
  std::vector<Peg> pegs;                         ///< from base to tip
};

/// Solution, and what it is on: moment at the base, then F, phi, s of each peg.
using HeldState = Eigen::VectorXd;

namespace held {

using State = Eigen::Vector4d;  // x, z, theta, m

inline Eigen::Vector2d normal(const Peg& peg, double phi) {
  if (peg.a == 0) return {std::cos(phi), std::sin(phi)};
  return Eigen::Vector2d(std::cos(phi) / peg.a, std::sin(phi) / peg.b).normalized();
}

inline State slope(const HeldRod& rod, const State& y, double s, const Eigen::Vector2d& beyond) {
  const double n_z = beyond.y() - rod.w * (rod.length - s), c = std::cos(y[2]), d = std::sin(y[2]);
  return {c, d, y[3] / rod.EI, beyond.x() * d - n_z * c};
}

inline State swept(const HeldRod& rod, State y, double from, double to,
                   const Eigen::Vector2d& beyond) {
  constexpr int kSteps = 200;
  const double h = (to - from) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double s = from + i * h;
    const State a = slope(rod, y, s, beyond), b = slope(rod, y + 0.5 * h * a, s + 0.5 * h, beyond),
                c = slope(rod, y + 0.5 * h * b, s + 0.5 * h, beyond),
                d = slope(rod, y + h * c, s + h, beyond);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

/// (3) and m(L).
inline Eigen::VectorXd residual(const HeldRod& rod, const HeldState& u, State* tip = nullptr) {
  const auto pegs = static_cast<Eigen::Index>(rod.pegs.size());
  Eigen::VectorXd r(3 * pegs + 1);
  State y(rod.x, rod.z, rod.heading, u[0]);
  double s = 0;
  Eigen::Vector2d beyond = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i < pegs; ++i)
    beyond += u[3 * i + 1] * normal(rod.pegs[static_cast<std::size_t>(i)], u[3 * i + 2]);
  for (Eigen::Index i = 0; i < pegs; ++i) {
    const Peg& peg = rod.pegs[static_cast<std::size_t>(i)];
    const double F = u[3 * i + 1], phi = u[3 * i + 2];
    const Eigen::Vector2d normal_here = normal(peg, phi);
    y = swept(rod, y, s, u[3 * i + 3], beyond);
    s = u[3 * i + 3];
    beyond -= F * normal_here;
    const Eigen::Vector2d on(peg.x + peg.a * std::cos(phi), peg.z + peg.b * std::sin(phi));
    r.segment<2>(3 * i) = (y.head<2>() - on - rod.radius * normal_here) / rod.length;
    r[3 * i + 2] = normal_here.dot(Eigen::Vector2d(std::cos(y[2]), std::sin(y[2])));
  }
  y = swept(rod, y, s, rod.length, beyond);
  if (tip) *tip = y;
  r[3 * pegs] = y[3] * rod.length / rod.EI;
  return r;
}

}  // namespace held

/// Newton's method with differences from a guess that is near. @return the residual's size
inline double solve_held(const HeldRod& rod, HeldState& u) {
  double size = held::residual(rod, u).norm();
  for (int i = 0; i < 50 && size > 1e-13; ++i) {
    Eigen::MatrixXd J(u.size(), u.size());
    for (Eigen::Index k = 0; k < u.size(); ++k) {
      HeldState more = u, less = u;
      const double by = 1e-6 * std::max(std::abs(u[k]), 1e-2);
      more[k] += by;
      less[k] -= by;
      J.col(k) = (held::residual(rod, more) - held::residual(rod, less)) / (2 * by);
    }
    const Eigen::VectorXd step = J.fullPivLu().solve(held::residual(rod, u));
    double part = 1;
    while (part > 1e-3 && !(held::residual(rod, u - part * step).norm() < size))
      part *= 0.5;
    u -= part * step;
    const double now = held::residual(rod, u).norm();
    if (!(now < size)) break;
    size = now;
  }
  return size;
}

/// Position, heading and moment at the tip.
inline Eigen::Vector4d tip_of(const HeldRod& rod, const HeldState& u) {
  held::State tip;
  held::residual(rod, u, &tip);
  return tip;
}

}  // namespace cprsim
