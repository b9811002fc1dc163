// SPDX-License-Identifier: BSD-3-Clause
// The linear side: condensed rods, global system, directions. Rows are J x + r = 0 with x in the
// units of column_units() and rows in those of row_units(), so that pivoting compares like with
// like.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/math/linear_solve.h"
#include "engine/robot/equations.h"

namespace cprsim {
namespace {

// Below this ratio of pivots T is treated as singular: it then holds no stiffness in some
// direction.
constexpr double kSingularPivot = 1e-10;

// Likewise for the global system, and how well its rows must then be met.
constexpr double kSingularSystem = 1e-13, kConsistent = 1e-6;

// Joints that close a loop may say the same twice (a planar four-bar thrice), up to round-off that
// elimination has magnified. Taken for a pivot it would throw the multipliers about.
constexpr double kSingularLoop = 1e-12;

}  // namespace

bool Equations::condense_rods(bool keep_all) {
  int offset = body_unknowns_;
  for (const Joint& joint : robot_.joints)
    offset += joint.unknowns();
  growth_ = 0;
  for (std::size_t i = 0; i < robot_.rods.size(); ++i) {
    RobotRod& rod = robot_.rods[i];
    CondensedRod& c = condensed_[i];
    if (!rod.model->linearize(robot_.port(rod.base), robot_.port(rod.tip), c)) return false;
    growth_ = std::max(growth_, c.growth);
    Elimination& e = eliminations_[i];
    const Eigen::PartialPivLU<Mat6> lu(c.T);
    const Vec6 pivots = lu.matrixLU().diagonal().cwiseAbs();
    e.delayed = keep_all || !(pivots.minCoeff() > kSingularPivot * pivots.maxCoeff());
    if (e.delayed) {
      e.offset = offset;
      offset += 6;
      continue;
    }
    e.offset = -1;
    e.z0 = -lu.solve(c.t);
    e.z_A.setZero();
    e.z_B.setZero();
    if (rod.base.body >= 0) e.z_A = -lu.solve(c.T_A);
    if (rod.tip_held && rod.tip.body >= 0) e.z_B = -lu.solve(c.T_B);
  }
  size_ = offset;
  return true;
}

void Equations::assemble_rod(std::size_t i) {
  const RobotRod& rod = robot_.rods[i];
  const CondensedRod& c = condensed_[i];
  const Elimination& e = eliminations_[i];
  const bool A_moves = rod.base_held && rod.base.body >= 0 && !bodies_held_;
  const bool B_moves = rod.tip_held && rod.tip.body >= 0 && !bodies_held_;
  const int a = 6 * rod.base.body, b = 6 * rod.tip.body;
  if (e.delayed) {
    J_.block<6, 6>(e.offset, e.offset) = c.T;
    r_.segment<6>(e.offset) = c.t;
    if (A_moves) {
      J_.block<6, 6>(e.offset, a) += c.T_A;
      J_.block<6, 6>(a, e.offset) = c.WA_z;
      J_.block<6, 6>(a, a) += c.WA_A;
      r_.segment<6>(a) += c.wa;
    }
    if (B_moves) {
      J_.block<6, 6>(e.offset, b) += c.T_B;
      J_.block<6, 6>(b, e.offset) += c.WB_z;
      J_.block<6, 6>(b, b) += c.WB_B;
      if (A_moves) J_.block<6, 6>(b, a) += c.WB_A;
      r_.segment<6>(b) += c.wb;
    }
    return;
  }
  if (A_moves) {
    J_.block<6, 6>(a, a) += c.WA_A + c.WA_z * e.z_A;
    if (B_moves) J_.block<6, 6>(a, b) += c.WA_z * e.z_B;
    r_.segment<6>(a) += c.wa + c.WA_z * e.z0;
  }
  if (B_moves) {
    J_.block<6, 6>(b, b) += c.WB_B + c.WB_z * e.z_B;
    if (A_moves) J_.block<6, 6>(b, a) += c.WB_A + c.WB_z * e.z_A;
    r_.segment<6>(b) += c.wb + c.WB_z * e.z0;
  }
}

void Equations::assemble_bodies() {
  for (std::size_t b = 0; b < robot_.bodies.size(); ++b) {
    const auto at = 6 * static_cast<Eigen::Index>(b);
    if (bodies_held_) {
      J_.block<6, 6>(at, at).setIdentity();
      continue;
    }
    J_.block<6, 6>(at, at) += body_tangent_[b];
    r_.segment<6>(at) += wrench_[b];
  }
  // the wrenches of rods are in wrench_ already, and came again with wa, wb
  if (bodies_held_) return;
  for (const RobotRod& rod : robot_.rods) {
    if (rod.base_held && rod.base.body >= 0)
      r_.segment<6>(6 * rod.base.body) -= rod.model->wrench_on_base(robot_.port(rod.base));
    if (rod.tip_held && rod.tip.body >= 0)
      r_.segment<6>(6 * rod.tip.body) -= rod.model->wrench_on_tip(robot_.port(rod.tip));
  }
}

void Equations::assemble_joints() {
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    const Joint& joint = robot_.joints[j];
    const Eigen::Index at = joint_offset_[j];
    if (bodies_held_) {
      J_.block(at, at, joint.unknowns(), joint.unknowns()).setIdentity();
      continue;
    }
    const Pose P = body_pose(joint.parent), C = body_pose(joint.child);
    const Joint::Rows rows =
        joint.rows(P, C, rates_, robot_.scale.length, robot_.scale.moment(), robot_.scale.force);
    const Joint::Wrenches w = joint.wrenches(P, C);
    const Eigen::Index p = 6 * joint.parent, c = 6 * joint.child;
    r_.segment<6>(at) = rows.closure - (gaps_captured_ ? 1 - fraction_ : 0) * joint_gap_[j];
    if (joint.parent >= 0) {
      J_.block<6, 6>(at, p) = rows.by_parent;
      J_.block<6, 6>(p, at) = w.parent_by_lambda;
      J_.block<6, 6>(p, p) += w.parent_by_parent;
    }
    if (joint.child >= 0) {
      J_.block<6, 6>(at, c) = rows.by_child;
      J_.block<6, 6>(c, at) = w.child_by_lambda;
      J_.block<6, 6>(c, c) += w.child_by_child;
    }
    if (joint.parent >= 0 && joint.child >= 0) J_.block<6, 6>(p, c) += w.parent_by_child;
    J_.block<6, 6>(at, at) = rows.by_lambda;
    for (std::size_t k = 0; k < joint.freedoms.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      if (joint.freedoms[k].unknown < 0) continue;
      const Eigen::Index row = at + 6 + joint.freedoms[k].unknown;
      J_.block<6, 1>(at, row) = rows.by_q.col(i);
      J_.block<1, 6>(row, at) = rows.effort_by_lambda.row(i);
      if (joint.parent >= 0) J_.block<1, 6>(row, p) = rows.effort_by_parent.row(i);
      for (std::size_t l = 0; l < joint.freedoms.size(); ++l)
        if (joint.freedoms[l].unknown >= 0)
          J_(row, at + 6 + joint.freedoms[l].unknown) =
              rows.effort_by_q(i, static_cast<Eigen::Index>(l));
      r_[row] = rows.effort[i];
    }
  }
}

