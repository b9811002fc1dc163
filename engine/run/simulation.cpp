// SPDX-License-Identifier: BSD-3-Clause
#include "engine/run/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "engine/math/state_text.h"
#include "engine/robot/equations.h"
#include "engine/robot/free_bodies.h"
#include "engine/run/continuous_drives.h"
#include "engine/run/facts.h"
#include "engine/run/ledger.h"
#include "engine/run/marcher.h"
#include "engine/run/observation.h"

namespace cprsim {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

}  // namespace

struct Simulation::Parts {
  const Scene scene;  // bodies, rods and loads point into it
  std::unique_ptr<FreeBodies> free_bodies;
  Robot robot;
  Equations equations;
  StepPlan plan;
  Marcher marcher;
  EnergyLedger ledger;
  ProblemFacts facts;

  RunStatus status = RunStatus::kRunning;
  double t = 0, end = 0, h = 0;
  double last_error = 0;
  std::vector<double> breaks;
  std::string failure;
  SolveReport report;
  RunStatistics statistics;
  Snapshot now, before;

  Parts(Scene s, std::unique_ptr<FreeBodies> free)
      : scene(with_continuous_drives(std::move(s))),
        free_bodies(std::move(free)),
        robot(build_robot(scene)),
        equations(robot, scene.solver.residual_tolerance.value_or(1e-9)),
        plan(plan_steps(scene)),
        marcher(robot, equations, plan.scheme, step_options(scene.solver)),
        ledger(robot, free_bodies.get()) {
    h = plan.adaptive ? std::min(plan.step, 1e-3) : plan.step;
    if (scene.simulation.mode != Mode::kStatic) end = scene.simulation.duration;
    breaks = break_times(scene, end);
  }

  bool free_only() const { return robot.rods.empty() && robot.bodies.empty(); }

  void fail(const std::string& what) {
    status = RunStatus::kFailed;
    failure = what + ": " + to_string(report.status) + " after " +
              std::to_string(report.iterations) + " iterations, residual " +
              number(report.residual) + " in " + report.worst_row;
  }

  void count(const SolveReport& r) {
    statistics.iterations += r.iterations;
    statistics.max_iterations = std::max<long>(statistics.max_iterations, r.iterations);
    statistics.section_evaluations += r.evaluations;
    statistics.factorizations += r.factorizations;
    if (r.converged()) statistics.worst_residual = std::max(statistics.worst_residual, r.residual);
  }

  void observe(double step, double wall) {
    before = std::move(now);
    now = take_snapshot(robot, free_bodies.get(), t);
    now.energy = ledger.sample();
    now.solver = {report.iterations, report.residual, step, wall};
  }

