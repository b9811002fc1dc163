// SPDX-License-Identifier: BSD-3-Clause
// The residual side: drives and loads at an instant, rows, unknowns.
#include "engine/robot/equations.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/so3.h"
#include "engine/model/flight.h"
#include "engine/robot/rod_between.h"
#include "engine/solve/phase_clock.h"

namespace cprsim {

Equations::~Equations() = default;

Equations::Equations(Robot& robot, double tolerance) : robot_(robot), tolerance_(tolerance) {
  const std::size_t n = robot.bodies.size();
  wrench_.assign(n, Vec6::Zero());
  body_tangent_.assign(n, Mat6::Zero());
  condensed_.resize(robot.rods.size());
  eliminations_.resize(robot.rods.size());
  joint_gap_.assign(robot.joints.size(), Vec6::Zero());
  set_plane();
  body_unknowns_ = freedoms_ * static_cast<int>(n);
  int offset = body_unknowns_;
  for (const Joint& joint : robot.joints) {
    joint_offset_.push_back(offset);
    offset += unknowns_of(joint);
  }
  size_ = offset;
  loops_ = robot.has_joint_loops();
  note_bodies();
  const std::vector<char> among_rods = bodies_among_rods(*robot.scene);
  for (const RigidBody& body : robot.bodies)
    flies_.push_back(among_rods[static_cast<std::size_t>(body.links.front())]);
}

PointLoad Equations::scaled_load(const LoadSpec& load) const {
  PointLoad at = load_at(load, t_, before_);
  at.force *= acting();
  at.torque *= acting();
  return at;
}

void Equations::prepare_rods() {
  for (RobotRod& rod : robot_.rods) {
    RodForcing& forcing = rod.forcing;
    if (rod.length_drive) rod.length = rod.length_drive->evaluate(t_, before_).value;
    forcing.length = rod.length;
    forcing.gravity = rod.gravity ? Vec3(acting() * robot_.gravity) : Vec3(Vec3::Zero());
    forcing.wind = acting() * robot_.scene->wind;
    forcing.loads.clear();
    for (const LoadSpec* load : rod.loads)
      forcing.loads.push_back(scaled_load(*load));
    forcing.lines.clear();
    for (const LoadSpec* load : rod.line_loads) {
      LineLoad line = line_load_at(*load, t_, before_);
      line.force *= acting();
      line.torque *= acting();
      line.law.strength *= acting();
      forcing.lines.push_back(line);
    }
    if (rod.magnetic) forcing.field = sources_at(*robot_.scene, t_, before_, acting());
    if (rod.heated) {
      forcing.heat = thermal_strain_at(*rod.spec, t_, before_);
      forcing.heat.curvature *= acting();
      forcing.heat.stretch *= acting();
    }
    if (!rod.breaks.empty() || !rod.tendons.empty()) pull_tendons(rod, t_, before_, acting());
    forcing.tolerance = tolerance_;
    forcing.axial_softness = softness_;
    forcing.relaxation = drag_ * rod.section.K_bt.head<2>().maxCoeff() / std::pow(rod.length, 4);
    rod.model->prepare(rates_, forcing);
  }
}

void Equations::set_instant(double t, bool before, const StageRates& rates) {
  t_ = t;
  before_ = before;
  rates_ = rates;
  for (const JointDrive& drive : robot_.joint_drives)
    drive_joint(drive);
  prepare_rods();
}

void Equations::drive_joint(const JointDrive& drive) {
  Joint& joint = robot_.joints[static_cast<std::size_t>(drive.joint)];
  const auto i = static_cast<Eigen::Index>(drive.freedom);
  Joint::Freedom& freedom = joint.freedoms[static_cast<std::size_t>(drive.freedom)];
  const Profile& profile = drive.spec->profile;
  const double value = profile.evaluate(t_, before_).value, limit = freedom.spec->effort_limit;
  switch (drive.spec->quantity) {
    case DriveQuantity::kPosition:
      joint.q[i] = value;
      break;
    case DriveQuantity::kEffort:
      freedom.effort = std::clamp(value, -limit, limit);
      break;
    case DriveQuantity::kVelocity:
      if (rates_.dynamic()) {
        joint.q[i] = (value - joint.track.x_h[i]) / rates_.c_v;
      } else if (t_ > equilibrium_time_) {
        // Simpson's rule over the step, which has no jump inside
        const double from = equilibrium_time_, h = t_ - from;
        joint.q[i] =
            joint.accepted_q()[i] + h / 6 *
                                        (profile.evaluate(from, false).value +
                                         4 * profile.evaluate(from + 0.5 * h, false).value + value);
      }
      break;
    default:  // of a rod or a tendon
      break;
  }
}

void Equations::accept_equilibrium(double t) {
  equilibrium_time_ = t;
  for (Joint& joint : robot_.joints)
    joint.accept(body_pose(joint.parent), body_pose(joint.child));
  if (robot_.rods_meet || !robot_.probes.empty()) note_bodies();
}

void Equations::accept_contacts() {
  for (RobotRod& rod : robot_.rods)
    if (TouchingRod* side = rod.model->touching()) side->accept_contacts();
  note_bodies();
}

void Equations::note_bodies() {
  slip_from_.clear();
  for (const RigidBody& body : robot_.bodies)
    slip_from_.push_back(body.pose());
}

void Equations::set_fraction(double fraction) {
  if (fraction < 1 && !gaps_captured_) {
    for (RobotRod& rod : robot_.rods)
      rod.model->capture_gap(robot_.port(rod.base), robot_.port(rod.tip));
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      const Joint& joint = robot_.joints[j];
      joint_gap_[j] = joint
                          .rows(body_pose(joint.parent), body_pose(joint.child), rates_,
                                robot_.scale.length, robot_.scale.moment(), robot_.scale.force)
                          .closure;
    }
    // the rows are those of whatever state was looked at last
    if (!robot_.scene->ties.empty()) evaluate();
    tie_gap_.clear();
    for (const Pair& pair : pairs_)
      if (is_tie(pair)) tie_gap_.push_back(pair.rows.value);
    gaps_captured_ = true;
  }
  fraction_ = fraction;
  for (RobotRod& rod : robot_.rods)
    rod.model->hold_gap(gaps_captured_ ? 1 - fraction : 0);
  prepare_rods();
}

