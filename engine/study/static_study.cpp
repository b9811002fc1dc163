// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/static_study.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "engine/run/observation.h"
#include "engine/run/touching_solve.h"
#include "engine/solve/newton.h"

namespace cprsim {
namespace {

constexpr int kIterations = 40;
constexpr int kSmallestPart = 1024;  // a change is taken in at most so many steps

Profile constant(double value) {
  ProfileTerm term;
  term.value = value;
  Profile profile;
  profile.terms.push_back(term);
  return profile;
}

const char* unit_of(const Scene& scene, const DriveSpec& drive) {
  if (drive.quantity == DriveQuantity::kTension) return "N";
  if (drive.tendon >= 0 || drive.quantity == DriveQuantity::kLength) return "m";
  const bool length =
      slides(scene.joints[static_cast<std::size_t>(drive.joint)].kind, drive.freedom);
  if (drive.quantity == DriveQuantity::kEffort) return length ? "N" : "N m";
  return length ? "m" : "rad";
}

Parameter parameter_of(const Scene& scene, std::size_t index) {
  const DriveSpec& drive = scene.drives[index];
  Parameter p;
  p.index = static_cast<int>(index);
  p.unit = unit_of(scene, drive);
  if (drive.quantity == DriveQuantity::kLength) {
    p.name = scene.rods[static_cast<std::size_t>(drive.rod)].name + ".length";
  } else if (drive.tendon >= 0) {
    p.name = scene.tendons[static_cast<std::size_t>(drive.tendon)].name +
             (drive.quantity == DriveQuantity::kTension ? ".tension" : ".displacement");
  } else {
    p.name = scene.joints[static_cast<std::size_t>(drive.joint)].name +
             (drive.quantity == DriveQuantity::kEffort ? ".effort" : ".position");
    if (freedom_count(scene.joints[static_cast<std::size_t>(drive.joint)].kind) > 1)
      p.name += "." + std::to_string(drive.freedom + 1);
  }
  return p;
}

/// What ties do to the stability of two rods is not worked out.
void refuse_ties(const Scene& scene) {
  if (!scene.ties.empty())
    throw std::invalid_argument(
        "rods are tied in this scene, which studies of equilibria do not see: simulate it");
}

/// Where rods touch obstacles, equilibria depend on how they are reached.
void refuse_contacts(const Scene& scene) {
  Robot robot = build_robot(scene);
  if (RodContacts(robot).any())
    throw std::invalid_argument(
        "rods may touch obstacles in this scene, which studies of equilibria do not see: simulate "
        "it, or leave contact out of its effects");
}

}  // namespace

StaticStudy::StaticStudy(Scene scene, double at, const std::vector<ProbeWrench>& probes,
                         bool touching)
    : scene_(std::make_unique<Scene>(std::move(scene))),
      tolerance_(scene_->solver.residual_tolerance.value_or(1e-10)) {
  refuse_ties(*scene_);
  if (!touching) refuse_contacts(*scene_);
  for (DriveSpec& drive : scene_->drives) {
    // a velocity drive says nothing about where a joint rests: it holds the scene's own position
    const bool velocity = drive.quantity == DriveQuantity::kVelocity;
    drive.profile = constant(velocity ? 0 : drive.profile.evaluate(at, true).value);
    if (velocity) drive.quantity = DriveQuantity::kPosition;
  }
  for (LoadSpec& load : scene_->loads) {
    if (!load.has_profile) continue;
    const double factor = load.profile.evaluate(at, true).value;
    load.force *= factor;
    load.torque *= factor;
    load.has_profile = false;
  }
  for (MagneticFieldSpec& field : scene_->magnetic_fields) {
    if (!field.has_profile) continue;
    const double factor = field.profile.evaluate(at, true).value;
    field.uniform *= factor;
    field.moment *= factor;
    field.has_profile = false;
  }
  for (RodSpec& rod : scene_->rods) {
    if (!rod.temperature || !rod.temperature->has_profile) continue;
    const double factor = rod.temperature->profile.evaluate(at, true).value;
    rod.temperature->rise *= factor;
    rod.temperature->gradient *= factor;
    rod.temperature->has_profile = false;
  }
  first_probe_ = scene_->loads.size();
  for (const ProbeWrench& probe : probes) {
    LoadSpec load;
    load.at = probe.at;
    load.force = probe.force;
    load.torque = probe.torque;
    scene_->loads.push_back(load);
  }
  scene_->simulation.mode = Mode::kStatic;
  for (std::size_t i = 0; i < scene_->drives.size(); ++i)
    drives_.push_back(parameter_of(*scene_, i));
  contacts_given_ = touching;
  build();
}

void StaticStudy::build() {
  equations_.reset();
  contacts_.reset();
  robot_ = std::make_unique<Robot>(build_robot(*scene_));
  if (contacts_given_) contacts_ = std::make_unique<RodContacts>(*robot_);
  equations_ = std::make_unique<Equations>(*robot_, tolerance_);
  prepare();
  equations_->mark_start();
}

void StaticStudy::prepare() {
  equations_->set_instant(0, true, StageRates{});
}

std::vector<Parameter> StaticStudy::probe(std::size_t i) const {
  static constexpr const char* kAxes[] = {"x", "y", "z"};
  std::vector<Parameter> all;
  for (const auto kind : {Parameter::Kind::kForce, Parameter::Kind::kTorque})
    for (int c = 0; c < 3; ++c) {
      const bool force = kind == Parameter::Kind::kForce;
      all.push_back({kind, static_cast<int>(first_probe_ + i), c,
                     std::string(force ? "force." : "torque.") + kAxes[c], force ? "N" : "N m"});
    }
  return all;
}

double StaticStudy::value(const Parameter& p) const {
  const auto index = static_cast<std::size_t>(p.index);
  if (p.kind == Parameter::Kind::kDrive) return scene_->drives[index].profile.evaluate(0).value;
  const LoadSpec& load = scene_->loads[index];
  return (p.kind == Parameter::Kind::kForce ? load.force : load.torque)[p.component];
}

void StaticStudy::set(const Parameter& p, double value) {
  const auto index = static_cast<std::size_t>(p.index);
  if (p.kind == Parameter::Kind::kDrive) {
    scene_->drives[index].profile.terms.front().value = value;
    return;
  }
  LoadSpec& load = scene_->loads[index];
  (p.kind == Parameter::Kind::kForce ? load.force : load.torque)[p.component] = value;
}

// One Newton step more than the tolerance asks for: differences of solutions are taken.
SolveReport StaticStudy::polish() {
  SolveOptions options;
  options.tolerance = tolerance_;
  options.max_iterations = kIterations;
  options.polish = true;
  return newton(*equations_, options);
}

// As a run in mode static finds it.
SolveReport StaticStudy::touch() {
  SolveOptions options;
  options.tolerance = tolerance_;
  options.max_iterations = kIterations;
  options.most_work = equations_->work() + kMostStaticWork;
  const bool shaped = std::any_of(scene_->rods.begin(), scene_->rods.end(),
                                  [](const RodSpec& rod) { return !rod.start.empty(); });
  SolveReport report =
      shaped ? hold_shape(*equations_, options) : load_gradually(*contacts_, *equations_, options);
  if (shaped && report.converged()) report = relax_from_shape(*contacts_, *equations_, options);
  if (!report.converged()) return report;
  const std::string overlap = contacts_->overlap();
  if (overlap.empty()) return report;
  report.status = SolveStatus::kStalled;
  report.worst_row = overlap;
  return report;
}

SolveReport StaticStudy::solve() {
  build();
  if (touches()) return touch();
  SolveOptions options;
  options.tolerance = tolerance_;
  options.max_iterations = kIterations;
  options.most_work = equations_->work() + kMostStaticWork;
  SolveReport report = solve_statics(*equations_, options);
  has_solved_ = report.converged();
  if (!has_solved_) return report;
  const SolveReport polished = polish();
  report.residual = std::min(report.residual, polished.residual);
  report.iterations += polished.iterations;
  solved_ = state();
  return report;
}

SolveReport StaticStudy::follow() {
  if (!has_solved_) return solve();
  const State target = state();
  SolveReport report;
  int iterations = 0;
  // parts of the way that are done, in units of 1 / kSmallestPart
  int done = 0, part = kSmallestPart;
  State from = solved_;
  while (done < kSmallestPart) {
    const double fraction = static_cast<double>(done + part) / kSmallestPart;
    State next = target;
    next.unknowns = solved_.unknowns;
    for (std::size_t i = 0; i < next.drives.size(); ++i)
      next.drives[i] = from.drives[i] + fraction * (target.drives[i] - from.drives[i]);
    for (std::size_t i = 0; i < next.forces.size(); ++i) {
      next.forces[i] = from.forces[i] + fraction * (target.forces[i] - from.forces[i]);
      next.torques[i] = from.torques[i] + fraction * (target.torques[i] - from.torques[i]);
    }
    restore(next);
    report = polish();
    iterations += report.iterations;
    if (report.converged()) {
      solved_ = state();
      done += part;
      part = std::min(2 * part, kSmallestPart - done);
      continue;
    }
    part /= 2;
    if (part == 0) {
      restore(solved_);
      break;
    }
  }
  report.iterations = iterations;
  return report;
}

bool StaticStudy::step() {
  prepare();
  equations_->evaluate();
  if (!equations_->find_direction(0)) return false;
  equations_->keep();
  equations_->move(1);
  equations_->evaluate();
  return true;
}

StaticStudy::State StaticStudy::state() const {
  State s;
  s.unknowns = equations_->unknowns();
  for (const Parameter& p : drives_)
    s.drives.push_back(value(p));
  for (const LoadSpec& load : scene_->loads) {
    s.forces.push_back(load.force);
    s.torques.push_back(load.torque);
  }
  return s;
}

void StaticStudy::restore(const State& s) {
  for (std::size_t i = 0; i < drives_.size(); ++i)
    set(drives_[i], s.drives[i]);
  for (std::size_t i = 0; i < s.forces.size(); ++i) {
    scene_->loads[i].force = s.forces[i];
    scene_->loads[i].torque = s.torques[i];
  }
  prepare();
  equations_->set_unknowns(s.unknowns);
  equations_->evaluate();
}

void StaticStudy::adopt() {
  solved_ = state();
  has_solved_ = true;
}

void StaticStudy::adopt(const State& equilibrium) {
  restore(equilibrium);
  solved_ = equilibrium;
  has_solved_ = true;
}

Snapshot StaticStudy::snapshot() const {
  Snapshot now = take_snapshot(*robot_, nullptr, 0);
  if (touches()) now.contact = contacts_->sample();
  return now;
}

}  // namespace cprsim
