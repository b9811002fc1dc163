// SPDX-License-Identifier: BSD-3-Clause
// The loop: builds a robot from a scene, finds its start, and advances it step by step. Knows
// nothing of files, pictures or terminals: an observer receives snapshots.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/math/archive.h"
#include "engine/model/scene.h"
#include "engine/robot/free_bodies.h"
#include "engine/rod/rod_maker.h"
#include "engine/run/snapshot.h"
#include "engine/solve/report.h"

namespace cprsim {

class PhaseClock;
struct Robot;
struct RobotUnknowns;

/// How a run ended.
enum class RunStatus {
  kRunning,  ///< advance() may be called
  kDone,     ///< the duration is reached, or the static equilibrium found
  kFailed,   ///< see failure
};

/// Why a run could not go on.
enum class Failure {
  kNone,
  kStart,    ///< no equilibrium or assembly to begin with
  kOverlap,  ///< a rod begins inside something
  kStep,     ///< a step or equilibrium was not found
  kContact   ///< a rod would pass through something, or be thrown
};

/// Sums over a run, for run.json and the closing lines.
struct RunStatistics {
  long steps = 0, rejected = 0, retried = 0;
  long iterations = 0, max_iterations = 0;  ///< of steps
  long start_iterations = 0;                ///< of finding the initial state
  long section_evaluations = 0, factorizations = 0;
  double worst_residual = 0;
  double smallest_step = 0, largest_step = 0;
  double build_seconds = 0, start_seconds = 0, step_seconds = 0;
};

/// Without wall times.
void visit(RunStatistics& statistics, Archive& archive);

/// Per-rod facts for `info` and run.json.
struct RodFacts {
  std::string name;
  double length = 0, mass = 0;
  double bending_x = 0, bending_y = 0, torsion = 0, axial = 0, shear_x = 0;
  double first_frequency = 0;  ///< Hz, as a cantilever
  double buckling_load = 0;    ///< N, clamped-free Euler load of the weaker plane
  double growth_exponent = 0;  ///< design section 5, at the step used
  Method method = Method::kShooting;
  std::string method_reason;
  std::string section_law;      ///< chosen for what the scene lists; empty where there is but one
  std::string rule;             ///< of its pieces: "gauss6", "legendre"
  int elements = 0, order = 0;  ///< pieces, and the order of the rule
  int segments = 0, unknowns = 0;
  double gravity_number = 0, shear_number = 0, extension_number = 0, rotary_number = 0,
         damping_ratio = 0;
  /// Of a fluid, a magnetic field, heat that the scene describes, listed or not.
  double drag_number = 0, magnetic_number = 0, thermal_number = 0;
  double rolling_number = 0;  ///< of what moves when it rolls, the part that turns; 0: it does not
};

struct ProblemFacts {
  std::string scheme;
  bool planar = false;  ///< of the kernel: everything moves in a plane
  double step = 0;      ///< fixed step, or 0 when adaptive
  int body_unknowns = 0, constraint_unknowns = 0;
  std::vector<RodFacts> rods;
};

class Simulation {
 public:
  /// @param free_bodies may be null if the scene has no free bodies or nothing is to integrate
  /// them.
  /// @param make_rods makes the rods; empty: make_rod().
  /// @throws std::invalid_argument if the scene asks for what the engine cannot do (a loader checks
  /// first).
  explicit Simulation(Scene scene, std::unique_ptr<FreeBodies> free_bodies = nullptr,
                      const RodMaker& make_rods = {});
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const ProblemFacts& facts() const;

  /// From here on `clock` measures where the time goes; null: nothing does. It must outlive this.
  void measure(PhaseClock* clock);

  /// Finds the initial state (static equilibrium if the scene asks for it or is static).
  const SolveReport& start();

  /// The same for a scene that starts in equilibrium, from the equilibrium of a neighbour: the same
  /// robot with slightly other numbers. Newton's method only, so that the answer is on the
  /// neighbour's branch and smooth in those numbers, with one step more than the tolerance asks for
  /// (the error left is of the order of its square). Where that fails, or the robot is another one,
  /// as start(); `followed` says which.
  const SolveReport& start_near(const RobotUnknowns& neighbour, bool* followed = nullptr);

  /// The same, moved to first order only: one Newton step from the neighbour's equilibrium, with
  /// this robot's own Jacobian. Half the difference of two, at p + h and p - h, over h is the
  /// derivative of the equilibrium by the implicit function theorem, to second order in h.
  /// @pre a scene that starts in equilibrium
  /// @return false if the robot is another one or the equilibrium singular: start as start() does
  bool start_beside(const RobotUnknowns& neighbour);

  /// From here on steps end at these ascending instants, whatever their estimated errors: the
  /// course of another run of a robot with slightly other numbers, whose answer then differs
  /// smoothly (internal numerical differentiation, Bock, Bonner Math. Schriften 183, 1987). Steps
  /// that fail are still halved, and jumps met. For schemes of this engine, not ida's.
  void retrace(std::vector<double> instants);

  /// All unknowns as they now are, for start_near() of another simulation.
  std::shared_ptr<const RobotUnknowns> unknowns() const;

  /// One time step (or, in quasi-static mode, one equilibrium). Only while status() is kRunning.
  const SolveReport& advance();

  /// Everything that steps have left behind: written, read in the place of start(), or hashed.
  /// Reading a state of this scene goes on from there as if it had never been written, bit for bit.
  /// @throws StateError for a state of another robot, and for scenes with bodies in free flight:
  /// what contact remembers of them is not known here
  void visit(Archive& archive);

  /// Whether visit() may be called.
  bool has_visitable_state() const;

  RunStatus status() const;
  double time() const;
  /// Where the run will end: the duration, 0 for a static scene.
  double end_time() const;
  const std::string& failure() const;  ///< a sentence for people when status() is kFailed
  Failure failure_kind() const;
  const SolveReport& last_report() const;
  const Robot& robot() const;  ///< as it now stands
  const RunStatistics& statistics() const;

  /// State at the end of the last step.
  const Snapshot& now() const;
  /// State at its beginning; observers interpolate between the two.
  const Snapshot& before() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace cprsim
