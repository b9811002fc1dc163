// SPDX-License-Identifier: BSD-3-Clause
// The stepper on one coordinate: x_tt = f - w² x, whose solve is a linear equation.
#include "engine/time/scheme.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <functional>

#include "tests/engine/time/schemes.h"

namespace cprsim {
namespace {

class Oscillator {
 public:
  Oscillator(SchemeKind kind, double w, double x0, double v0) : stepper({kind, -0.4, 0.8}), w_(w) {
    track.resize(1);
    track.set_start(VecX::Constant(1, x0), VecX::Constant(1, v0));
  }

  void step(double h, const std::function<double(double)>& force = nullptr) {
    const std::vector<Track*> tracks{&track};
    const int stages = stepper.begin_step(h, tracks);
    for (int i = 0; i < stages; ++i) {
      const StageRates r = stepper.begin_stage(i, tracks);
      const double f = force ? force(t + stepper.stage_time(i) * h) : 0;
      track.x[0] = (f - r.c_w * track.x_h[0] - track.v_h[0]) / (r.c_w * r.c_v + w_ * w_);
      stepper.finish_stage(i, tracks);
    }
    error = std::hypot(stepper.position_error(track)[0], stepper.velocity_error(track)[0] / 3);
    stepper.accept(tracks);
    t += h;
  }

  /// An impulse: the velocity jumps, the scheme starts afresh.
  void kick(double dv) {
    track.set_start(track.x, track.v + VecX::Constant(1, dv));
    stepper.reset();
  }

  double x() const { return track.x[0]; }

  double v() const { return track.v[0]; }

  Track track;
  Stepper stepper;
  double t = 0;
  double error = 0;  ///< estimated in the last step, of x and v / 3

