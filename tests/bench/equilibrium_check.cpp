// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/equilibrium_check.h"

#include <algorithm>

#include "engine/math/so3.h"

namespace cprsim {
namespace {

/// Force and moment about a body's centre of mass, per Newton body.
class Balance {
 public:
  explicit Balance(const Robot& robot)
      : robot_(robot), force_(robot.bodies.size(), Vec3::Zero()), moment_(force_) {}

  void add(int body, const Vec3& at, const Vec3& force, const Vec3& moment) {
    if (body < 0) return;
    const auto b = static_cast<std::size_t>(body);
    force_[b] += force;
    moment_[b] += moment + (at - robot_.bodies[b].p).cross(force);
  }

  double worst() const {
    double worst = 0;
    for (std::size_t b = 0; b < force_.size(); ++b)
      worst = std::max({worst, force_[b].norm() / robot_.scale.force,
                        moment_[b].norm() / robot_.scale.moment()});
    return worst;
  }

 private:
  const Robot& robot_;
  std::vector<Vec3> force_, moment_;
};

void add_weights(const Robot& robot, Balance& balance) {
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const BodySpec& spec = robot.scene->bodies[i];
    if (robot.links[i].body < 0 || !spec.gravity) continue;
    const Pose X = robot.link_pose(i);
    balance.add(robot.links[i].body, X.p + X.R * spec.com, spec.mass * robot.gravity, Vec3::Zero());
  }
}

void add_loads(const Robot& robot, Balance& balance) {
  for (const BodyLoad& load : robot.body_loads) {
    const PointLoad now = load_at(*load.spec, 0, true);
    const Pose X = robot.pose_of(load.at);
    const Mat3 axes = now.follower ? X.R : Mat3(Mat3::Identity());
    balance.add(load.at.body, X.p, axes * now.force, axes * now.torque);
  }
}

/// @return worst effort along the freedom of a joint that nothing drives and no spring holds
double add_joints(const Robot& robot, Balance& balance, EquilibriumCheck& check) {
  double worst = 0;
  for (const Joint& joint : robot.joints) {
    const auto link = [&](int i) {
      return i < 0 ? Pose{} : robot.link_pose(static_cast<std::size_t>(i));
    };
    const Pose P = link(joint.spec->parent) * joint.spec->X_PJ;
    const Pose C = link(joint.spec->child) * joint.spec->X_CJ;
    const Vec3 moment = joint.lambda.head<3>(), force = joint.lambda.tail<3>();
    balance.add(joint.child, C.p, force, moment);
    balance.add(joint.parent, C.p, -force, -moment);
    const Vec3 axis = P.R * joint.spec->axis;
    const Vec3 apart = C.p - P.p;
    if (joint.freedoms.size() != 1) continue;  // freedoms beside each other are not looked into
    const Joint::Freedom& freedom = joint.freedoms.front();
    const bool slides = joint.spec->kind == JointKind::kPrismatic;
    const bool screws = joint.spec->kind == JointKind::kScrew;
    const Vec3 across = slides || screws ? Vec3(apart - apart.dot(axis) * axis) : apart;
    check.gap = std::max(check.gap, across.norm() / robot.scale.length);
    if (freedom.unknown < 0 || freedom.effort != 0 || joint.spec->spring_stiffness != 0 || screws)
      continue;
    worst = std::max(worst, slides ? std::abs(axis.dot(force)) / robot.scale.force
                                   : std::abs(axis.dot(moment)) / robot.scale.moment());
  }
  return worst;
}

void check_end(const Robot& robot, const RodEndSpec& spec, const Attachment& at,
               const RodPoint& point, EquilibriumCheck& check) {
  const Pose X = robot.pose_of(at);
  check.gap = std::max(check.gap, (point.position - X.p).norm() / robot.scale.length);
  if (spec.joint != EndJoint::kFixed) return;
  const double tilt = point.rotation.col(2).cross(X.R.col(2)).norm();
  const double turn = spec.spin_free ? 0 : log_so3(X.R.transpose() * point.rotation).norm();
  check.gap = std::max({check.gap, tilt, turn});
}

/// @return worst resultant on a rod as a whole
double add_rod(const Robot& robot, const RobotRod& rod, const RodSample& sample, Balance& balance,
               EquilibriumCheck& check) {
  const RodPoint &base = sample.points.front(), &tip = sample.points.back();
  if (rod.base_held) {
    balance.add(rod.base.body, base.position, base.force, base.moment);
    check_end(robot, rod.spec->base, rod.base, base, check);
  }
  if (rod.tip_held) {
    balance.add(rod.tip.body, tip.position, -tip.force, -tip.moment);
    check_end(robot, rod.spec->tip, rod.tip, tip, check);
  }
  if (!rod.loads.empty()) return 0;
  const Vec3 weight =
      rod.gravity ? Vec3(rod.section.rhoA * sample.length * robot.gravity) : Vec3(Vec3::Zero());
  const double force = (tip.force - base.force + weight).norm() / robot.scale.force;
  if (!weight.isZero()) return force;  // where the weight acts is known only to the drawn points
  const Vec3 moment = tip.moment - base.moment + (tip.position - base.position).cross(tip.force);
  return std::max(force, moment.norm() / robot.scale.moment());
}

}  // namespace

EquilibriumCheck check_equilibrium(const StaticStudy& study) {
  const Robot& robot = study.robot();
  EquilibriumCheck check;
  Balance balance(robot);
  add_weights(robot, balance);
  add_loads(robot, balance);
  double others = add_joints(robot, balance, check);
  for (const RobotRod& rod : robot.rods)
    others = std::max(others, add_rod(robot, rod, rod.model->observe(), balance, check));
  check.imbalance = std::max(balance.worst(), others);
  return check;
}

}  // namespace cprsim
