// SPDX-License-Identifier: BSD-3-Clause
#include "engine/run/marcher.h"

#include <algorithm>
#include <cmath>

#include "engine/robot/contacts.h"
#include "engine/run/ledger.h"
#include "engine/run/touching_solve.h"

namespace cprsim {
namespace {

constexpr std::size_t kPastKept = 4;  // solutions the predictor may look back on
constexpr double kLargestWeights =
    12;  // sum of |weights|: beyond, extrapolation amplifies more than it predicts

// of lengths and of a radian: less is round-off
constexpr double kRoundTolerance = 1e-11;

// Between stick and slip Newton's method goes from kink to kink.
constexpr int kTouchingPatience = 3;

/// Lagrange weights of the given times at t.
std::vector<double> lagrange(const std::vector<double>& times, double t) {
  std::vector<double> w(times.size(), 1);
  for (std::size_t i = 0; i < times.size(); ++i)
    for (std::size_t j = 0; j < times.size(); ++j)
      if (j != i) w[i] *= (t - times[j]) / (times[i] - times[j]);
  return w;
}

double sum_of_sizes(const std::vector<double>& w) {
  double sum = 0;
  for (double x : w)
    sum += std::abs(x);
  return sum;
}

}  // namespace

Marcher::Marcher(Robot& robot, Equations& equations, const SchemeChoice& scheme,
                 const SolveOptions& options, RodContacts& contacts)
    : robot_(robot),
      equations_(equations),
      options_(options),
      contacts_(contacts),
      stepper_(scheme),
      tracks_(robot.tracks()) {}

void Marcher::begin() {
  stepper_.reset();
  past_.clear();
  past_accepted_ = 0;
}

void Marcher::restart() {
  begin();
}

void Marcher::cushion(bool on) {
  stepper_.cushion(on);
  begin();
}

// The guess for a solve: the past solutions, extrapolated with as many of them as stays harmless.
void Marcher::predict(double time) {
  for (const Solved& solved : past_)
    if (stepper_.round() > 0 && std::abs(solved.time - time) <= 1e-9 * h_) {
      equations_.set_unknowns(solved.unknowns);
      return;
    }
  for (std::size_t count = std::min(past_.size(), kPastKept); count > 1; --count) {
    std::vector<double> times;
    std::vector<const RobotUnknowns*> unknowns;
    for (std::size_t i = past_.size() - count; i < past_.size(); ++i) {
      times.push_back(past_[i].time);
      unknowns.push_back(&past_[i].unknowns);
    }
    bool distinct = true;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < i; ++j)
        distinct = distinct && std::abs(times[i] - times[j]) > 1e-3 * h_;
    if (!distinct) continue;
    const std::vector<double> weights = lagrange(times, time);
    if (sum_of_sizes(weights) > kLargestWeights) continue;
    equations_.predict(unknowns, weights);
    return;
  }
  if (!past_.empty()) equations_.set_unknowns(past_.back().unknowns);
}

SolveOptions Marcher::patient() const {
  SolveOptions options = options_;
  if (contacts_.any() && contacts_.touching()) options.max_iterations *= kTouchingPatience;
  return options;
}

// Newton from the prediction; failing that, from where the step began, where rods touch also with
// full steps, and with what slips held; failing that, Levenberg-Marquardt.
SolveReport Marcher::solve_once(double time) {
  predict(time);
  if (contacts_.any()) contacts_.refresh();
  const SolveOptions patient = this->patient();
  SolveReport report = newton(equations_, patient);
  const auto again = [&](SolveReport (*solve)(Problem&, const SolveOptions&),
                         const SolveOptions& options) {
    const int spent = report.iterations;
    report = solve(equations_, options);
    report.iterations += spent;
  };
  const auto set_out = [&] {
    equations_.set_unknowns(start_);
    if (contacts_.any()) contacts_.refresh();
  };
  if (report.converged()) return report;
  set_out();
  again(newton, patient);
  if (!report.converged() && contacts_.touching()) {
    set_out();
    if (contacts_.ease()) again(newton, patient);
    if (report.converged()) return report;
    SolveOptions bold = options_;
    bold.bold = true;
    set_out();
    contacts_.ease();
    again(newton, bold);
    if (report.converged()) return report;
    set_out();
    if (contacts_.hold()) again(newton, patient);
  }
  if (report.converged()) return report;
  set_out();
  again(levenberg_marquardt, options_);
  return report;
}

SolveReport Marcher::solve_stage(double time) {
  const SolveReport first = solve_once(time);
  return contacts_.any() ? settle_contacts(contacts_, equations_, patient(), first) : first;
}

void Marcher::fill_tracks() {
  for (RigidBody& body : robot_.bodies)
    body.fill_tracks(rates_);
  for (Joint& joint : robot_.joints)
    joint.fill_tracks(robot_.body_pose(joint.parent), robot_.body_pose(joint.child), rates_);
  for (RobotRod& rod : robot_.rods)
    rod.model->fill_tracks();
}

void Marcher::finish_stage(int i) {
  fill_tracks();
  stepper_.finish_stage(i, tracks_);
}

SolveReport Marcher::solve_at(double time, const StageRates& rates) {
  rates_ = rates;
  h_ = time - past_.back().time;
  start_ = past_.back().unknowns;
  equations_.set_instant(time, true, rates_);
  const SolveReport report = solve_stage(time);
  if (report.converged())
    fill_tracks();
  else
    equations_.set_unknowns(start_);
  return report;
}