void Equations::set_relaxation(double drag) {
  drag_ = drag;
  marked_.clear();
  for (const RigidBody& body : robot_.bodies)
    marked_.push_back(body.pose());
  for (RobotRod& rod : robot_.rods)
    rod.model->mark_positions();
  prepare_rods();
}

double Equations::limpness() const {
  double limp = 1;
  for (const RobotRod& rod : robot_.rods) {
    const double weight = rod.section.weighing_mass() * robot_.gravity.norm();
    limp = std::max(limp, weight * std::pow(rod.length, 3) / rod.section.K_bt.head<2>().maxCoeff());
  }
  return limp;
}

void Equations::hold_marked(double drag) {
  drag_ = drag;
  prepare_rods();
}

void Equations::set_softness(double softness) {
  softness_ = softness;
  prepare_rods();
}

void Equations::break_symmetry() {
  for (RobotRod& rod : robot_.rods)
    if (rod.tip_held) rod.model->bow(robot_.port(rod.base), robot_.port(rod.tip));
}

bool Equations::wants_soft_start() const {
  return std::any_of(robot_.rods.begin(), robot_.rods.end(),
                     [](const RobotRod& rod) { return rod.tip_held; });
}

void Equations::restart() {
  set_unknowns(start_);
  gaps_captured_ = false;
  prepare_rods();
  evaluate();
}

std::vector<std::unique_ptr<Problem>> Equations::take_apart() {
  fraction_ = 0;  // without loads; gaps are the rods' own
  prepare_rods();
  std::vector<std::unique_ptr<Problem>> parts;
  for (RobotRod& rod : robot_.rods)
    if (rod.tip_held)
      parts.push_back(std::make_unique<RodBetween>(*this, work_alone_, robot_, rod, rates_));
  return parts;
}

void Equations::put_together() {
  fraction_ = 1;
  prepare_rods();
}

void Equations::note(double value, Worst where, ProblemResidual& r) {
  r.merit += 0.5 * value * value;
  const double size = std::abs(value);
  if (!std::isfinite(value)) r.finite = false;
  if (size <= r.largest && std::isfinite(value)) return;
  r.largest = std::isfinite(value) ? size : std::numeric_limits<double>::infinity();
  worst_ = where;
}

// Newton-Euler: everything that acts, minus what inertia takes; tangents of what is not rods or
// joints.
Vec6 Equations::body_rows(std::size_t b) {
  RigidBody& body = robot_.bodies[b];
  Vec6 rows = Vec6::Zero();
  Mat6& tangent = body_tangent_[b];
  tangent.setZero();
  const RigidBody::Inertial weight = body.weight(acting() * robot_.gravity);
  rows += weight.wrench;
  tangent += weight.by_motion;
  if (rates_.dynamic()) {
    const RigidBody::Inertial inertial = body.inertial(rates_);
    rows -= inertial.wrench;
    tangent -= inertial.by_motion;
  }
  if (drag_ > 0) {
    const double k = drag_ * robot_.scale.force / robot_.scale.length,
                 k_turn = drag_ * robot_.scale.moment();
    const Vec3 turned = log_so3(body.R * marked_[b].R.transpose());
    rows.head<3>() -= k_turn * turned;
    rows.tail<3>() -= k * (body.p - marked_[b].p);
    tangent.topLeftCorner<3, 3>() -= k_turn * right_jacobian_inverse(-turned);
    tangent.bottomRightCorner<3, 3>() -= k * Mat3::Identity();
  }
  return rows;
}

