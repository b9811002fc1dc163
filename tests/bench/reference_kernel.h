// SPDX-License-Identifier: BSD-3-Clause
// A yardstick that every machine has: one classical Runge-Kutta step of a rod section in plain
// scalar code. Benchmarks report their time in such steps too, which carries over to other
// machines.
//
//   p_s = R v    q_s = q ∘ (0, u) / 2    n_s = -f    m_s = -p_s × n
//   v = (0, 0, 1) + C_se R^T n           u = C_bt R^T m
#pragma once

namespace benchmark {
class State;
}

namespace cprsim {

/// p (3), q (w x y z), n (3), m (3), world axes.
constexpr int kSectionStates = 13;

struct SectionCurve {
  double y[kSectionStates];
};

/// The base of a bent 2 mm steel rod.
SectionCurve section_curve_start();

/// One step of length h.
void rk4_step(SectionCurve& curve, double h);

/// Seconds of one step, measured once at the first call: the best of many short runs.
double rk4_step_seconds();

/// Time per iteration in units of that.
void count_in_rk4_steps(benchmark::State& state);

}  // namespace cprsim
