// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/path_system.h"

#include <cmath>
#include <stdexcept>

#include "engine/math/linear_solve.h"
#include "engine/math/so3.h"

namespace cprsim {
namespace {

constexpr double kSmallDifference = 1e-7;  // of y, in its units: of single Newton steps
constexpr double kLargestDifference = 1e-4, kLeastDifference = 1e-13;
constexpr int kCorrections = 10;
constexpr double kRows = 1e-11;        // of the goal, in units in which 1 is large
constexpr double kPlane = 1e-9;        // of the arclength row: where on the path matters little
constexpr double kFarthest = 0.5;      // a correction longer than this part of the step is refused
constexpr double kLeastPivot = 1e-15;  // smallest pivot of the small system

}  // namespace

PathProblem along_line(const StaticStudy& study, const std::vector<Parameter>& parameters,
                       const VecX& from, const VecX& to) {
  PathProblem p;
  p.start = VecX::Zero(1);
  const VecX way = (to - from).cwiseQuotient(parameter_units(study, parameters));
  p.units = VecX::Constant(1, 1 / std::max(way.norm(), 1e-12));
  p.apply = [parameters, from, to](StaticStudy& e, const VecX& y) {
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      e.set(parameters[i], from[k] + y[0] * (to[k] - from[k]));
    }
  };
  p.rows = [](const StaticStudy&, const VecX&) { return VecX(0); };
  return p;
}

PathProblem along_pose(const StaticStudy& study, const std::vector<Parameter>& parameters,
                       const PoseGoal& from, const PoseGoal& to) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  const auto asked = static_cast<std::size_t>(n);
  std::size_t count = 0;
  for (const bool one : from.asked)
    count += one ? 1 : 0;
  if (count != asked)
    throw std::invalid_argument("a path of " + std::to_string(count) +
                                " prescribed freedoms needs " + std::to_string(count) +
                                " drives, the scene has " + std::to_string(asked));
  const double length = study.robot().scale.length;
  PathProblem p;
  p.free_drives = true;
  p.start = VecX::Zero(n + 1);
  p.units = VecX::Ones(n + 1);
  p.units.head(n) = parameter_units(study, parameters);
  for (Eigen::Index i = 0; i < n; ++i)
    p.start[i] = study.value(parameters[static_cast<std::size_t>(i)]);
  const double way =
      std::hypot((to.position - from.position).norm() / length, (to.angles - from.angles).norm());
  p.units[n] = 1 / std::max(way, 1e-12);
  p.apply = [parameters](StaticStudy& e, const VecX& y) {
    for (std::size_t i = 0; i < parameters.size(); ++i)
      e.set(parameters[i], y[static_cast<Eigen::Index>(i)]);
  };
  p.rows = [from, to, length, n](const StaticStudy& e, const VecX& y) {
    PoseGoal now = from;
    now.position += y[n] * (to.position - from.position);
    now.angles += y[n] * (to.angles - from.angles);
    return reach(now, length)(e);
  };
  return p;
}

PathSystem::PathSystem(StaticStudy& study, PathProblem problem)
    : study_(study), problem_(std::move(problem)) {}

VecX PathSystem::motion(const RobotUnknowns& x, const RobotUnknowns& reference) const {
  const Robot& robot = study_.robot();
  const double L = robot.scale.length;
  std::size_t nodes = 0, joints = 0;
  for (const auto& rod : x.rods)
    nodes += rod.nodes.size();
  for (const Joint& joint : robot.joints)
    joints += static_cast<std::size_t>(joint.unknown_coordinates());
  VecX u(static_cast<Eigen::Index>(6 * x.bodies.size() + joints + 3 * nodes));
  Eigen::Index at = 0;
  for (std::size_t b = 0; b < x.bodies.size(); ++b, at += 6) {
    u.segment<3>(at) = log_so3(x.bodies[b].R * reference.bodies[b].R.transpose());
    u.segment<3>(at + 3) = (x.bodies[b].p - reference.bodies[b].p) / L;
  }
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const Vec3 moved = x.joint_q[j] - reference.joint_q[j];
    const std::vector<Joint::Freedom>& freedoms = robot.joints[j].freedoms;
    for (std::size_t k = 0; k < freedoms.size(); ++k)
      if (freedoms[k].unknown >= 0)
        u[at++] = moved[static_cast<Eigen::Index>(k)] / (freedoms[k].measured_as_length() ? L : 1);
  }
  const double weight = nodes > 0 ? 1 / (L * std::sqrt(static_cast<double>(nodes))) : 0;
  for (std::size_t r = 0; r < x.rods.size(); ++r)
    for (std::size_t k = 0; k < x.rods[r].nodes.size(); ++k, at += 3)
      for (int c = 0; c < 3; ++c)
        u[at + c] = weight * (x.rods[r].nodes[k].p[c] - reference.rods[r].nodes[k].p[c]);
  return u;
}

