// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/inverse.h"

#include <algorithm>
#include <cmath>

#include "engine/math/linear_solve.h"
#include "engine/math/so3.h"
#include "engine/run/observe.h"

namespace cprsim {
namespace {

constexpr double kDifference = 1e-5;   // in units of the parameter
constexpr double kLargestStep = 0.25;  // likewise
constexpr double kDependent = 1e-10;   // directions weaker than this are not used
constexpr double kSmallestPart = 1.0 / 256;

Mat3 rotation_of_angles(const Vec3& a) {
  return exp_so3({0, 0, a.z()}) * exp_so3({0, a.y(), 0}) * exp_so3({a.x(), 0, 0});
}

double wrapped(double angle) {
  return std::remainder(angle, 2 * std::acos(-1.0));
}

void shift(StaticStudy& e, const std::vector<Parameter>& parameters, const VecX& change) {
  for (std::size_t i = 0; i < parameters.size(); ++i)
    e.set(parameters[i], e.value(parameters[i]) + change[static_cast<Eigen::Index>(i)]);
}

double largest(const VecX& rows) {
  return rows.size() > 0 ? rows.cwiseAbs().maxCoeff() : 0;
}

}  // namespace

Pose pose_of(const StaticStudy& study, const FrameRef& frame) {
  if (frame.body == kWorld) return frame.X_BF;
  return study.robot().link_pose(static_cast<std::size_t>(frame.body)) * frame.X_BF;
}

Vec3 angles_of(const Mat3& R) {
  return {std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))),
          std::atan2(R(1, 0), R(0, 0))};
}

Goal reach(const PoseGoal& goal, double length) {
  return [goal, length](const StaticStudy& e) {
    const Pose X = pose_of(e, goal.at);
    std::vector<double> rows;
    for (int i = 0; i < 3; ++i)
      if (goal.asked[static_cast<std::size_t>(i)])
        rows.push_back((X.p[i] - goal.position[i]) / length);
    const bool whole = goal.asked[3] && goal.asked[4] && goal.asked[5];
    const Vec3 turned = whole ? log_so3(X.R * rotation_of_angles(goal.angles).transpose())
                              : Vec3(angles_of(X.R) - goal.angles);
    for (int i = 0; i < 3; ++i)
      if (goal.asked[static_cast<std::size_t>(3 + i)])
        rows.push_back(whole ? turned[i] : wrapped(turned[i]));
    return VecX(Eigen::Map<const VecX>(rows.data(), static_cast<Eigen::Index>(rows.size())));
  };
}

Goal match(const std::vector<ChannelGoal>& goals) {
  return [goals](const StaticStudy& e) {
    const Snapshot now = e.snapshot();
    VecX rows(static_cast<Eigen::Index>(goals.size()));
    for (std::size_t i = 0; i < goals.size(); ++i)
      rows[static_cast<Eigen::Index>(i)] =
          (evaluate(goals[i].channel, e.scene(), now) - goals[i].value) / goals[i].unit;
    return rows;
  };
}

Goal both(std::vector<Goal> goals) {
  return [goals = std::move(goals)](const StaticStudy& e) {
    VecX all(0);
    for (const Goal& goal : goals) {
      const VecX rows = goal(e);
      const Eigen::Index before = all.size();
      all.conservativeResize(before + rows.size());
      all.tail(rows.size()) = rows;
    }
    return all;
  };
}

VecX parameter_units(const StaticStudy& e, const std::vector<Parameter>& parameters) {
  VecX units(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::string& unit = parameters[i].unit;
    const RobotScale& scale = e.robot().scale;
    units[static_cast<Eigen::Index>(i)] = unit == "m"     ? scale.length
                                          : unit == "N"   ? scale.force
                                          : unit == "N m" ? scale.moment()
                                                          : 1;
  }
  return units;
}

