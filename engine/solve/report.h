// SPDX-License-Identifier: BSD-3-Clause
// How a nonlinear solve ended, by value.
#pragma once

#include <string>
#include <vector>

namespace cprsim {

enum class SolveStatus {
  kConverged,       ///< residual <= tolerance
  kStalled,         ///< no step reduces the residual any more
  kIterationLimit,  ///< max_iterations reached with residual > tolerance
  kNotFinite,       ///< a residual or a step is NaN or infinite
  kSingular,        ///< the linearised system has no unique solution
  kWorkLimit        ///< most_work reached with residual > tolerance
};

/// Which rung of the ladder found (or last tried for) the solution. Continuation is in loads and
/// gaps, or in the rods' stiffness (hardening).
enum class SolveStage { kNewton, kLevenbergMarquardt, kContinuation, kRelaxation };

const char* to_string(SolveStatus status);
const char* to_string(SolveStage stage);

struct SolveReport {
  SolveStatus status = SolveStatus::kConverged;
  SolveStage stage = SolveStage::kNewton;
  int iterations = 0;  ///< all Newton or LM iterations, over all rungs
  int factorizations = 0;
  long evaluations = 0;  ///< section evaluations
  double residual = 0;   ///< largest scaled row, dimensionless
  double initial_residual = 0;
  double loaded = 1;            ///< part of the loads that was carried, where they grew
  double growth = 0;            ///< largest segment transition norm
  std::string worst_row;        ///< e.g. "tip of robot::leg_3, moment y"
  std::vector<double> history;  ///< residual per iteration

  bool converged() const { return status == SolveStatus::kConverged; }
};

/// Adds up what parts of a solve took; how it ended is how the last one did.
void add_counts(SolveReport& total, const SolveReport& part);

}  // namespace cprsim
