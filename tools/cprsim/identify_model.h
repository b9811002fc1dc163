// SPDX-License-Identifier: BSD-3-Clause
// The residuals of a study: the scene with trial values, simulated, seen through the matched
// channels, minus what was measured, in units of sigma (1 where it is to be estimated).
//
// Derivatives go through the solver: central differences of converged solutions. An equilibrium
// is followed from the one at the centre by Newton's method with a step more than the tolerance
// asks for, so that both ends lie on one branch and are exact to some 1e-12; with steps of 1e-4 in
// z the differences are then good to about 1e-8.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/fit/least_squares.h"
#include "engine/run/simulation.h"
#include "tools/cprsim/identify_study.h"

namespace cprsim {

struct RobotUnknowns;

class SceneFit final : public LeastSquaresProblem {
 public:
  explicit SceneFit(const Study& study);

  bool residuals(const VecX& z, VecX& r) override;
  bool derivative(const VecX& z, const VecX& r, MatX& J) override;
  bool derivative(const VecX& z, const VecX& r, double step, MatX& J);

  /// Of the differences, in z.
  double step() const { return step_; }

  const VecX& low() const { return low_; }

  const VecX& high() const { return high_; }

  VecX start() const;

  /// Computed values of all cells from their residuals, SI.
  VecX computed(const VecX& r) const;

  /// Why the last residuals() had no answer: the row, and what the solver or the loader said.
  const std::string& failure() const { return failure_; }

  /// It was the scene itself that was refused, not its simulation.
  bool scene_refused() const { return scene_refused_; }

  long simulations() const { return simulations_; }

  /// Equilibria that could not be followed and were sought from the scene's own start.
  long restarts() const { return restarts_; }

 private:
  using State = std::shared_ptr<const RobotUnknowns>;

  std::unique_ptr<Scene> scene_at(const VecX& z, std::size_t row);
  bool solve_rows(const VecX& z, VecX& computed);
  bool solve_row(const VecX& z, std::size_t k, std::size_t& cell, VecX& computed);
  bool run_record(const VecX& z, VecX& computed);
  bool refuse(std::size_t row, const std::string& why);
  std::unique_ptr<Simulation> simulate(const Scene& scene, const State& near, bool& followed);

  const Study& study_;
  double step_;
  VecX low_, high_;
  std::vector<State> centre_, last_;  ///< per used row: where the search is, and the last answer
  VecX last_z_;
  std::string failure_;
  bool scene_refused_ = false;
  long simulations_ = 0, restarts_ = 0;
};

}  // namespace cprsim
