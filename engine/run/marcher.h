// SPDX-License-Identifier: BSD-3-Clause
// One time step of the Newton system: the scheme's stages, each a solve started from an
// extrapolated guess, the error estimate, and acceptance. A step that fails leaves the robot as it
// was.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "engine/robot/equations.h"
#include "engine/solve/newton.h"
#include "engine/time/ida_integrator.h"
#include "engine/time/scheme.h"

namespace cprsim {

class EnergyLedger;
class RodContacts;

class Marcher {
 public:
  Marcher(Robot& robot, Equations& equations, const SchemeChoice& scheme,
          const SolveOptions& options, RodContacts& contacts);

  /// After the start state is set: tracks at rest or moving, no history.
  void begin();

  /// Forgets history: called at every jump.
  void restart();

  /// From here on backward Euler, or (off) the scheme again from its starter.
  void cushion(bool on);

  struct Outcome {
    bool converged = false;
    bool touched = false;  ///< contacts came, went, stuck or slipped
    bool struck = false;   ///< rigid ones among them, which stop at once
    bool leapt = false;    ///< a rod may have passed through something
    SolveReport report;    ///< of the last solve; iterations and counts summed over the step
    double error = 0;  ///< estimated local error, dimensionless (length: rod length; angle: rad)
    double damping_loss = 0, drive_work = 0;  ///< J
  };

  /// Tries a step of size h from t. Nothing is final before accept().
  Outcome attempt(double t, double h, const EnergyLedger& ledger);
  void accept();
  void reject();

  /// For who has steps of his own and fills x_h, v_h of the tracks: a solve at `time`, from what
  /// was kept before. Where it converges x of all tracks, and v of rotations, are filled.
  SolveReport solve_at(double time, const StageRates& rates);
  /// The state at `time` is final; later solves look back on it.
  void keep(double time);

  /// The robot returns to what was kept last.
  void go_back() { equations_.set_unknowns(past_.back().unknowns); }

  /// How much of each track counts in errors, as Robot::tracks().
  std::vector<TrackError> track_errors() const;

  const std::vector<Track*>& tracks() const { return tracks_; }

  void visit(Archive& archive);

  bool estimates_error() const { return stepper_.has_error_estimate(); }

  int error_order() const { return stepper_.error_order(); }

  const char* step_name() const { return stepper_.step_name(); }

 private:
  struct Solved {
    double time;
    RobotUnknowns unknowns;
  };

  void predict(double time);
  SolveOptions patient() const;
  SolveReport solve_stage(double time);
  SolveReport solve_once(double time);
  double error_estimate() const;
  double round_change() const;
  void fill_tracks();
  void finish_stage(int i);

  Robot& robot_;
  Equations& equations_;
  SolveOptions options_;
  RodContacts& contacts_;
  Stepper stepper_;
  std::vector<Track*> tracks_;
  std::deque<Solved> past_;        ///< accepted and stage solutions, oldest first
  std::size_t past_accepted_ = 0;  ///< how many of them are older than the step under way
  RobotUnknowns start_;
  StageRates rates_;
  double h_ = 0;
  /// Damping power when the step began and as it ends, W; below 0: not known yet. The robot itself
  /// says what the last attempt made of it.
  double loss_ = -1, loss_after_ = -1;
};

}  // namespace cprsim