PathDirection PathSystem::forward() const {
  const RobotUnknowns x = study_.state().unknowns;
  PathDirection d{VecX::Zero(motion(x, x).size()), VecX::Zero(problem_.size())};
  d.y[d.y.size() - 1] = 1;
  return d;
}

void PathSystem::put(const StaticStudy::State& shape, const VecX& y) {
  study_.restore(shape);
  problem_.apply(study_, y);
  study_.restore(study_.state());
}

bool PathSystem::linearize(const VecX& y, PathStation& at) {
  const StaticStudy::State here = study_.state();
  at.y = y;
  at.state = here;
  at.sides.clear();
  side_rows_.clear();
  at.differences.resize(y.size());
  if (!study_.step()) return false;
  at.sides.push_back(study_.state().unknowns);
  side_rows_.push_back(problem_.rows(study_, y));
  const StaticStudy::State moved = study_.state();
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    // lambda of a prescribed pose moves no part of the robot
    const bool acts = !(problem_.free_drives && i + 1 == y.size());
    for (double part = kSmallDifference;;) {
      VecX side = y;
      side[i] += part * problem_.units[i];
      at.differences[i] = side[i] - y[i];
      put(acts ? here : moved, side);
      if (acts && !study_.step()) return false;
      at.sides.resize(static_cast<std::size_t>(i + 1));
      side_rows_.resize(static_cast<std::size_t>(i + 1));
      at.sides.push_back(study_.state().unknowns);
      side_rows_.push_back(problem_.rows(study_, side));
      // near singular points little changes much: differences stay where motions add
      const double moves = motion(at.sides.back(), at.sides.front()).norm();
      if (!std::isfinite(moves)) return false;
      if (moves <= kLargestDifference || part < kLeastDifference) break;
      part *= std::max(0.1 * kLargestDifference / moves, 1e-3);
    }
  }
  study_.restore(moved);
  problem_.apply(study_, y);
  return true;
}

// Rows in dy: goal, then arclength.
bool PathSystem::solve_small(const PathStation& at, const StaticStudy::State& origin,
                             const VecX& origin_y, const PathDirection& normal, double sigma,
                             VecX& dy) const {
  const Eigen::Index n = problem_.size();
  const VecX u0 = motion(at.sides[0], origin.unknowns);
  MatX A(n, n);
  VecX b(n);
  b.head(n - 1) = side_rows_[0];
  b[n - 1] =
      normal.u.dot(u0) + normal.y.dot((at.y - origin_y).cwiseQuotient(problem_.units)) - sigma;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i + 1);
    const double h = at.differences[i] / problem_.units[i];
    const VecX du = (motion(at.sides[k], origin.unknowns) - u0) / h;
    A.col(i).head(n - 1) = (side_rows_[k] - side_rows_[0]) / h;
    A(n - 1, i) = normal.u.dot(du) + normal.y[i];
  }
  if (!solve_square(A, -b, kLeastPivot, dy) || !dy.allFinite()) return false;
  dy = dy.cwiseProduct(problem_.units);
  return true;
}

bool PathSystem::find_tangent(PathStation& at, const PathDirection& along) const {
  VecX dy;
  // from x_0 the goal is met: ask for unit progress along the old direction
  const Eigen::Index n = problem_.size();
  StaticStudy::State origin = at.state;
  origin.unknowns = at.sides[0];
  if (!solve_small(at, origin, at.y, along, 1, dy)) return false;
  at.tangent.y = dy.cwiseQuotient(problem_.units);
  at.tangent.u = VecX::Zero(along.u.size());
  for (Eigen::Index i = 0; i < n; ++i)
    at.tangent.u +=
        dy[i] / at.differences[i] * motion(at.sides[static_cast<std::size_t>(i + 1)], at.sides[0]);
  const double norm = std::sqrt(at.tangent.dot(at.tangent));
  at.tangent.u /= norm;
  at.tangent.y /= norm;
  return std::isfinite(norm);
}

