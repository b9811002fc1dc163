// SPDX-License-Identifier: BSD-3-Clause
// The residuals of a study: the scene with trial values, simulated, seen through the matched
// channels, minus what was measured, in units of sigma (1 where it is to be estimated).
//
// Derivatives go through the solver. That of an equilibrium is the one of the implicit function
// theorem, dx/dz = -(dF/dx)^-1 dF/dz with the solver's own Jacobian: two single Newton steps from
// the equilibrium at z, of robots built at z ± h. That of a motion is the derivative of what the
// steps compute: runs at z ± h that take the steps of the run at z, one for one (internal numerical
// differentiation), so that no choice of steps stands between them.
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

  /// Whether runs at z ± h cannot take the steps of the run at z.
  bool chooses_steps() const { return chooses_steps_; }

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
  bool compute(const VecX& z, VecX& computed);
  bool solve_rows(const VecX& z, VecX& computed);
  bool solve_row(const VecX& z, std::size_t k, std::size_t& cell, VecX& computed);
  bool run_record(const VecX& z, VecX& computed);
  bool refuse(std::size_t row, const std::string& why);
  std::unique_ptr<Simulation> simulate(const Scene& scene, const State& near, bool& followed);
  std::unique_ptr<Simulation> simulate_beside(const Scene& scene, const State& near);

  const Study& study_;
  double step_;
  bool chooses_steps_ = false;
  bool beside_ = false;  ///< a difference is being taken: close to last_z_, along its solutions
  VecX low_, high_;
  std::vector<State> centre_, last_;  ///< per used row: where the search is, and the last answer
  std::vector<double> course_;        ///< instants at which the last run's steps ended
  VecX last_z_;
  std::string failure_;
  bool scene_refused_ = false;
  long simulations_ = 0, restarts_ = 0;
};

}  // namespace cprsim