  bool find_equilibrium() {
    equations.set_instant(t, true, StageRates{});
    equations.mark_start();
    report = solve_statics(equations, static_options(scene.solver));
    count(report);
    if (!report.converged()) fail("no static equilibrium found");
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

  /// @return whether the neighbour's equilibrium could be followed
  bool start(const RobotUnknowns* neighbour);

  /// Rods find their unloaded shape between bodies that stay where the scene puts them.
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

  void start_motion() {
    bool moving = false;
    std::vector<Vec6> motions;
    for (RigidBody& body : robot.bodies) {
      const BodySpec& link = scene.bodies[static_cast<std::size_t>(body.links.front())];
      const Pose X = robot.link_pose(static_cast<std::size_t>(body.links.front()));
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

  /// The next instant at which something jumps, or the end.
  double next_break() const {
    const auto at = std::upper_bound(breaks.begin(), breaks.end(), t * (1 + 1e-12) + 1e-15);
    return at == breaks.end() ? end : *at;
  }

  void step_dynamic();
  void step_quasistatic();

  double controlled(double step, double error) const {
    return controlled_step(plan, step, error, last_error, marcher.error_order());
  }

  void arrive(double t_new, double h_used, const Marcher::Outcome& outcome);
  void visit(Archive& archive);
};

Simulation::Simulation(Scene scene, std::unique_ptr<FreeBodies> free_bodies) {
  const auto begin = Clock::now();
  parts_ = std::make_unique<Parts>(std::move(scene), std::move(free_bodies));
  parts_->facts = problem_facts(parts_->robot, parts_->equations, parts_->plan);
  parts_->statistics.build_seconds = seconds_since(begin);
}

Simulation::~Simulation() = default;

const ProblemFacts& Simulation::facts() const {
  return parts_->facts;
}

bool Simulation::Parts::start(const RobotUnknowns* neighbour) {
  const auto begin = Clock::now();
  const bool equilibrium =
      scene.simulation.mode != Mode::kDynamic || scene.simulation.initial_static;
  const bool near = neighbour && equilibrium && !free_only() && follow(*neighbour);
  if (!near && !free_only() && !(equilibrium ? find_equilibrium() : assemble())) {
    observe(0, seconds_since(begin));
    return false;
  }
  if (!free_only()) start_motion();
  // equilibria at the start know no friction: which of many would it be?
  if (scene.simulation.mode != Mode::kStatic)
    for (Joint& joint : robot.joints)
      joint.engage_friction();
  statistics.start_iterations = std::exchange(statistics.iterations, 0);
  statistics.max_iterations = 0;
  ledger.open();
  statistics.start_seconds = seconds_since(begin);
  observe(0, statistics.start_seconds);
  before = now;
  if (end <= 0) status = RunStatus::kDone;
  return near;
}

const SolveReport& Simulation::start() {
  parts_->start(nullptr);
  return parts_->report;
}

const SolveReport& Simulation::start_near(const RobotUnknowns& neighbour, bool* followed) {
  const bool near = parts_->start(&neighbour);
  if (followed != nullptr) *followed = near;
  return parts_->report;
}

std::shared_ptr<const RobotUnknowns> Simulation::unknowns() const {
  return std::make_shared<RobotUnknowns>(parts_->equations.unknowns());
}

void Simulation::Parts::arrive(double t_new, double h_used, const Marcher::Outcome& outcome) {
  marcher.accept();
  t = t_new;
  report = outcome.report;
  count(report);
  if (free_bodies) free_bodies->advance(h_used, link_motions(robot, free_bodies.get()));
  ledger.close_step(t, outcome.damping_loss, outcome.drive_work);
  ++statistics.steps;
  statistics.largest_step = std::max(statistics.largest_step, h_used);
  statistics.smallest_step =
      statistics.steps == 1 ? h_used : std::min(statistics.smallest_step, h_used);
  if (t >= end) status = RunStatus::kDone;
}

void Simulation::Parts::step_dynamic() {
  const int retries = scene.solver.halve_on_failure ? scene.solver.retries : 0;
  const double stop = next_break();
  ledger.begin_step(t);
  double target = h;
  if (plan.adaptive && free_bodies) target = std::min(target, scene.max_step_size);
  for (int failures = 0;; ++failures) {
    const double left = stop - t;
    // land on the break; in adaptive mode without leaving a sliver
    double step = target >= left * (1 - 1e-9) ? left : target;
    if (plan.adaptive && step < left && left < 2 * step) step = 0.5 * left;
    const Marcher::Outcome outcome = marcher.attempt(t, step, ledger);
    if (outcome.converged && (!plan.adaptive || outcome.error <= plan.tolerance)) {
      const bool landed = step == left;
      if (plan.adaptive) {
        const double next = controlled(step, outcome.error);
        h = landed && step < 0.5 * target ? std::max(target, next) : next;
        last_error = outcome.error;
      }
      arrive(landed ? stop : t + step, step, outcome);
      if (landed && t < end) {
        marcher.restart();
        last_error = 0;
        if (plan.adaptive) h = std::min(h, 1e-3);
      }
      return;
    }
    marcher.reject();
    if (outcome.converged) {
      ++statistics.rejected;
      failures = -1;
      target = controlled(step, outcome.error);
      last_error = 0;
      if (target > 1e-12 * std::max(1.0, end)) continue;
    }
    report = outcome.report;
    if (failures >= retries || target <= 1e-12 * std::max(1.0, end)) {
      fail("step failed at t = " + number(t) + " s with a step of " + number(step) + " s");
      return;
    }
    ++statistics.retried;
    target = 0.5 * step;
  }
}

void Simulation::Parts::step_quasistatic() {
  const double stop = next_break();
  double target = plan.step;
  const RobotUnknowns start = equations.unknowns();
  const double from = t, power = ledger.drive_power(t, false);
  ledger.begin_step(t);
  for (int failures = 0;; ++failures) {
    const double step = std::min(target, stop - from);
    t = step >= (stop - from) * (1 - 1e-9) ? stop : from + step;
    equations.set_instant(t, true, StageRates{});
    report = newton(equations, static_options(scene.solver));
    if (!report.converged()) {
      equations.set_unknowns(start);
      report = levenberg_marquardt(equations, static_options(scene.solver));
    }
    count(report);
    if (report.converged()) {
      start_motion();
      equations.accept_equilibrium(t);
      ledger.close_step(t, 0,
                        0.5 * step * (power + ledger.drive_power(t, true)) + ledger.effort_work(t));
      ++statistics.steps;
      if (t >= end) status = RunStatus::kDone;
      return;
    }
    equations.set_unknowns(start);
    t = from;
    if (failures >= scene.solver.retries) {
      fail("no equilibrium found beyond t = " + number(from) + " s");
      return;
    }
    ++statistics.retried;
    target = 0.5 * step;
  }
}

const SolveReport& Simulation::advance() {
  Parts& p = *parts_;
  const auto begin = Clock::now();
  const double from = p.t;
  if (p.free_only()) {
    const double step = std::min(p.plan.step, p.end - p.t);
    p.ledger.begin_step(p.t);
    p.arrive(p.t + step >= p.end * (1 - 1e-12) ? p.end : p.t + step, step, {});
  } else if (p.scene.simulation.mode == Mode::kQuasistatic) {
    p.step_quasistatic();
  } else {
    p.step_dynamic();
  }
  const double wall = seconds_since(begin);
  p.statistics.step_seconds += wall;
  if (p.status != RunStatus::kFailed) p.observe(p.t - from, wall);
  return p.report;
}

void Simulation::Parts::visit(Archive& archive) {
  archive(t);
  archive(h);
  archive(last_error);
  cprsim::visit(statistics, archive);
  equations.visit(archive);
  marcher.visit(archive);
  ledger.visit(archive);
  archive(now.solver.iterations);
  archive(now.solver.residual);
  archive(now.solver.step);
  if (!archive.reading()) return;
  before = take_snapshot(robot, nullptr, t);
  before.energy = ledger.sample();
  before.solver = now.solver;
  now = before;
  status = t < end ? RunStatus::kRunning : RunStatus::kDone;
}

bool Simulation::has_visitable_state() const {
  return parts_->free_bodies == nullptr;
}

void Simulation::visit(Archive& archive) {
  if (!has_visitable_state())
    throw StateError("bodies in free flight: what contact remembers of them cannot be saved");
  parts_->visit(archive);
}

RunStatus Simulation::status() const {
  return parts_->status;
}

double Simulation::time() const {
  return parts_->t;
}

double Simulation::end_time() const {
  return parts_->end;
}

const std::string& Simulation::failure() const {
  return parts_->failure;
}

const SolveReport& Simulation::last_report() const {
  return parts_->report;
}

const RunStatistics& Simulation::statistics() const {
  return parts_->statistics;
}

const Snapshot& Simulation::now() const {
  return parts_->now;
}

const Snapshot& Simulation::before() const {
  return parts_->before;
}

}  // namespace cprsim
