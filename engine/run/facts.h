// SPDX-License-Identifier: BSD-3-Clause
// How a scene will be stepped, and the numbers about its rods that people want to see before a run.
#pragma once

#include <limits>
#include <vector>

#include "engine/model/scene.h"
#include "engine/robot/equations.h"
#include "engine/run/simulation.h"
#include "engine/solve/newton.h"
#include "engine/time/scheme.h"

namespace cprsim {

struct StepPlan {
  SchemeChoice scheme;
  bool adaptive = false;
  double step = 0;       ///< fixed step, or the first one
  double tolerance = 0;  ///< local error per step relative to the longest rod
  /// Of steps that adapt. Where hardly anything moves they grow as fast as they may, whatever is
  /// asked of them: two runs for different errors would be the same run.
  double longest = std::numeric_limits<double>::infinity();
};

StepPlan plan_steps(const Scene& scene);

/// When drives or loads jump or have a kink, ascending, and the end.
std::vector<double> break_times(const Scene& scene, double end);

/// The step after one with this error estimate; last_error 0: there was none before.
double controlled_step(const StepPlan& plan, double step, double error, double last_error,
                       int order);

/// Of equilibria: one point to get right, with more iterations than a time step may have.
SolveOptions static_options(const SolverSpec& spec);
SolveOptions step_options(const SolverSpec& spec);

ProblemFacts problem_facts(const Robot& robot, const Equations& equations, const StepPlan& plan);

}  // namespace cprsim
