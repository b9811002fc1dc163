// SPDX-License-Identifier: BSD-3-Clause
// Rods that cross at a right angle and press on each other in their middles, against the half of
// each by itself, a plane elastica with one force at its end:
//   theta' = m / EI,  x' = e cos(theta),  z' = e sin(theta),  m' = e (n_x sin(theta) - n_z
//   cos(theta)), e = 1 + C (n_x cos(theta) + n_z sin(theta)),  n_z = F / 2 - w (L / 2 - s),  n_x
//   constant, x = z = theta = 0 at s = 0,  theta = 0 and x = half the span at s = L / 2,
// and one condition for both: the middles are two radii apart. Solved by classical Runge-Kutta
// steps, and Newton's method with differences; nothing of cprsim is used.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>

#include "engine/run/simulation.h"
#include "scenes/loader/load.h"

namespace cprsim {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Rope {
  double EI = 0, compliance = 0;  ///< N m², 1/N
  double w = 0;                   ///< weight, N/m
  double length = 0, span = 0;
};

Rope rubber_rope(double E) {
  const double radius = 0.005, area = kPi * radius * radius;
  return {E * area * radius * radius / 4, 1 / (E * area), 1000 * area * 9.81, 0.5, 0.5};
}

using State = Eigen::Vector4d;  ///< theta, x, z, m

State slope(const Rope& rope, const State& y, double s, double F, double n_x) {
  const double n_z = 0.5 * F - rope.w * (0.5 * rope.length - s);
  const double c = std::cos(y[0]), sine = std::sin(y[0]);
  const double e = 1 + rope.compliance * (n_x * c + n_z * sine);
  return {y[3] / rope.EI, e * c, e * sine, e * (n_x * sine - n_z * c)};
}

// Multiple shooting: a taut rope is a boundary layer of width sqrt(EI / n_x) at its clamp.
constexpr int kPieces = 4, kUnknowns = 2 + 4 * (kPieces - 1);

/// n_x, the clamp's moment and the states at the joins.
using Half = Eigen::Matrix<double, kUnknowns, 1>;

State swept(const Rope& rope, double F, double n_x, int piece, State y) {
  constexpr int kSteps = 125;
  const double h = 0.5 * rope.length / (kPieces * kSteps);
  for (int i = 0; i < kSteps; ++i) {
    const double s = (piece * kSteps + i) * h;
    const State a = slope(rope, y, s, F, n_x);
    const State b = slope(rope, y + 0.5 * h * a, s + 0.5 * h, F, n_x);
    const State c = slope(rope, y + 0.5 * h * b, s + 0.5 * h, F, n_x);
    const State d = slope(rope, y + h * c, s + h, F, n_x);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return y;
}

State start_of(const Half& u, int piece) {
  return piece == 0 ? State(0, 0, 0, u[1]) : State(u.segment<4>(2 + 4 * (piece - 1)));
}

State middle(const Rope& rope, double F, const Half& u) {
  return swept(rope, F, u[0], kPieces - 1, start_of(u, kPieces - 1));
}

/// What must vanish of half a rope: gaps at the joins, theta and x in its middle.
Half gap(const Rope& rope, double F, const Half& u) {
  Half r;
  for (int piece = 0; piece + 1 < kPieces; ++piece) {
    State g = swept(rope, F, u[0], piece, start_of(u, piece)) - start_of(u, piece + 1);
    g[3] *= rope.length / rope.EI;
    r.segment<4>(4 * piece) = g;
  }
  const State y = middle(rope, F, u);
  r.tail<2>() << y[0], (y[1] - 0.5 * rope.span) / rope.length;
  return r;
}

/// Straight, with a moment at the clamp.
Half straight(const Rope& rope, double moment) {
  Half u = Half::Zero();
  u[1] = moment;
  for (int piece = 1; piece < kPieces; ++piece)
    u[2 + 4 * (piece - 1) + 1] = 0.5 * rope.span * piece / kPieces;
  return u;
}

using Residual = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// Newton's method from a guess that is near.
void solve(const Residual& f, Eigen::VectorXd& x) {
  for (int i = 0; i < 30; ++i) {
    const Eigen::VectorXd r = f(x);
    if (r.norm() < 1e-13) break;
    Eigen::MatrixXd J(r.size(), x.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      Eigen::VectorXd more = x, less = x;
      const double by = 1e-5 * std::abs(x[k]) + 1e-9;
      more[k] += by;
      less[k] -= by;
      J.col(k) = (f(more) - f(less)) / (2 * by);
    }
    const Eigen::VectorXd step = J.fullPivLu().solve(r);
    double part = 1;
    while (part > 1e-4 && !(f(x - part * step).norm() < r.norm()))
      part *= 0.5;
    x -= part * step;
  }
  EXPECT_LT(f(x).norm(), 1e-11);
}

LoadResult contact_scene(const std::string& name) {
  return load_scene(std::string(CPRSIM_SOURCE_DIR) + "/scenes/contact/" + name + ".xml");
}

TEST(CrossingRods, PressLikeTwoHalvesOfClampedRods) {
  const double EA = 2e11 * kPi * 1e-6;
  Rope rope{EA * 1e-6 / 4, 1 / EA, 0, 0.4, 0.4};
  const LoadResult loaded = contact_scene("crossing");
  ASSERT_TRUE(loaded.scene);
  Simulation simulation(*loaded.scene);
  simulation.start();
  const double first = 1e-4, F_first = -0.5 * first * 192 * rope.EI / std::pow(rope.length, 3);
  Eigen::VectorXd x(kUnknowns + 1);  // the half rod, F
  x << straight(rope, F_first * rope.length / 8), F_first;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    const double approach = 1e-3 * simulation.time() - 0.5e-3;
    if (approach < 0.99 * first) continue;
    solve(
        [&](const Eigen::VectorXd& at) {
          Eigen::VectorXd r(kUnknowns + 1);
          const Half u = at.head<kUnknowns>();
          const double F = at[kUnknowns];
          r << gap(rope, F, u), (middle(rope, F, u)[2] + 0.5 * approach) / rope.length;
          return r;
        },
        x);
    EXPECT_NEAR(simulation.now().contact.force / -x[kUnknowns], 1, 1e-6) << "at " << approach;
  }
  EXPECT_LT(x[kUnknowns], -14);
}

TEST(CrossingRods, RopeRestsOnRope) {
  const Rope heavy_upper = rubber_rope(1e6), heavy_lower = rubber_rope(3e6);
  Rope upper = heavy_upper, lower = heavy_lower;
  Eigen::VectorXd x(2 * kUnknowns + 1);  // both halves, F on the upper one
  const double bend = heavy_upper.w * heavy_upper.length * heavy_upper.length / 12;
  constexpr double kFirst = 1e-3;
  x << straight(upper, -kFirst * bend), straight(lower, -kFirst * bend), 0;
  double apart = 0;  // held, from what it is without contact to two radii
  const auto height = [](const Rope& rope, double F, const Half& u) {
    return middle(rope, F, u)[2];
  };
  const auto distance = [&](const Eigen::VectorXd& at) {
    const double F = at[2 * kUnknowns];
    return 0.012 + height(upper, F, at.head<kUnknowns>()) -
           height(lower, -F, at.segment<kUnknowns>(kUnknowns));
  };
  const auto conditions = [&](const Eigen::VectorXd& at) {
    Eigen::VectorXd r(2 * kUnknowns + 1);
    const double F = at[2 * kUnknowns];
    r << gap(upper, F, at.head<kUnknowns>()), gap(lower, -F, at.segment<kUnknowns>(kUnknowns)),
        apart == 0 ? F : (distance(at) - apart) / upper.length;
    return r;
  };
  // the weight grows, then the distance to what it is
  for (double part = kFirst; part <= 1; part *= part < 1 ? std::min(1.15, 1 / part) : 2) {
    upper.w = part * heavy_upper.w;
    lower.w = part * heavy_lower.w;
    solve(conditions, x);
  }
  const double free_u = 0.012 + height(upper, 0, x.head<kUnknowns>()), free_apart = distance(x);
  for (int k = 1; k <= 5; ++k) {
    apart = free_apart + 0.2 * k * (0.01 - free_apart);
    solve(conditions, x);
  }
  const double F = x[2 * kUnknowns];
  const double lift = 0.012 + height(upper, F, x.head<kUnknowns>()) - free_u;
  const LoadResult loaded = contact_scene("ropes");
  ASSERT_TRUE(loaded.scene);
  Simulation simulation(*loaded.scene);
  simulation.start();
  EXPECT_NEAR(simulation.now().contact.force / F, 1, 1e-6);
  for (const RodPoint& point : simulation.now().rods[1].points)
    if (std::abs(point.s - 0.5) < 1e-9) {
      EXPECT_NEAR((point.position.z() - free_u) / lift, 1, 1e-4);
    }
}

}  // namespace
}  // namespace cprsim
