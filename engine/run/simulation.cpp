// SPDX-License-Identifier: BSD-3-Clause
#include "engine/run/simulation.h"

#include <chrono>
#include <cstdio>
#include <utility>

#include "engine/math/state_text.h"
#include "engine/run/simulation_parts.h"

namespace cprsim {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

std::string short_number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

Simulation::Simulation(Scene scene, std::unique_ptr<FreeBodies> free_bodies,
                       const RodMaker& make_rods) {
  const auto begin = Clock::now();
  parts_ = std::make_unique<Parts>(std::move(scene), std::move(free_bodies), make_rods);
  parts_->equations.set_instant(0, true, StageRates{});  // what acts on rods is a fact, too
  parts_->facts = problem_facts(parts_->robot, parts_->equations, parts_->plan);
  parts_->statistics.build_seconds = seconds_since(begin);
}

Simulation::~Simulation() = default;

const ProblemFacts& Simulation::facts() const {
  return parts_->facts;
}

void Simulation::measure(PhaseClock* clock) {
  parts_->robot.clock = clock;
}

bool Simulation::Parts::start(const RobotUnknowns* neighbour) {
  const auto begin_time = Clock::now();
  const bool equilibrium =
      scene.simulation.mode != Mode::kDynamic || scene.simulation.initial_static;
  const bool near = neighbour && equilibrium && !free_only() && follow(*neighbour);
  if (!near && !free_only() &&
      (!(equilibrium ? find_equilibrium() : assemble()) || !starts_clear())) {
    observe(0, seconds_since(begin_time));
    return false;
  }
  begin();
  statistics.start_seconds = seconds_since(begin_time);
  observe(0, statistics.start_seconds);
  before = now;
  return near;
}

/// The initial shape is found: from here on time runs.
void Simulation::Parts::begin() {
  if (!free_only()) start_motion();
  // equilibria at the start know no friction: which of many would it be?
  if (scene.simulation.mode != Mode::kStatic) {
    for (Joint& joint : robot.joints)
      joint.engage_friction();
    for (RobotRod& rod : robot.rods)
      rod.model->engage_friction();
  }
  statistics.start_iterations = std::exchange(statistics.iterations, 0);
  statistics.max_iterations = 0;
  ledger.open();
  started = true;
  if (end <= 0) status = RunStatus::kDone;
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

bool Simulation::start_beside(const RobotUnknowns& neighbour) {
  Parts& p = *parts_;
  const RobotUnknowns own = p.equations.unknowns();
  if (!p.move_beside(neighbour)) {
    p.equations.set_unknowns(own);
    return false;
  }
  p.begin();
  p.observe(0, 0);
  p.before = p.now;
  return true;
}

void Simulation::retrace(std::vector<double> instants) {
  parts_->course = std::move(instants);
}

std::shared_ptr<const RobotUnknowns> Simulation::unknowns() const {
  return std::make_shared<RobotUnknowns>(parts_->equations.unknowns());
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
  } else if (p.plan.scheme.kind == SchemeKind::kIda) {
    p.step_by_ida();
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
  archive(cushioned);
  contacts.visit(archive);
  archive(now.solver.iterations);
  archive(now.solver.residual);
  archive(now.solver.step);
  if (!archive.reading()) return;
  before = take_snapshot(robot, nullptr, t);
  if (contacts.any()) add_rod_contacts(before.contact);
  before.energy = ledger.sample();
  before.solver = now.solver;
  now = before;
  status = t < end ? RunStatus::kRunning : RunStatus::kDone;
}

bool Simulation::has_visitable_state() const {
  return parts_->free_bodies == nullptr && parts_->plan.scheme.kind != SchemeKind::kIda;
}

void Simulation::visit(Archive& archive) {
  if (!has_visitable_state())
    throw StateError(
        "bodies in free flight or steps by ida: what their collisions or ida remember cannot be "
        "saved");
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

const Robot& Simulation::robot() const {
  return parts_->robot;
}

Failure Simulation::failure_kind() const {
  return parts_->failure_kind;
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