/// The study where the linearisation says after a change of y.
void PathSystem::place(const PathStation& at, const VecX& dy) {
  std::vector<const RobotUnknowns*> past;
  std::vector<double> weights;
  double rest = 1;
  for (const RobotUnknowns& side : at.sides)
    past.push_back(&side);
  weights.push_back(1);
  for (Eigen::Index i = 0; i < dy.size(); ++i) {
    weights.push_back(dy[i] / at.differences[i]);
    rest -= weights.back();
  }
  weights[0] = rest;
  study_.equations().predict(past, weights);
  put(study_.state(), at.y + dy);
}

bool PathSystem::correct(const StaticStudy::State& origin, const VecX& origin_y,
                         const PathDirection& normal, double sigma, VecX y,
                         const PathDirection& along, PathStation& to) {
  put(study_.state(), y);
  for (iterations_ = 0; iterations_ < kCorrections; ++iterations_) {
    const ProblemResidual r = study_.equations().evaluate();
    if (!r.finite) return false;
    const VecX g = problem_.rows(study_, y);
    const double plane = normal.u.dot(motion(study_.state().unknowns, origin.unknowns)) +
                         normal.y.dot((y - origin_y).cwiseQuotient(problem_.units)) - sigma;
    const bool there = r.largest <= study_.tolerance() && std::abs(plane) <= kPlane &&
                       (g.size() == 0 || g.cwiseAbs().maxCoeff() <= kRows);
    const StaticStudy::State before = study_.state();
    if (!linearize(y, to)) return false;
    VecX dy;
    const bool regular = solve_small(to, origin, origin_y, normal, sigma, dy);
    if (!there) {
      if (!regular) return false;
      place(to, dy);
      y += dy;
      continue;
    }
    // one step more than was asked, unless the point is so singular that it would only add noise
    to.state = before;
    if (regular) {
      place(to, dy);
      const ProblemResidual polished = study_.equations().evaluate();
      if (polished.finite && polished.largest <= r.largest) {
        to.state = study_.state();
        to.y = y + dy;
      }
    }
    study_.restore(to.state);
    return find_tangent(to, along);
  }
  return false;
}

bool PathSystem::advance(const PathStation& from, double sigma, PathStation& to) {
  const VecX dy = sigma * from.tangent.y.cwiseProduct(problem_.units);
  study_.restore(from.state);
  place(from, dy);
  const VecX expected = motion(study_.state().unknowns, from.state.unknowns);
  if (!correct(from.state, from.y, from.tangent, sigma, from.y + dy, from.tangent, to))
    return false;
  const VecX missed = motion(to.state.unknowns, from.state.unknowns) - expected;
  const VecX missed_y = (to.y - from.y - dy).cwiseQuotient(problem_.units);
  to.s = from.s + sigma;
  return std::hypot(missed.norm(), missed_y.norm()) <= kFarthest * std::abs(sigma);
}

double PathSystem::distance(const PathStation& from, const PathStation& to) const {
  return from.tangent.u.dot(motion(to.state.unknowns, from.state.unknowns)) +
         from.tangent.y.dot((to.y - from.y).cwiseQuotient(problem_.units));
}

bool PathSystem::interpolate(const PathStation& from, double sigma,
                             const std::vector<const PathStation*>& near, PathStation& to) {
  std::vector<const RobotUnknowns*> known;
  std::vector<double> at, weights;
  VecX y = VecX::Zero(from.y.size());
  for (const PathStation* station : near) {
    known.push_back(&station->state.unknowns);
    at.push_back(distance(from, *station));
  }
  for (std::size_t i = 0; i < near.size(); ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < near.size(); ++j)
      if (j != i) weight *= (sigma - at[j]) / (at[i] - at[j]);
    weights.push_back(weight);
    y += weight * near[i]->y;
  }
  study_.restore(near.front()->state);
  study_.equations().predict(known, weights);
  to.s = from.s + sigma;
  return correct(from.state, from.y, from.tangent, sigma, y, from.tangent, to);
}

}  // namespace cprsim
