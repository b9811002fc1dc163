// SPDX-License-Identifier: BSD-3-Clause
// What a simulation consists of; for its own source files only.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/robot/contacts.h"
#include "engine/robot/equations.h"
#include "engine/robot/free_bodies.h"
#include "engine/run/continuous_drives.h"
#include "engine/run/facts.h"
#include "engine/run/ledger.h"
#include "engine/run/marcher.h"
#include "engine/run/observation.h"
#include "engine/run/simulation.h"
#include "engine/run/touching_solve.h"
#include "engine/solve/phase_clock.h"

namespace cprsim {

/// Four digits, for messages.
std::string short_number(double x);

/// Time in which what has sunk into an obstacle comes back, over that of the longest step.
constexpr double kRecovery = 10;

struct Simulation::Parts {
  const Scene scene;  // bodies, rods and loads point into it
  std::unique_ptr<FreeBodies> free_bodies;
  Robot robot;
  RodContacts contacts;
  Equations equations;
  StepPlan plan;
  Marcher marcher;
  std::unique_ptr<IdaIntegrator> ida;  ///< if that is the scheme
  int ida_failures = 0;                ///< in a row
  EnergyLedger ledger;
  ProblemFacts facts;

  RunStatus status = RunStatus::kRunning;
  double t = 0, end = 0, h = 0;
  double last_error = 0;
  int cushioned = 0;  ///< steps of backward Euler still to take after a contact changed
  std::vector<double> breaks;
  std::vector<double> course;  ///< instants that another run's steps ended at; empty: none
  std::string failure;
  Failure failure_kind = Failure::kNone;
  bool started = false;
  bool shaped = false;  ///< some rod begins in a shape that the scene gives
  SolveReport report;
  RunStatistics statistics;
  Snapshot now, before;

  Parts(Scene s, std::unique_ptr<FreeBodies> free, const RodMaker& make_rods)
      : scene(with_continuous_drives(std::move(s))),
        free_bodies(std::move(free)),
        robot(build_robot(scene, make_rods)),
        contacts(robot),
        equations(robot, scene.solver.residual_tolerance.value_or(1e-9)),
        plan(plan_steps(scene)),
        marcher(robot, equations, plan.scheme, step_options(scene.solver), contacts),
        ledger(robot, free_bodies.get()) {
    h = plan.adaptive ? std::min(plan.step, 1e-3) : plan.step;
    if (scene.simulation.mode != Mode::kStatic) end = scene.simulation.duration;
    breaks = break_times(scene, end);
    contacts.set_recovery_time(kRecovery * scene.max_step_size);
    for (const RodSpec& rod : scene.rods)
      shaped = shaped || !rod.start.empty();
  }

  bool free_only() const { return robot.rods.empty() && robot.bodies.empty(); }

  void fail(Failure kind, const std::string& what) {
    status = RunStatus::kFailed;
    failure_kind = kind;
    failure = what;
  }

  void fail(const std::string& what) {
    status = RunStatus::kFailed;
    failure_kind = started ? Failure::kStep : Failure::kStart;
    failure = what + ": " + to_string(report.status) + " after " +
              std::to_string(report.iterations) + " iterations, residual " +
              short_number(report.residual) + " in " + report.worst_row;
  }

  void count(const SolveReport& r) {
    statistics.iterations += r.iterations;
    statistics.max_iterations = std::max<long>(statistics.max_iterations, r.iterations);
    statistics.section_evaluations += r.evaluations;
    statistics.factorizations += r.factorizations;
    if (r.converged()) statistics.worst_residual = std::max(statistics.worst_residual, r.residual);
  }

  void observe(double step, double wall) {
    const PhaseTimer timer(robot.clock, Phase::kObservation);
    before = std::move(now);
    now = take_snapshot(robot, free_bodies.get(), t);
    if (contacts.any()) add_rod_contacts(now.contact);
    now.energy = ledger.sample();
    now.solver = {report.iterations, report.residual, step, wall};
  }

  bool find_equilibrium() {
    equations.set_instant(t, true, StageRates{});
    equations.mark_start();
    SolveOptions options = static_options(scene.solver);
    options.most_work = equations.work() + kMostStaticWork;
    report = shaped ? hold_shape(equations, options) : SolveReport{};
    if (shaped && report.converged() && equations.loads_on())
      report = relax_from_shape(contacts, equations, options);
    else if (!shaped)
      report = contacts.any() && equations.loads_on() ? load_gradually(contacts, equations, options)
                                                      : solve_statics(equations, options);
    count(report);
    if (!report.converged())
      fail("no static equilibrium found" +
           (report.loaded < 1 ? " beyond " + short_number(100 * report.loaded) + " % of the loads"
                              : std::string()));
    return report.converged();
  }