 private:
  double w_;
};

constexpr double kW = 3;

/// Error after unit time, with steps h alternating with h · ratio.
double oscillator_error(SchemeKind kind, int pairs, double ratio) {
  Oscillator o(kind, kW, 1, 0.5);
  const double h = 1.0 / (pairs * (1 + ratio));
  for (int i = 0; i < pairs; ++i) {
    o.step(h);
    o.step(ratio * h);
  }
  const double x = std::cos(kW) + 0.5 / kW * std::sin(kW),
               v = -kW * std::sin(kW) + 0.5 * std::cos(kW);
  return std::hypot(o.x() - x, (o.v() - v) / kW);
}

double observed_order(SchemeKind kind, double ratio) {
  const int pairs = kind == SchemeKind::kRadau5 ? 12 : 80;  // well above round-off
  return std::log2(oscillator_error(kind, pairs, ratio) / oscillator_error(kind, 2 * pairs, ratio));
}

TEST(Stepper, HasItsSchemesOrderFromTheFirstStep) {
  for (SchemeKind kind : kAllSchemes)
    // at 160 steps a period of 2.1 the next term is a few percent of the error
    EXPECT_NEAR(observed_order(kind, 1), order_of(kind), 0.06) << to_string(kind);
}

TEST(Stepper, KeepsItsOrderWhenStepsAlternate) {
  for (SchemeKind kind : kAllSchemes) {
    if (kind == SchemeKind::kGeneralizedAlpha) continue;  // see the next test
    EXPECT_GT(observed_order(kind, 0.5), order_of(kind) - 0.1) << to_string(kind);
  }
}

// Its auxiliary acceleration belongs to an instant that moves with the step (Brüls & Cardona 2010):
// a change of step costs an order, as for the classical Newmark family.
TEST(Stepper, GeneralizedAlphaLosesAnOrderWhenStepsAlternate) {
  EXPECT_GT(observed_order(SchemeKind::kGeneralizedAlpha, 0.5), 0.9);
}

TEST(Stepper, FirstStepIsOfTheStartersOrder) {
  for (SchemeKind kind : kAllSchemes) {
    if (kind == SchemeKind::kBackwardEuler || kind == SchemeKind::kRadau5) continue;
    const auto error = [&](double h) {
      Oscillator o(kind, kW, 1, 0.5);
      o.step(h);
      return std::abs(o.x() - (std::cos(kW * h) + 0.5 / kW * std::sin(kW * h)));
    };
    EXPECT_GT(std::log2(error(0.02) / error(0.01)), 3.8) << to_string(kind);  // local: order + 1
    Oscillator o(kind, kW, 1, 0.5);
    o.step(0.1);
    EXPECT_STREQ(o.stepper.step_name(), "sdirk3");
    o.step(0.1);
    EXPECT_STREQ(o.stepper.step_name(), to_string(kind));
  }
}

TEST(Stepper, FreeFallIsExactFromSecondOrderOn) {
  for (SchemeKind kind : kAllSchemes) {
    Oscillator o(kind, 0, 0.3, -0.2);
    for (int i = 0; i < 20; ++i)
      o.step(i % 3 == 0 ? 0.03 : 0.05, [](double) { return -9.81; });
    constexpr double kRoundOff = 1e-12;  // 1e-16 / h of every step
    const double x = 0.3 - 0.2 * o.t - 4.905 * o.t * o.t;
    if (kind == SchemeKind::kBackwardEuler) {
      EXPECT_LT(std::abs(o.x() - x), 9.81 / 2 * 0.05 * o.t * 1.01);  // h/2 times the acceleration
    } else {
      EXPECT_NEAR(o.x(), x, kRoundOff) << to_string(kind);
    }
    EXPECT_NEAR(o.v(), -0.2 - 9.81 * o.t, kRoundOff) << to_string(kind);
  }
}

TEST(Stepper, ErrorEstimateFallsWithTheEmbeddedOrder) {
  for (SchemeKind kind : {SchemeKind::kTrBdf2, SchemeKind::kEsdirk32, SchemeKind::kEsdirk43}) {
    const auto estimate = [&](double h) {
      Oscillator o(kind, kW, 1, 0.5);
      o.step(h);  // the starter, whose own estimate is not asked for
      o.step(h);
      return o.error;
    };
    Oscillator o(kind, kW, 1, 0);
    o.step(0.01);
    o.step(0.01);
    EXPECT_NEAR(std::log2(estimate(0.02) / estimate(0.01)), o.stepper.error_order(), 0.1)
        << to_string(kind);
  }
}

TEST(Stepper, IntegralOverAStepIsExactForWhatItsOrderCovers) {
  for (SchemeKind kind : kAllSchemes) {
    Oscillator o(kind, 1, 1, 0);
    o.step(0.1);
    const std::vector<Track*> tracks{&o.track};
    const int stages = o.stepper.begin_step(0.1, tracks);
    std::vector<double> ones{1}, times{0};
    for (int i = 0; i < stages; ++i) {
      ones.push_back(1);
      times.push_back(o.stepper.stage_time(i));
    }
    EXPECT_NEAR(o.stepper.integrate(ones), 1, 1e-14) << to_string(kind);
    EXPECT_NEAR(o.stepper.integrate(times), 0.5, 1e-14) << to_string(kind);
  }
}

// Rounds of the triangular iteration lead to the stages of the full table: in x of x' = -k x with
// any k h, and no slower than by a factor of three each.
TEST(Radau5, RoundsLeadToTheStagesOfTheTable) {
  const RadauTable& radau = radau5();
  Eigen::Matrix3d A, L;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      A(i, j) = radau.a[i][j];
      L(i, j) = radau.lower[i][j];
    }
  EXPECT_NEAR(L.determinant(), A.determinant(), 1e-15);
  for (int i = 0; i < 3; ++i) {
    // stage order 3: sum_j A_ij c_j^(q-1) = c_i^q / q
    for (int q = 1; q <= 3; ++q) {
      double sum = 0;
      for (int j = 0; j < 3; ++j)
        sum += A(i, j) * std::pow(radau.c[j], q - 1);
      EXPECT_NEAR(sum, std::pow(radau.c[i], q) / q, 1e-15);
    }
  }
  // order 5: the quadrature of b = last row
  for (int q = 1; q <= 5; ++q) {
    double sum = 0;
    for (int j = 0; j < 3; ++j)
      sum += A(2, j) * std::pow(radau.c[j], q - 1);
    EXPECT_NEAR(sum, 1.0 / q, 1e-15);
  }
  // what a round leaves of an error, for oscillations h w and decays h k of every size
  for (double size = 1e-3; size < 1e6; size *= 1.5)
    for (const std::complex<double> z : {std::complex<double>(0, size), {-size, 0}}) {
      const Eigen::Matrix3cd left = Eigen::Matrix3cd::Identity() - z * L;
      const Eigen::Matrix3cd round = left.inverse() * (z * (A - L));
      EXPECT_LT(
          Eigen::ComplexEigenSolver<Eigen::Matrix3cd>(round).eigenvalues().cwiseAbs().maxCoeff(),
          0.6)
          << z;
    }
}

// Amplification of (x, h v, h² A) over one step of generalised-alpha at h w → infinity.
TEST(GeneralizedAlpha, DampsTheStiffestModesByRhoInfinity) {
  for (double rho : {0.0, 0.3, 0.8, 1.0}) {
    const double h = 0.01, w = 1e6;
    Eigen::Matrix3d G;
    for (int c = 0; c < 3; ++c) {
      Stepper stepper({SchemeKind::kGeneralizedAlpha, -0.4, rho});
      Track track;
      track.resize(1);
      const std::vector<Track*> tracks{&track};
      stepper.begin_step(h, tracks);  // the starter
      stepper.accept(tracks);
      track.x0[0] = c == 0;
      track.v0[0] = (c == 1) / h;
      track.A0[0] = (c == 2) / (h * h);
      track.a0[0] = -w * w * track.x0[0];
      stepper.begin_step(h, tracks);
      const StageRates r = stepper.begin_stage(0, tracks);
      track.x[0] = -(r.c_w * track.x_h[0] + track.v_h[0]) / (r.c_w * r.c_v + w * w);
      stepper.finish_stage(0, tracks);
      stepper.accept(tracks);
      G.col(c) << track.x0[0], h * track.v0[0], h * h * track.A0[0];
    }
    const double radius = G.eigenvalues().cwiseAbs().maxCoeff();
    // a triple eigenvalue: the cube root of (h w)^-2
    EXPECT_NEAR(radius, rho, 5e-3) << rho;
  }
}

// Exactly but for round-off: v comes from differences of x over h, 1e-16 / 0.003 a stage.
TEST(Stepper, JumpOfVelocityIsKeptExactly) {
  for (SchemeKind kind : kAllSchemes) {
    Oscillator o(kind, 0, 0, 0);
    for (int i = 0; i < 5; ++i)
      o.step(0.01);
    o.kick(1);
    for (int i = 0; i < 100; ++i) {
      o.step(0.01);
      EXPECT_NEAR(o.v(), 1, 1e-10) << to_string(kind) << ", step " << i;
    }
    EXPECT_NEAR(o.x(), 1, 1e-10) << to_string(kind);
  }
}

// 4 N for 2 ms on 1 kg, both edges known to the stepper.
TEST(Stepper, PulseOfForceGivesItsMomentum) {
  for (SchemeKind kind : kAllSchemes) {
    Oscillator o(kind, 0, 0, 0);
    const auto run = [&](double f, int steps) {
      o.stepper.reset();
      for (int i = 0; i < steps; ++i)
        o.step(5e-4, [f](double) { return f; });
    };
    run(0, 3);
    run(4, 4);
    run(0, 20);
    EXPECT_NEAR(o.v(), 8e-3, 8e-3 * 1e-6) << to_string(kind);
  }
}

}  // namespace
}  // namespace cprsim