void Marcher::keep(double time) {
  past_.push_back({time, equations_.unknowns()});
  while (past_.size() > kPastKept)
    past_.pop_front();
  loss_ = loss_after_ = -1;
}

std::vector<TrackError> Marcher::track_errors() const {
  std::vector<TrackError> errors(tracks_.size());
  const auto count = [&](const Track& track, Eigen::Index coordinates, double unit) {
    for (std::size_t i = 0; i < tracks_.size(); ++i)
      if (tracks_[i] == &track) errors[i] = {coordinates, unit};
  };
  for (const RigidBody& body : robot_.bodies) {
    count(body.position, 3, robot_.scale.length);
    count(body.rotation, 3, 1);
  }
  for (const RobotRod& rod : robot_.rods)
    count(*rod.model->tracks().front(), rod.model->position_coordinates(), rod.length);
  return errors;
}

Marcher::Outcome Marcher::attempt(double t, double h, const EnergyLedger& ledger) {
  Outcome out;
  h_ = h;
  start_ = equations_.unknowns();
  const bool touchable = contacts_.any();
  if (touchable) contacts_.begin_step();
  if (past_.empty()) past_.push_back({t, start_});
  past_accepted_ = past_.size();
  const int stages = stepper_.begin_step(h, tracks_);
  if (loss_ < 0) loss_ = ledger.damping_power();
  std::vector<double> losses{loss_}, works{ledger.drive_power(t, false)};
  for (int i = 0; i < stages; ++i) {
    rates_ = stepper_.begin_stage(i, tracks_);
    const double time = t + stepper_.stage_time(i) * h;
    // the end of a step may be a jump: the step itself sees what was before
    equations_.set_instant(time, true, rates_);
    if (touchable) contacts_.begin_stage(time - t);
    SolveReport report = solve_stage(time);
    report.iterations += out.report.iterations;
    report.evaluations += out.report.evaluations;
    report.factorizations += out.report.factorizations;
    report.residual = std::max(report.residual, out.report.residual);
    out.report = report;
    if (!report.converged()) return out;
    finish_stage(i);
    out.touched = out.touched || (touchable && contacts_.changed());
    out.struck = out.struck || (touchable && contacts_.struck());
    const int round = stepper_.round(), last = i + 1 == stages;
    if (round > 0 && i % round == 0 && i > 0) {
      // what the round before found is what this one replaces
      losses.resize(1);
      works.resize(1);
    }
    const std::size_t place = past_accepted_ + static_cast<std::size_t>(round > 0 ? i % round : i);
    if (past_.size() > place)
      past_[place] = {time, equations_.unknowns()};
    else
      past_.push_back({time, equations_.unknowns()});
    losses.push_back(ledger.damping_power());
    works.push_back(ledger.drive_power(time, true));
    if (round == 0 || (i + 1) % round != 0) continue;
    if (round_change() <= kRoundTolerance) break;
    if (last) {
      out.report.status = SolveStatus::kIterationLimit;
      return out;
    }
  }
  out.converged = true;
  loss_after_ = losses.back();
  out.leapt = touchable && contacts_.leapt();
  out.error = error_estimate();
  out.damping_loss = stepper_.integrate(losses) * h;
  out.drive_work = stepper_.integrate(works) * h;
  return out;
}

// Of a round of stages: what it changed, per length or radian.
double Marcher::round_change() const {
  double change = 0;
  const std::vector<TrackError> errors = track_errors();
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (errors[i].coordinates > 0)
      change =
          std::max(change, stepper_.change(*tracks_[i], errors[i].coordinates) / errors[i].unit);
  return change;
}

// Largest estimated error of a position (per length), a rotation, and of what velocities would add
// over the step.
double Marcher::error_estimate() const {
  if (!stepper_.has_error_estimate()) return 0;
  double error = 0;
  const std::vector<TrackError> errors = track_errors();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const auto [n, unit] = errors[i];
    if (n == 0) continue;
    const Track& track = *tracks_[i];
    error = std::max(error, stepper_.position_error(track).head(n).cwiseAbs().maxCoeff() / unit);
    error =
        std::max(error, h_ * stepper_.velocity_error(track).head(n).cwiseAbs().maxCoeff() / unit);
  }
  return error;
}

void Marcher::visit(Archive& archive) {
  stepper_.visit(archive);
  archive(h_);
  archive(loss_);
  const std::size_t count = archive.count(past_.size(), kPastKept);
  if (archive.reading()) past_.assign(count, {0, equations_.unknowns()});
  for (Solved& solved : past_) {
    archive(solved.time);
    cprsim::visit(solved.unknowns, archive);
    if (archive.reading()) equations_.expect_contacts(solved.unknowns);
  }
}

void Marcher::accept() {
  stepper_.accept(tracks_);
  loss_ = loss_after_;
  for (RigidBody& body : robot_.bodies)
    body.accept_tracks();
  for (Joint& joint : robot_.joints)
    joint.accept(robot_.body_pose(joint.parent), robot_.body_pose(joint.child));
  for (RobotRod& rod : robot_.rods)
    rod.model->accept_tracks();
  while (past_.size() > kPastKept)
    past_.pop_front();
}

void Marcher::reject() {
  past_.resize(past_accepted_);
  equations_.set_unknowns(start_);
}

}  // namespace cprsim