bool goal_jacobian(StaticStudy& e, const std::vector<Parameter>& parameters, const VecX& units,
                   const Goal& goal, MatX& jacobian) {
  const StaticStudy::State here = e.state();
  jacobian.resize(goal(e).size(), units.size());
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const double start = e.value(parameters[i]);
    VecX side[2];
    for (int k = 0; k < 2; ++k) {
      e.set(parameters[i], start + (k == 0 ? -1 : 1) * kDifference * units[column]);
      if (!e.step()) {
        e.restore(here);
        return false;
      }
      side[k] = goal(e);
      e.restore(here);
    }
    jacobian.col(column) = (side[1] - side[0]) / (2 * kDifference);
  }
  return true;
}

namespace {

/// One part of the way: rows are to become `wanted`.
class Approach {
 public:
  Approach(StaticStudy& e, const std::vector<Parameter>& parameters, const Goal& goal,
           const InverseOptions& options, InverseReport& report)
      : e_(e),
        parameters_(parameters),
        goal_(goal),
        options_(options),
        report_(report),
        units_(parameter_units(e, parameters)) {}

  /// @param tolerance of the rows. @return whether they are met; otherwise the state is the
  /// nearest.
  bool to(const VecX& wanted, double tolerance) {
    VecX rows = goal_(e_) - wanted;
    while (largest(rows) > tolerance) {
      if (++report_.iterations > options_.max_iterations) {
        report_.why = "the iteration limit is reached";
        return false;
      }
      MatX J;
      if (!goal_jacobian(e_, parameters_, units_, goal_, J)) {
        report_.why = "the equilibrium is singular";
        return false;
      }
      VecX change = -least_norm_solution(J, rows, kDependent);
      const double size = largest(change);
      if (size > kLargestStep) change *= kLargestStep / size;
      const double gain = (J * change).norm();
      // what the free parameters cannot change any more: a least-squares solution
      if (gain <= 1e-3 * tolerance) return largest(rows) <= tolerance;
      if (!advance(change.cwiseProduct(units_), wanted, rows)) return false;
    }
    return true;
  }

 private:
  /// A step, halved until the rows shrink. Near round-off they need not.
  bool advance(VecX change, const VecX& wanted, VecX& rows) {
    const StaticStudy::State here = e_.state();
    for (int halvings = 0; halvings < 8; ++halvings, change *= 0.5) {
      shift(e_, parameters_, change);
      report_.solve = e_.follow();
      if (report_.solve.converged()) {
        const VecX trial = goal_(e_) - wanted;
        if (trial.norm() < (1 - 1e-4) * rows.norm()) {
          rows = trial;
          return true;
        }
      }
      e_.adopt(here);
    }
    report_.why = report_.solve.converged()
                      ? "no change of the free parameters brings the robot nearer"
                      : "no equilibrium was found on the way";
    return false;
  }

  StaticStudy& e_;
  const std::vector<Parameter>& parameters_;
  const Goal& goal_;
  const InverseOptions& options_;
  InverseReport& report_;
  VecX units_;
};

}  // namespace

InverseReport solve_inverse(StaticStudy& e, const std::vector<Parameter>& parameters,
                            const Goal& goal, const InverseOptions& options) {
  InverseReport report;
  report.solve = e.follow();
  if (!report.solve.converged()) {
    report.why = "there is no equilibrium to begin with";
    return report;
  }
  const VecX start = goal(e);
  Approach approach(e, parameters, goal, options, report);
  double done = 0, part = 1;
  StaticStudy::State here = e.state();
  while (done < 1) {
    const double next = std::min(1.0, done + part);
    const bool last = next >= 1;
    if (approach.to((1 - next) * start, last ? options.tolerance : 1e-6)) {
      done = next;
      part = std::min(2 * part, 1 - done);
      here = e.state();
      continue;
    }
    // round-off, or a least-squares solution, may be all there is
    if (last && largest(goal(e)) <= 100 * options.tolerance) break;
    part *= 0.5;
    if (part < kSmallestPart || report.iterations > options.max_iterations) break;
    e.adopt(here);
  }
  report.residual = largest(goal(e));
  report.reached = report.residual <= 100 * options.tolerance;
  if (report.reached) report.why.clear();
  MatX J;
  if (goal_jacobian(e, parameters, parameter_units(e, parameters), goal, J))
    report.weakest = conditioning(J);
  return report;
}

}  // namespace cprsim