  /// Newton's method from the unknowns of a like robot. @return false: the unknowns are as before
  bool follow(const RobotUnknowns& neighbour) {
    const RobotUnknowns own = equations.unknowns();
    if (!alike(own, neighbour)) return false;
    equations.set_instant(t, true, StageRates{});
    equations.set_unknowns(neighbour);
    SolveOptions options = static_options(scene.solver);
    options.polish = true;
    report = newton(equations, options);
    count(report);
    if (!report.converged()) equations.set_unknowns(own);
    return report.converged();
  }

  /// One Newton step from the unknowns of a like robot.
  bool move_beside(const RobotUnknowns& neighbour) {
    if (!alike(equations.unknowns(), neighbour)) return false;
    equations.set_instant(t, true, StageRates{});
    equations.set_unknowns(neighbour);
    equations.evaluate();
    if (!equations.find_direction(0)) return false;
    equations.keep();
    equations.move(1);
    return equations.evaluate().finite;
  }

  void add_rod_contacts(ContactSample& sample) {
    const ContactSample rods = contacts.sample();
    sample.count += rods.count;
    sample.penetration = std::max(sample.penetration, rods.penetration);
    sample.force = rods.force;
    sample.friction = rods.friction;
    sample.slip = rods.slip;
    sample.points = rods.points;
    sample.links.insert(sample.links.end(), rods.links.begin(), rods.links.end());
    sample.distances = rods.distances;
  }

  /// A rod that begins inside an obstacle would be shot out of it.
  bool starts_clear() {
    if (!contacts.any()) return true;
    const std::string overlap = contacts.overlap();
    if (overlap.empty()) return true;
    fail(Failure::kOverlap, overlap);
    return false;
  }

  /// @return whether the neighbour's equilibrium could be followed
  bool start(const RobotUnknowns* neighbour);
  void begin();

  /// Rods find their unloaded shape, or the one that the scene gives them, between bodies that stay
  /// where the scene puts them.
  bool assemble() {
    equations.hold_bodies(true);
    equations.set_loads(false);
    const bool found = find_equilibrium();
    equations.hold_bodies(false);
    equations.set_loads(true);
    equations.set_instant(t, true, StageRates{});
    if (!found) failure = "the rods cannot be assembled: " + failure;
    return found;
  }

  /// Of the links that make up a body the one that the scene gives a velocity, else the first.
  std::size_t link_in_motion(const RigidBody& body) const {
    const auto given = [&](int link) {
      return scene.bodies[static_cast<std::size_t>(link)].velocity_given;
    };
    const auto at = std::find_if(body.links.begin(), body.links.end(), given);
    return static_cast<std::size_t>(at == body.links.end() ? body.links.front() : *at);
  }

  void start_motion() {
    bool moving = false;
    std::vector<Vec6> motions;
    for (RigidBody& body : robot.bodies) {
      const std::size_t at = link_in_motion(body);
      const BodySpec& link = scene.bodies[at];
      const Pose X = robot.link_pose(at);
      const Vec3 w = link.velocity_given ? link.angular_velocity : Vec3(Vec3::Zero());
      const Vec3 v = link.velocity_given ? Vec3(link.linear_velocity + w.cross(body.p - X.p))
                                         : Vec3(Vec3::Zero());
      body.start_tracks(v, body.R.transpose() * w);
      Vec6 motion;
      motion << w, v;
      motions.push_back(motion);
      moving = moving || link.velocity_given;
    }
    robot.start_joints(motions);
    if (moving) moving = equations.follow_bodies(motions);
    for (RobotRod& rod : robot.rods) {
      if (moving)
        rod.model->start_tracks_moving();
      else
        rod.model->start_tracks();
    }
    marcher.begin();
  }

  /// Where the course that is retraced goes next; infinity where there is none.
  double next_of_course() const {
    const auto at = std::upper_bound(course.begin(), course.end(), t * (1 + 1e-12) + 1e-15);
    return at == course.end() ? std::numeric_limits<double>::infinity() : *at;
  }

  /// The next instant at which something jumps, or the end.
  double next_break() const {
    const auto at = std::upper_bound(breaks.begin(), breaks.end(), t * (1 + 1e-12) + 1e-15);
    return at == breaks.end() ? end : *at;
  }

  void soften(bool touched);
  bool contacts_object(const Marcher::Outcome& outcome, double step, double& target);
  double gain(double t_new, const Marcher::Outcome& outcome) const;
  void settle(double t_new, double h_used, const Marcher::Outcome& outcome);
  void step_dynamic();
  void step_by_ida();
  void begin_ida(double stop);
  void step_quasistatic();

  double controlled(double step, double error) const {
    return controlled_step(plan, step, error, last_error, marcher.error_order());
  }

  void arrive(double t_new, double h_used, const Marcher::Outcome& outcome);
  void visit(Archive& archive);
};

}  // namespace cprsim
