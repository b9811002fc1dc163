// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/identify_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/run/observe.h"
#include "scenes/loader/load.h"
#include "tools/cprsim/build_simulation.h"
#include "tools/sinks/csv.h"

namespace cprsim {

namespace {

// Equilibria are linearised, and runs along one course of steps smooth to rounding.
constexpr double kEquilibriumStep = 1e-5, kCourseStep = 1e-4;

// Where steps are chosen anew, each choice moves the answer by about the tolerance.
constexpr double kChosenStep = 1e-3;

}  // namespace

SceneFit::SceneFit(const Study& study)
    : study_(study), step_(kEquilibriumStep), centre_(study.rows.size()), last_(study.rows.size()) {
  const auto n = static_cast<Eigen::Index>(study.values.size());
  low_.resize(n);
  high_.resize(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const FitParameter& p = study.values[static_cast<std::size_t>(j)].parameter;
    low_[j] = std::isfinite(p.low) ? p.coordinate(p.low) : -1e300;
    high_[j] = std::isfinite(p.high) ? p.coordinate(p.high) : 1e300;
  }
  if (!study.dynamic()) return;
  // ida's steps are its own, and what touches decides anew
  const auto scene = scene_at(start(), study.rows.front());
  chooses_steps_ =
      scene && (scene->solver.scheme == SchemeKind::kIda || scene->effects.has(Effect::kContact) ||
                scene->effects.has(Effect::kSelfContact));
  step_ = chooses_steps_ ? kChosenStep : kCourseStep;
}

VecX SceneFit::start() const {
  return VecX::Ones(static_cast<Eigen::Index>(study_.values.size()));
}

bool SceneFit::refuse(std::size_t row, const std::string& why) {
  const std::string place = study_.dynamic()
                                ? study_.table.path
                                : fmt::format("{}:{}", study_.table.path, study_.table.lines[row]);
  failure_ = place + ": " + why;
  return false;
}

std::unique_ptr<Scene> SceneFit::scene_at(const VecX& z, std::size_t row) {
  LoadOptions load = study_.load;
  std::string values;
  for (std::size_t j = 0; j < study_.values.size(); ++j) {
    const FittedValue& value = study_.values[j];
    const std::string text = shortest(value.parameter.value(z[static_cast<Eigen::Index>(j)]));
    for (const std::string& path : value.paths)
      load.set.emplace_back(path, text);
    values += fmt::format("{}{} = {}", values.empty() ? "" : ", ", value.parameter.name, text);
  }
  for (const InputColumn& input : study_.inputs)
    load.set.emplace_back(input.path, shortest(input.values[row]));
  LoadResult result = load_scene_text(study_.scene_text, study_.scene_name, load);
  scene_refused_ = result.scene == nullptr;
  if (scene_refused_) {
    const auto error =
        std::find_if(result.diagnostics.begin(), result.diagnostics.end(),
                     [](const Diagnostic& d) { return d.severity == Severity::kError; });
    refuse(row,
           fmt::format(
               "the scene with {} is invalid: {}", values,
               error == result.diagnostics.end() ? "" : "[" + error->code + "] " + error->message));
    return nullptr;
  }
  if (!study_.dynamic()) result.scene->simulation.mode = Mode::kStatic;
  return std::move(result.scene);
}

std::unique_ptr<Simulation> SceneFit::simulate(const Scene& scene, const State& near,
                                               bool& followed) {
  auto simulation = build_simulation(scene);
  ++simulations_;
  followed = false;
  if (near)
    simulation->start_near(*near, &followed);
  else
    simulation->start();
  return simulation;
}

/// The derivative's run: from the equilibrium at z to first order, then along the course of z.
std::unique_ptr<Simulation> SceneFit::simulate_beside(const Scene& scene, const State& near) {
  const bool equilibrium =
      scene.simulation.mode != Mode::kDynamic || scene.simulation.initial_static;
  auto simulation = build_simulation(scene);
  ++simulations_;
  if (equilibrium && near && simulation->start_beside(*near)) {
    if (!chooses_steps_) simulation->retrace(course_);
    return simulation;
  }
  bool followed = false;
  simulation = simulate(scene, near, followed);
  if (!chooses_steps_) simulation->retrace(course_);
  return simulation;
}

bool SceneFit::solve_row(const VecX& z, std::size_t k, std::size_t& cell, VecX& computed) {
  const std::size_t row = study_.rows[k];
  const auto scene = scene_at(z, row);
  if (!scene) return false;
  bool followed = false;
  auto simulation =
      beside_ ? simulate_beside(*scene, last_[k]) : simulate(*scene, centre_[k], followed);
  if (!beside_ && !followed && simulation->status() != RunStatus::kFailed) {
    // sought from the scene's own start: once more from there, for the extra step
    restarts_ += centre_[k] ? 1 : 0;
    simulation = simulate(*scene, simulation->unknowns(), followed);
  }
  if (simulation->status() == RunStatus::kFailed) return refuse(row, simulation->failure());
  if (!beside_) last_[k] = simulation->unknowns();
  for (; cell < study_.cells.size() && study_.cells[cell].row == row; ++cell) {
    const Channel& channel = study_.matches[study_.cells[cell].match].channel;
    computed[static_cast<Eigen::Index>(cell)] = evaluate(channel, *scene, simulation->now());
  }
  return true;
}

bool SceneFit::solve_rows(const VecX& z, VecX& computed) {
  std::size_t cell = 0;
  for (std::size_t k = 0; k < study_.rows.size(); ++k)
    if (!solve_row(z, k, cell, computed)) return false;
  return true;
}

bool SceneFit::run_record(const VecX& z, VecX& computed) {
  const auto scene = scene_at(z, study_.rows.front());
  if (!scene) return false;
  bool followed = false;
  const auto simulation = beside_ ? simulate_beside(*scene, last_.front())
                                  : simulate(*scene, centre_.front(), followed);
  if (simulation->status() == RunStatus::kFailed)
    return refuse(study_.rows.front(), simulation->failure());
  std::vector<double> course;
  State first = beside_ ? last_.front() : simulation->unknowns();
  std::vector<Channel> channels;
  for (const MatchedColumn& match : study_.matches)
    channels.push_back(match.channel);
  ChannelReader reader(*scene, channels);
  std::size_t cell = 0;
  const double end = simulation->end_time();
  while (cell < study_.cells.size()) {
    const double t = std::min(study_.times[study_.cells[cell].row], end);
    while (simulation->time() < t && simulation->status() == RunStatus::kRunning) {
      simulation->advance();
      course.push_back(simulation->time());
    }
    if (simulation->time() < t) return refuse(study_.rows.front(), simulation->failure());
    const std::vector<double>& values =
        reader.read(interpolate(simulation->before(), simulation->now(), t));
    for (const std::size_t row = study_.cells[cell].row;
         cell < study_.cells.size() && study_.cells[cell].row == row; ++cell)
      computed[static_cast<Eigen::Index>(cell)] = values[study_.cells[cell].match];
  }
  if (beside_) return true;
  last_.front() = std::move(first);
  course_ = std::move(course);
  return true;
}

bool SceneFit::compute(const VecX& z, VecX& computed) {
  try {
    return study_.dynamic() ? run_record(z, computed) : solve_rows(z, computed);
  } catch (const std::invalid_argument& error) {
    // what the engine cannot build at all
    scene_refused_ = true;
    return refuse(study_.rows.front(), error.what());
  }
}

bool SceneFit::residuals(const VecX& z, VecX& r) {
  const std::size_t count = study_.cells.size();
  VecX values(static_cast<Eigen::Index>(count));
  if (!beside_) last_z_.resize(0);  // a search that fails half way leaves solutions of two places
  if (!compute(z, values)) return false;
  r.resize(values.size());
  for (std::size_t i = 0; i < count; ++i) {
    const double sigma = study_.matches[study_.cells[i].match].sigma.value_or(1);
    const auto k = static_cast<Eigen::Index>(i);
    r[k] = (values[k] - study_.cells[i].value) / sigma;
  }
  if (!beside_) last_z_ = z;
  return true;
}

bool SceneFit::derivative(const VecX& z, const VecX& r, MatX& J) {
  return derivative(z, r, step_, J);
}

bool SceneFit::derivative(const VecX& z, const VecX& r, double step, MatX& J) {
  if (last_z_.size() != z.size() || last_z_ != z) {
    VecX again;
    if (!residuals(z, again)) return false;
  }
  centre_ = last_;
  beside_ = true;
  const bool found = difference_jacobian(*this, z, r, step, low_, high_, J);
  beside_ = false;
  return found;
}

VecX SceneFit::computed(const VecX& r) const {
  VecX values(r.size());
  for (Eigen::Index k = 0; k < r.size(); ++k) {
    const MeasuredCell& cell = study_.cells[static_cast<std::size_t>(k)];
    values[k] = cell.value + r[k] * study_.matches[cell.match].sigma.value_or(1);
  }
  return values;
}

}  // namespace cprsim