void Equations::assemble() {
  J_.setZero(size_, size_);
  r_.setZero(size_);
  assemble_bodies();
  for (std::size_t i = 0; i < robot_.rods.size(); ++i)
    assemble_rod(i);
  assemble_joints();
}

// Force that moves a body by the unit of length: rods' stiffness, or its own inertia over the step.
double Equations::force_unit(int body) const {
  if (body < 0) return robot_.scale.force;
  const double inertia =
      robot_.bodies[static_cast<std::size_t>(body)].mass * rates_.c_v * rates_.c_w;
  return std::max(robot_.scale.force, inertia * robot_.scale.length);
}

VecX Equations::column_units() const {
  VecX u = VecX::Ones(size_);
  const double length = robot_.scale.length;
  for (Eigen::Index b = 0; b < body_unknowns_; b += 6)
    u.segment<3>(b + 3).setConstant(length);
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    const Joint& joint = robot_.joints[j];
    const Eigen::Index at = joint_offset_[j];
    const double force = std::max(force_unit(joint.parent), force_unit(joint.child));
    u.segment<3>(at).setConstant(force * length);
    u.segment<3>(at + 3).setConstant(force);
    for (const Joint::Freedom& freedom : joint.freedoms)
      if (freedom.unknown >= 0 && freedom.measured_as_length())
        u[at + 6 + freedom.unknown] = length;
  }
  return u;
}

VecX Equations::row_units() const {
  VecX u = VecX::Ones(size_);
  if (bodies_held_) return u;
  for (Eigen::Index b = 0; b < body_unknowns_; b += 6) {
    const double force = force_unit(static_cast<int>(b / 6));
    u.segment<3>(b).setConstant(force * robot_.scale.length);
    u.segment<3>(b + 3).setConstant(force);
  }
  // effort rows are in units of the robot's force; their multiplier's column may be larger
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    const Joint& joint = robot_.joints[j];
    const double force = std::max(force_unit(joint.parent), force_unit(joint.child));
    u.segment(joint_offset_[j] + 6, joint.unknown_coordinates())
        .setConstant(force / robot_.scale.force);
    if (joint.is_ball()) u.segment<3>(joint_offset_[j]).setConstant(force / robot_.scale.force);
  }
  return u;
}

