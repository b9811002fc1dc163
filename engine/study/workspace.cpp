// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/workspace.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <random>
#include <stdexcept>
#include <thread>

namespace cprsim {
namespace {

constexpr double kLimitTolerance = 1e-9;  // relative: a grid's end lies on its limit

double grid_value(const WorkspaceAxis& axis, int i) {
  if (axis.count <= 1) return 0.5 * (axis.low + axis.high);
  const double fraction = static_cast<double>(i) / (axis.count - 1);
  return (1 - fraction) * axis.low + fraction * axis.high;
}

/// 53 random bits as a number in [0, 1): std::uniform_real_distribution may differ by library.
double uniform(std::mt19937& random) {
  const auto high = static_cast<double>(random() >> 5U), low = static_cast<double>(random() >> 6U);
  return (high * 67108864.0 + low) / 9007199254740992.0;
}

double slack(double limit) {
  return kLimitTolerance * std::max(1.0, std::abs(limit));
}

std::string sentence(const SolveReport& report) {
  return std::string("no equilibrium found (") + to_string(report.status) + ", last tried " +
         to_string(report.stage) + "; worst row: " + report.worst_row + ")";
}

}  // namespace

std::vector<std::vector<double>> grid_points(const std::vector<WorkspaceAxis>& axes) {
  std::vector<std::vector<double>> points{{}};
  for (const WorkspaceAxis& axis : axes) {
    std::vector<std::vector<double>> longer;
    longer.reserve(points.size() * static_cast<std::size_t>(std::max(axis.count, 1)));
    for (const std::vector<double>& point : points)
      for (int i = 0; i < std::max(axis.count, 1); ++i) {
        longer.push_back(point);
        longer.back().push_back(grid_value(axis, i));
      }
    points = std::move(longer);
  }
  return points;
}

std::vector<std::vector<double>> random_points(const std::vector<WorkspaceAxis>& axes,
                                               std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::vector<double>> points(count);
  for (std::vector<double>& point : points)
    for (const WorkspaceAxis& axis : axes)
      point.push_back(axis.low + (axis.high - axis.low) * uniform(random));
  return points;
}

std::vector<double> drive_efforts(const StaticStudy& study) {
  const Robot& robot = study.robot();
  std::vector<double> efforts;
  for (const DriveSpec& drive : study.scene().drives) {
    double effort = 0;
    if (drive.quantity == DriveQuantity::kEffort) {
      effort = drive.profile.evaluate(0).value;
    } else if (drive.tendon >= 0) {
      for (const RobotRod& rod : robot.rods)
        for (std::size_t k = 0; k < rod.tendons.size(); ++k)
          if (rod.tendons[k].index == drive.tendon) effort = rod.model->tendons()[k].tension;
    } else if (drive.quantity == DriveQuantity::kLength) {
      effort = robot.rods[static_cast<std::size_t>(drive.rod)].model->energy().feed_power;
    } else if (const int index = robot.joint_of_spec[static_cast<std::size_t>(drive.joint)];
               index >= 0) {
      const Joint& joint = robot.joints[static_cast<std::size_t>(index)];
      const auto k = static_cast<Eigen::Index>(drive.freedom);
      const Joint::Freedom& freedom = joint.freedoms[static_cast<std::size_t>(drive.freedom)];
      // springs and stops take their part
      effort =
          joint.observe(robot.body_pose(joint.parent), robot.body_pose(joint.child)).effort[k] -
          freedom.law.total(*freedom.spec, joint.q[k], 0).value;
    }
    efforts.push_back(effort);
  }
  return efforts;
}

WorkspaceSolver::WorkspaceSolver(const Scene& scene, const WorkspaceQuestion& question)
    : question_(question), study_(scene) {
  home_ = study_.state();
  if (!question_.poses) return;
  at_home_ = study_.solve();
  home_ = study_.state();
  const Pose X = pose_of(study_, question_.frame);
  home_pose_ << X.p, angles_of(X.R);
}

WorkspacePoint WorkspaceSolver::solve(std::size_t index, const std::vector<double>& asked) {
  WorkspacePoint point;
  point.index = index;
  point.asked = asked;
  if (question_.poses) {
    inverse(point);
  } else {
    forward(point);
  }
  if (point.reached()) tell(point);
  return point;
}

void WorkspaceSolver::forward(WorkspacePoint& point) {
  for (std::size_t i = 0; i < point.asked.size(); ++i)
    study_.set(study_.drives()[static_cast<std::size_t>(question_.axes[i].drive)], point.asked[i]);
  const SolveReport report = study_.solve();
  point.stage = report.stage;
  point.iterations = report.iterations;
  point.residual = report.residual;
  if (report.converged()) {
    point.origin = PointOrigin::kForward;
  } else {
    point.why = sentence(report);
  }
}

void WorkspaceSolver::inverse(WorkspacePoint& point) {
  if (!at_home_.converged()) {
    point.residual = at_home_.residual;
    point.why = "the scene's own drives: " + sentence(at_home_);
    return;
  }
  study_.adopt(home_);
  PoseGoal goal;
  goal.at = question_.frame;
  Vec6 pose = home_pose_;
  for (std::size_t f = 0; f < 6; ++f) {
    goal.asked[f] = question_.others[f].held;
    if (question_.others[f].at) pose[static_cast<Eigen::Index>(f)] = *question_.others[f].at;
  }
  for (std::size_t i = 0; i < point.asked.size(); ++i) {
    const int freedom = question_.axes[i].freedom;
    pose[freedom] = point.asked[i];
    goal.asked[static_cast<std::size_t>(freedom)] = true;
  }
  goal.position = pose.head<3>();
  goal.angles = pose.tail<3>();
  const InverseReport report =
      solve_inverse(study_, study_.drives(), reach(goal, study_.robot().scale.length));
  point.iterations = report.iterations;
  point.residual = report.solve.residual;
  point.why = report.why;
  if (!report.reached) {
    if (point.why.empty()) point.why = "the drives do not bring the frame there";
    return;
  }
  for (std::size_t i = 0; i < study_.drives().size(); ++i)
    if (study_.scene().drives[i].quantity == DriveQuantity::kLength &&
        study_.value(study_.drives()[i]) <= 0) {
      point.why = "only with a negative length of " + study_.drives()[i].name;
      return;
    }
  point.origin = PointOrigin::kInverse;
}

void WorkspaceSolver::tell(WorkspacePoint& point) {
  const Stability stability = count_unstable(study_.robot());
  point.verdict = stability.verdict;
  point.unstable = stability.unstable;
  for (const Parameter& drive : study_.drives())
    point.drives.push_back(study_.value(drive));
  point.efforts = drive_efforts(study_);
  const Pose X = pose_of(study_, question_.frame);
  point.position = X.p;
  point.angles = angles_of(X.R);
  check_limits(point);
}

void WorkspaceSolver::check_limits(WorkspacePoint& point) const {
  const Scene& scene = study_.scene();
  const Robot& robot = study_.robot();
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const JointSpec& spec = scene.joints[i];
    const int index = robot.joint_of_spec[i];
    if (index < 0) continue;
    const Joint& joint = robot.joints[static_cast<std::size_t>(index)];
    bool kept = true;
    for (std::size_t k = 0; k < joint.freedoms.size(); ++k) {
      const AxisSpec& axis = *joint.freedoms[k].spec;
      const double q = joint.q[static_cast<Eigen::Index>(k)];
      kept = kept && q >= axis.lower - slack(axis.lower) && q <= axis.upper + slack(axis.upper);
    }
    if (kept) continue;
    point.positions_kept = false;
    point.broken.push_back(spec.name + ".position");
  }
  for (std::size_t i = 0; i < scene.drives.size(); ++i) {
    const int joint = scene.drives[i].joint;
    double limit = joint >= 0 ? scene.joints[static_cast<std::size_t>(joint)].effort_limit
                              : std::numeric_limits<double>::infinity();
    if (i < question_.max_effort.size()) limit = std::min(limit, question_.max_effort[i]);
    if (std::abs(point.efforts[i]) <= limit * (1 + kLimitTolerance)) continue;
    point.efforts_kept = false;
    const std::string& name = study_.drives()[i].name;
    point.broken.push_back(name.substr(0, name.rfind('.')) + ".effort");
  }
}

void solve_points(const Scene& scene, const WorkspaceQuestion& question,
                  const std::vector<std::vector<double>>& points,
                  const std::vector<std::size_t>& indices, int jobs,
                  const std::function<void(const WorkspacePoint&)>& done,
                  const std::function<bool()>& stop) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::mutex one_at_a_time;
  std::exception_ptr complaint;
  const auto work = [&] {
    try {
      WorkspaceSolver solver(scene, question);
      while (!failed && !stop()) {
        const std::size_t k = next++;
        if (k >= indices.size()) return;
        const WorkspacePoint point = solver.solve(indices[k], points[indices[k]]);
        const std::lock_guard lock(one_at_a_time);
        done(point);
      }
    } catch (...) {
      const std::lock_guard lock(one_at_a_time);
      if (!complaint) complaint = std::current_exception();
      failed = true;
    }
  };
  const std::size_t count = std::min(static_cast<std::size_t>(std::max(jobs, 1)),
                                     std::max<std::size_t>(indices.size(), 1));
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < count; ++i)
    threads.emplace_back(work);
  work();
  for (std::thread& thread : threads)
    thread.join();
  if (complaint) std::rethrow_exception(complaint);
}

}  // namespace cprsim
