// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/reference_kernel.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>

namespace cprsim {
namespace {

// a round 2 mm steel rod of 0.4 m in steps of 20 mm, and its weight
constexpr double kBendingCompliance = 1 / 0.15707963, kTwistCompliance = 1 / 0.12566371;
constexpr double kShearCompliance = 1 / 251327.41, kStretchCompliance = 1 / 628318.53;
constexpr double kForce[3] = {0, 0, -0.24654};
constexpr double kStep = 0.02;
constexpr int kStepsOfRod = 20;

void derivative(const double* y, double* y_s) {
  const double w = y[3], a = y[4], b = y[5], c = y[6];
  const double *n = y + 7, *m = y + 10;
  const double R[3][3] = {
      {w * w + a * a - b * b - c * c, 2 * (a * b - w * c), 2 * (a * c + w * b)},
      {2 * (a * b + w * c), w * w - a * a + b * b - c * c, 2 * (b * c - w * a)},
      {2 * (a * c - w * b), 2 * (b * c + w * a), w * w - a * a - b * b + c * c}};
  double N[3], M[3];
  for (int i = 0; i < 3; ++i) {
    N[i] = R[0][i] * n[0] + R[1][i] * n[1] + R[2][i] * n[2];
    M[i] = R[0][i] * m[0] + R[1][i] * m[1] + R[2][i] * m[2];
  }
  const double v[3] = {kShearCompliance * N[0], kShearCompliance * N[1],
                       1 + kStretchCompliance * N[2]};
  const double u[3] = {kBendingCompliance * M[0], kBendingCompliance * M[1],
                       kTwistCompliance * M[2]};
  for (int i = 0; i < 3; ++i) {
    y_s[i] = R[i][0] * v[0] + R[i][1] * v[1] + R[i][2] * v[2];
    y_s[7 + i] = -kForce[i];
  }
  y_s[3] = -0.5 * (a * u[0] + b * u[1] + c * u[2]);
  y_s[4] = 0.5 * (w * u[0] + b * u[2] - c * u[1]);
  y_s[5] = 0.5 * (w * u[1] + c * u[0] - a * u[2]);
  y_s[6] = 0.5 * (w * u[2] + a * u[1] - b * u[0]);
  y_s[10] = y_s[2] * n[1] - y_s[1] * n[2];
  y_s[11] = y_s[0] * n[2] - y_s[2] * n[0];
  y_s[12] = y_s[1] * n[0] - y_s[0] * n[1];
}

double measure() {
  using Clock = std::chrono::steady_clock;
  constexpr int kRuns = 200, kRods = 50;
  double best = 1;
  for (int run = 0; run < kRuns; ++run) {
    const Clock::time_point begin = Clock::now();
    for (int rod = 0; rod < kRods; ++rod) {
      SectionCurve curve = section_curve_start();
      for (int k = 0; k < kStepsOfRod; ++k)
        rk4_step(curve, kStep);
      benchmark::DoNotOptimize(curve);
    }
    const std::chrono::duration<double> spent = Clock::now() - begin;
    best = std::min(best, spent.count() / (kRods * kStepsOfRod));
  }
  return best;
}

void rk4_section_step(benchmark::State& state) {
  SectionCurve curve = section_curve_start();
  int k = 0;
  for (auto _ : state) {
    rk4_step(curve, kStep);
    if (++k < kStepsOfRod) continue;
    k = 0;
    benchmark::DoNotOptimize(curve);
    curve = section_curve_start();
  }
  count_in_rk4_steps(state);
}

BENCHMARK(rk4_section_step);

}  // namespace

SectionCurve section_curve_start() {
  return {{0, 0, 0, 1, 0, 0, 0, -1.5, -0.9, -4.5, 0.12, -0.21, 0.01}};
}

void rk4_step(SectionCurve& curve, double h) {
  double k1[kSectionStates], k2[kSectionStates], k3[kSectionStates], k4[kSectionStates];
  double y[kSectionStates];
  derivative(curve.y, k1);
  for (int i = 0; i < kSectionStates; ++i)
    y[i] = curve.y[i] + 0.5 * h * k1[i];
  derivative(y, k2);
  for (int i = 0; i < kSectionStates; ++i)
    y[i] = curve.y[i] + 0.5 * h * k2[i];
  derivative(y, k3);
  for (int i = 0; i < kSectionStates; ++i)
    y[i] = curve.y[i] + h * k3[i];
  derivative(y, k4);
  for (int i = 0; i < kSectionStates; ++i)
    curve.y[i] += h / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
}

double rk4_step_seconds() {
  static const double seconds = measure();
  return seconds;
}

void count_in_rk4_steps(benchmark::State& state) {
  using benchmark::Counter;
  state.counters["rk4_steps"] =
      Counter(rk4_step_seconds(), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

}  // namespace cprsim