void Equations::add_body_loads() {
  for (const BodyLoad& load : robot_.body_loads) {
    const auto b = static_cast<std::size_t>(load.at.body);
    const RigidBody& body = robot_.bodies[b];
    const Pose X = body.pose() * load.at.X;
    const PointLoad now = scaled_load(*load.spec);
    const Mat3 axes = now.follower ? X.R : Mat3(Mat3::Identity());
    const Vec3 F = axes * now.force, M = axes * now.torque, arm = X.p - body.p;
    wrench_[b].head<3>() += M + arm.cross(F);
    wrench_[b].tail<3>() += F;
    // d(arm × F) = (phi × arm) × F, and with the axes dF = phi × F
    body_tangent_[b].topLeftCorner<3, 3>() += hat(F) * hat(arm);
    if (!now.follower) continue;
    body_tangent_[b].topLeftCorner<3, 3>() -= hat(M) + hat(arm) * hat(F);
    body_tangent_[b].bottomLeftCorner<3, 3>() -= hat(F);
  }
}

void Equations::add_rod_wrenches() {
  for (const RobotRod& rod : robot_.rods) {
    if (rod.base_held && rod.base.body >= 0)
      wrench_[static_cast<std::size_t>(rod.base.body)] +=
          rod.model->wrench_on_base(robot_.port(rod.base));
    if (rod.tip_held && rod.tip.body >= 0)
      wrench_[static_cast<std::size_t>(rod.tip.body)] +=
          rod.model->wrench_on_tip(robot_.port(rod.tip));
  }
}

void Equations::add_joint_wrenches() {
  for (const Joint& joint : robot_.joints) {
    const Joint::Wrenches w = joint.wrenches(body_pose(joint.parent), body_pose(joint.child));
    if (joint.parent >= 0) wrench_[static_cast<std::size_t>(joint.parent)] += w.on_parent;
    if (joint.child >= 0) wrench_[static_cast<std::size_t>(joint.child)] += w.on_child;
  }
}

ProblemResidual Equations::evaluate() {
  ProblemResidual r;
  evaluate_rods(r);
  if (robot_.rods_meet) find_pairs();
  const PhaseTimer timer(robot_.clock, Phase::kSystem);
  evaluate_bodies(r);
  evaluate_joints(r);
  return r;
}

void Equations::evaluate_rods(ProblemResidual& r) {
  const PhaseTimer timer(robot_.clock, Phase::kSections);
  for (std::size_t i = 0; i < robot_.rods.size(); ++i) {
    const RobotRod& rod = robot_.rods[i];
    const RodResidual own = rod.model->evaluate(robot_.port(rod.base), robot_.port(rod.tip));
    r.merit += 0.5 * own.sum_squares;
    r.finite = r.finite && own.finite;
    if (own.largest > r.largest) {
      r.largest = own.largest;
      worst_ = {Worst::Kind::kRod, static_cast<int>(i), own.worst_row};
    }
  }
}

void Equations::evaluate_bodies(ProblemResidual& r) {
  for (std::size_t b = 0; b < wrench_.size(); ++b)
    wrench_[b] = body_rows(b);
  if (robot_.rods_meet) evaluate_pairs(r);
  if (!robot_.probes.empty()) evaluate_body_contacts(r);
  add_body_loads();
  add_rod_wrenches();
  add_joint_wrenches();
  for (std::size_t b = 0; b < wrench_.size(); ++b)
    if (stands_still(b)) wrench_[b].setZero();
  if (bodies_held_) return;
  // inertia turns position round-off into forces, see ShootingRod::prepare
  constexpr double kRoundOff = 50 * std::numeric_limits<double>::epsilon();
  const RobotScale& unit = robot_.scale;
  for (std::size_t b = 0; b < wrench_.size(); ++b) {
    const double stiffness = robot_.bodies[b].mass * rates_.c_v * rates_.c_w;
    const double noise =
        std::max(1.0, kRoundOff * stiffness * unit.length / (unit.force * tolerance_));
    Vec6 scaled = wrench_[b];
    scaled.head<3>() /= noise * unit.moment();
    scaled.tail<3>() /= noise * unit.force;
    note_rows(Mat3::Identity(), scaled, {Worst::Kind::kBody, static_cast<int>(b), 0}, r);
  }
}

void Equations::evaluate_joints(ProblemResidual& r) {
  for (std::size_t j = 0; j < robot_.joints.size() && !bodies_held_; ++j) {
    const Joint& joint = robot_.joints[j];
    const Joint::Rows rows =
        joint.rows(body_pose(joint.parent), body_pose(joint.child), rates_, robot_.scale.length,
                   robot_.scale.moment(), robot_.scale.force);
    const double open = gaps_captured_ ? 1 - fraction_ : 0;
    const Vec6 closure = rows.closure - open * joint_gap_[j];
    note_rows(rows.axes, closure, {Worst::Kind::kJoint, static_cast<int>(j), 0}, r);
    for (std::size_t k = 0; k < joint.freedoms.size(); ++k)
      if (joint.freedoms[k].unknown >= 0)
        note(rows.effort[static_cast<Eigen::Index>(k)],
             {Worst::Kind::kJoint, static_cast<int>(j), 6 + static_cast<int>(k)}, r);
  }
}

}  // namespace cprsim