// Something moves without resistance, like a rod that can spin between two balls. If the rows can
// be met all the same, the smallest motion that does so is as good as any.
// Multipliers that rows said twice leave open become the smallest ones: by themselves, not their
// increments, or what extrapolation in time adds to them would stay and grow.
bool Equations::solve_least_motion(const VecX& columns) {
  VecX present = VecX::Zero(size_);
  for (std::size_t j = 0; j < robot_.joints.size() && !bodies_held_; ++j)
    present.segment<6>(joint_offset_[j]) = robot_.joints[j].lambda;
  present = columns.cwiseInverse().asDiagonal() * present;
  x_ = least_norm_solution(J_, J_ * present - r_, loops_ ? kSingularLoop : kSingularSystem);
  x_ -= present;
  // rows that say the same twice do so to round-off only, which near the solution is all there is
  const double round_off = loops_ ? 0.1 * tolerance_ : 0;
  return x_.allFinite() && (J_ * x_ + r_).norm() <= kConsistent * r_.norm() + round_off;
}

bool Equations::solve(double mu) {
  x_.setZero(size_);
  predicted_merit_ = 0;
  if (size_ == 0) return true;
  const VecX columns = column_units(), rows = row_units();
  J_ = rows.cwiseInverse().asDiagonal() * J_ * columns.asDiagonal();
  r_ = rows.cwiseInverse().asDiagonal() * r_;
  if (mu == 0) {
    if (solve_square(J_, r_, loops_ ? kSingularLoop : kSingularSystem, x_)) {
      x_ = -x_;
    } else if (!solve_least_motion(columns)) {
      return false;
    }
  } else {
    MatX N = J_.transpose() * J_;
    const double floor = 1e-8 * N.diagonal().maxCoeff();
    N.diagonal() += mu * N.diagonal().cwiseMax(floor);
    x_ = -solve_symmetric(N, J_.transpose() * r_);
    // rows that were eliminated vanish in the linear model
    predicted_merit_ = 0.5 * (J_ * x_ + r_).squaredNorm();
  }
  x_ = columns.asDiagonal() * x_;
  return x_.allFinite();
}

Vec6 Equations::body_direction(int body) const {
  if (body < 0 || bodies_held_) return Vec6::Zero();
  return x_.segment<6>(6 * body);
}

void Equations::distribute() {
  for (std::size_t i = 0; i < robot_.rods.size(); ++i) {
    RobotRod& rod = robot_.rods[i];
    const Elimination& e = eliminations_[i];
    const Vec6 zeta_A = body_direction(rod.base.body);
    const Vec6 zeta_B = rod.tip_held ? body_direction(rod.tip.body) : Vec6(Vec6::Zero());
    const Vec6 z =
        e.delayed ? Vec6(x_.segment<6>(e.offset)) : Vec6(e.z_A * zeta_A + e.z_B * zeta_B + e.z0);
    rod.model->set_direction(z, zeta_A);
  }
}

bool Equations::find_direction(double mu) {
  if (!condense_rods(mu > 0)) return false;
  assemble();
  ++factorizations_;
  if (!solve(mu)) return false;
  distribute();
  return true;
}

bool Equations::follow_bodies(const std::vector<Vec6>& motions) {
  const bool held = bodies_held_;
  bodies_held_ = false;
  const bool regular = condense_rods(false);
  x_.setZero(size_);
  for (std::size_t b = 0; b < motions.size(); ++b)
    x_.segment<6>(6 * static_cast<Eigen::Index>(b)) = motions[b];
  for (std::size_t i = 0; i < eliminations_.size(); ++i) {
    Elimination& e = eliminations_[i];
    if (e.delayed) {
      // a rod without stiffness in some direction: the smallest motion that closes its joints
      const RobotRod& rod = robot_.rods[i];
      const CondensedRod& c = condensed_[i];
      Vec6 rhs = c.t + c.T_A * body_direction(rod.base.body);
      if (rod.tip_held) rhs += c.T_B * body_direction(rod.tip.body);
      x_.segment<6>(e.offset) = -least_norm_solution(c.T, rhs, kSingularPivot);
    }
  }
  if (regular) distribute();
  bodies_held_ = held;
  return regular;
}

}  // namespace cprsim
