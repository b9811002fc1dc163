// SPDX-License-Identifier: BSD-3-Clause
// The linear side: condensed rods, global system, directions. In J x + r = 0 x is in the units of
// column_units(), rows in those of row_units(), so that pivoting compares like with like.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/math/linear_solve.h"
#include "engine/robot/equations.h"
#include "engine/solve/phase_clock.h"

namespace cprsim {
namespace {

// Below this ratio of pivots T is singular: without stiffness in some direction.
constexpr double kSingularPivot = 1e-10;

// Likewise for the global system, and how well its rows must then be met.
constexpr double kSingularSystem = 1e-13, kConsistent = 1e-6;

// Joints that close a loop may say the same twice (a planar four-bar thrice), up to magnified
// round-off. Taken for a pivot it would throw the multipliers about.
constexpr double kSingularLoop = 1e-12;

}  // namespace

template <int N>
Eigen::Matrix<double, N, 1> Equations::kept(const Vec6& v) const {
  if constexpr (N == 6)
    return v;
  else
    return in_plane_.transpose() * v;
}

template <int N>
Eigen::Matrix<double, N, N> Equations::kept(const Mat6& M) const {
  if constexpr (N == 6)
    return M;
  else
    return in_plane_.transpose() * M * in_plane_;
}

template <int N>
bool Equations::condense(bool keep_all) {
  using MatN = Eigen::Matrix<double, N, N>;
  using VecN = Eigen::Matrix<double, N, 1>;
  int offset = body_unknowns_;
  for (const Joint& joint : robot_.joints)
    offset += unknowns_of(joint);
  growth_ = 0;
  for (std::size_t i = 0; i < robot_.rods.size(); ++i) {
    RobotRod& rod = robot_.rods[i];
    CondensedRod& c = condensed_[i];
    if (!rod.model->linearize(robot_.port(rod.base), robot_.port(rod.tip), c)) return false;
    growth_ = std::max(growth_, c.growth);
    Elimination& e = eliminations_[i];
    const MatN T = c.T.topLeftCorner<N, N>();
    const Eigen::PartialPivLU<MatN> lu(T);
    VecN pivots = lu.matrixLU().diagonal().cwiseAbs();
    // a straight rod in flight spins without inertia, which pivots of columns need not show
    if (!rod.base_held) pivots = Eigen::FullPivLU<MatN>(T).matrixLU().diagonal().cwiseAbs();
    e.delayed = keep_all || !(pivots.minCoeff() > kSingularPivot * pivots.maxCoeff());
    if (e.delayed) {
      e.offset = offset;
      offset += N;
      continue;
    }
    e.offset = -1;
    e.z0.head<N>() = -lu.solve(VecN(c.t.head<N>()));
    e.z_A.setZero();
    e.z_B.setZero();
    if (rod.base.body >= 0)
      e.z_A.topLeftCorner<N, N>() = -lu.solve(MatN(c.T_A.topLeftCorner<N, N>()));
    if (rod.tip_held && rod.tip.body >= 0)
      e.z_B.topLeftCorner<N, N>() = -lu.solve(MatN(c.T_B.topLeftCorner<N, N>()));
  }
  size_ = number_body_contacts(robot_.rods_meet ? number_pairs(offset) : offset);
  return true;
}

bool Equations::condense_rods(bool keep_all) {
  const PhaseTimer timer(robot_.clock, Phase::kElimination);
  return robot_.plane ? condense<3>(keep_all) : condense<6>(keep_all);
}

template <int N>
void Equations::assemble_rod(std::size_t i) {
  using MatN = Eigen::Matrix<double, N, N>;
  using VecN = Eigen::Matrix<double, N, 1>;
  const RobotRod& rod = robot_.rods[i];
  const CondensedRod& c = condensed_[i];
  const Elimination& e = eliminations_[i];
  const auto block = [](const Mat6& M) -> MatN { return M.topLeftCorner<N, N>(); };
  const bool A_moves = rod.base_held && rod.base.body >= 0 && !bodies_held_;
  const bool B_moves = rod.tip_held && rod.tip.body >= 0 && !bodies_held_;
  const int a = N * rod.base.body, b = N * rod.tip.body;
  const VecN wa = c.wa.head<N>(), wb = c.wb.head<N>();
  if (e.delayed) {
    J_.block<N, N>(e.offset, e.offset) = block(c.T);
    r_.segment<N>(e.offset) = c.t.head<N>();
    if (A_moves) {
      J_.block<N, N>(e.offset, a) += block(c.T_A);
      J_.block<N, N>(a, e.offset) = block(c.WA_z);
      J_.block<N, N>(a, a) += block(c.WA_A);
      r_.segment<N>(a) += wa;
    }
    if (B_moves) {
      J_.block<N, N>(e.offset, b) += block(c.T_B);
      J_.block<N, N>(b, e.offset) += block(c.WB_z);
      J_.block<N, N>(b, b) += block(c.WB_B);
      if (A_moves) J_.block<N, N>(b, a) += block(c.WB_A);
      r_.segment<N>(b) += wb;
    }
    return;
  }
  const MatN z_A = block(e.z_A), z_B = block(e.z_B);
  const VecN z0 = e.z0.head<N>();
  if (A_moves) {
    const MatN WA_z = block(c.WA_z);
    J_.block<N, N>(a, a) += block(c.WA_A) + WA_z * z_A;
    if (B_moves) J_.block<N, N>(a, b) += WA_z * z_B;
    r_.segment<N>(a) += wa + WA_z * z0;
  }
  if (B_moves) {
    const MatN WB_z = block(c.WB_z);
    J_.block<N, N>(b, b) += block(c.WB_B) + WB_z * z_B;
    if (A_moves) J_.block<N, N>(b, a) += block(c.WB_A) + WB_z * z_A;
    r_.segment<N>(b) += wb + WB_z * z0;
  }
}

template <int N>
void Equations::assemble_bodies() {
  for (std::size_t b = 0; b < robot_.bodies.size(); ++b) {
    const auto at = N * static_cast<Eigen::Index>(b);
    if (bodies_held_) {
      J_.block<N, N>(at, at).setIdentity();
      continue;
    }
    J_.block<N, N>(at, at) += kept<N>(body_tangent_[b]);
    r_.segment<N>(at) += kept<N>(wrench_[b]);
  }
  // the wrenches of rods are in wrench_ already, and came again with wa, wb
  if (bodies_held_) return;
  for (const RobotRod& rod : robot_.rods) {
    if (rod.base_held && rod.base.body >= 0)
      r_.segment<N>(N * rod.base.body) -= kept<N>(rod.model->wrench_on_base(robot_.port(rod.base)));
    if (rod.tip_held && rod.tip.body >= 0)
      r_.segment<N>(N * rod.tip.body) -= kept<N>(rod.model->wrench_on_tip(robot_.port(rod.tip)));
  }
}

template <int N>
void Equations::assemble_joints() {
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    const Joint& joint = robot_.joints[j];
    const Eigen::Index at = joint_offset_[j];
    if (bodies_held_) {
      J_.block(at, at, unknowns_of(joint), unknowns_of(joint)).setIdentity();
      continue;
    }
    const Pose P = body_pose(joint.parent), C = body_pose(joint.child);
    const Joint::Rows rows =
        joint.rows(P, C, rates_, robot_.scale.length, robot_.scale.moment(), robot_.scale.force);
    const Joint::Wrenches w = joint.wrenches(P, C);
    const Eigen::Index p = N * joint.parent, c = N * joint.child;
    // closure is written in the joint's axes, what the plane leaves of it in the plane's
    const auto to_world = [&](const auto& M) {
      auto turned = M.eval();
      turned.template topRows<3>() = rows.axes * M.template topRows<3>();
      turned.template bottomRows<3>() = rows.axes * M.template bottomRows<3>();
      return turned;
    };
    const auto closing = [&](const Mat6& M) -> Eigen::Matrix<double, N, N> {
      if constexpr (N == 6)
        return M;
      else
        return kept<N>(to_world(M));
    };
    const auto closure = [&](const Vec6& v) -> Eigen::Matrix<double, N, 1> {
      if constexpr (N == 6)
        return v;
      else
        return kept<N>(to_world(v));
    };
    const auto effort = [&](const auto& row) { return kept<N>(Vec6(row.transpose())); };
    r_.segment<N>(at) =
        closure(rows.closure - (gaps_captured_ ? 1 - fraction_ : 0) * joint_gap_[j]);
    if (joint.parent >= 0) {
      J_.block<N, N>(at, p) = closing(rows.by_parent);
      J_.block<N, N>(p, at) = kept<N>(w.parent_by_lambda);
      J_.block<N, N>(p, p) += kept<N>(w.parent_by_parent);
    }
    if (joint.child >= 0) {
      J_.block<N, N>(at, c) = closing(rows.by_child);
      J_.block<N, N>(c, at) = kept<N>(w.child_by_lambda);
      J_.block<N, N>(c, c) += kept<N>(w.child_by_child);
    }
    if (joint.parent >= 0 && joint.child >= 0) J_.block<N, N>(p, c) += kept<N>(w.parent_by_child);
    J_.block<N, N>(at, at) = closing(rows.by_lambda);
    for (std::size_t k = 0; k < joint.freedoms.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      if (joint.freedoms[k].unknown < 0) continue;
      const Eigen::Index row = at + N + joint.freedoms[k].unknown;
      J_.block<N, 1>(at, row) = closure(rows.by_q.col(i));
      J_.block<1, N>(row, at) = effort(rows.effort_by_lambda.row(i)).transpose();
      if (joint.parent >= 0)
        J_.block<1, N>(row, p) = effort(rows.effort_by_parent.row(i)).transpose();
      for (std::size_t l = 0; l < joint.freedoms.size(); ++l)
        if (joint.freedoms[l].unknown >= 0)
          J_(row, at + N + joint.freedoms[l].unknown) =
              rows.effort_by_q(i, static_cast<Eigen::Index>(l));
      r_[row] = rows.effort[i];
    }
  }
}

template <int N>
void Equations::assemble_parts() {
  assemble_bodies<N>();
  for (std::size_t i = 0; i < robot_.rods.size(); ++i)
    assemble_rod<N>(i);
  assemble_joints<N>();
}

void Equations::assemble() {
  J_.setZero(size_, size_);
  r_.setZero(size_);
  if (robot_.plane)
    assemble_parts<3>();
  else
    assemble_parts<6>();
  if (!pairs_.empty()) assemble_pairs();
  if (!robot_.body_contacts.empty()) assemble_body_contacts();
  if (robot_.rods_meet || !robot_.probes.empty()) hold_still_bodies();
}

VecX Equations::column_units() const {
  VecX u = VecX::Ones(size_);
  const int N = freedoms_, turns = N == 6 ? 3 : 1;
  const double length = robot_.scale.length;
  for (Eigen::Index b = 0; b < body_unknowns_; b += N)
    u.segment(b + turns, N - turns).setConstant(length);
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    const Joint& joint = robot_.joints[j];
    const Eigen::Index at = joint_offset_[j];
    const double force = std::max(force_unit(joint.parent), force_unit(joint.child));
    u.segment(at, turns).setConstant(force * length);
    u.segment(at + turns, N - turns).setConstant(force);
    for (const Joint::Freedom& freedom : joint.freedoms)
      if (freedom.unknown >= 0 && freedom.measured_as_length())
        u[at + N + freedom.unknown] = length;
  }
  if (!pairs_.empty()) pair_units(u);
  body_contact_units(u);
  return u;
}

VecX Equations::row_units() const {
  VecX u = VecX::Ones(size_);
  if (bodies_held_) return u;
  const int N = freedoms_, turns = N == 6 ? 3 : 1;
  for (Eigen::Index b = 0; b < body_unknowns_; b += N) {
    const double force = force_unit(static_cast<int>(b / N));
    u.segment(b, turns).setConstant(force * robot_.scale.length);
    u.segment(b + turns, N - turns).setConstant(force);
  }
  // effort rows are in units of the robot's force; their multiplier's column may be larger
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    const Joint& joint = robot_.joints[j];
    const double force = std::max(force_unit(joint.parent), force_unit(joint.child));
    u.segment(joint_offset_[j] + N, joint.unknown_coordinates())
        .setConstant(force / robot_.scale.force);
    if (joint.is_ball()) u.segment(joint_offset_[j], turns).setConstant(force / robot_.scale.force);
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
    present.segment(joint_offset_[j], freedoms_) =
        robot_.plane ? VecX(in_plane_.transpose() * robot_.joints[j].lambda)
                     : VecX(robot_.joints[j].lambda);
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

template <int N>
void Equations::distribute_to_rods() {
  using VecN = Eigen::Matrix<double, N, 1>;
  const auto direction = [&](int body) -> VecN {
    if (body < 0 || bodies_held_) return VecN::Zero();
    return x_.segment<N>(N * body);
  };
  for (std::size_t i = 0; i < robot_.rods.size(); ++i) {
    RobotRod& rod = robot_.rods[i];
    const Elimination& e = eliminations_[i];
    Vec6 z = Vec6::Zero(), zeta_A = Vec6::Zero();
    const VecN a = direction(rod.base.body);
    zeta_A.head<N>() = a;
    if (e.delayed) {
      z.head<N>() = x_.segment<N>(e.offset);
    } else {
      const VecN b = rod.tip_held ? direction(rod.tip.body) : VecN(VecN::Zero());
      z.head<N>() =
          e.z_A.topLeftCorner<N, N>() * a + e.z_B.topLeftCorner<N, N>() * b + e.z0.head<N>();
    }
    if (!pairs_.empty()) z += distribute_forces(i);
    rod.model->set_direction(z, zeta_A);
  }
}

void Equations::distribute() {
  const PhaseTimer timer(robot_.clock, Phase::kElimination);
  if (robot_.plane)
    distribute_to_rods<3>();
  else
    distribute_to_rods<6>();
}

bool Equations::find_direction(double mu) {
  if (!condense_rods(mu > 0)) return false;
  if (!solve_system(mu)) return false;
  distribute();
  return true;
}

bool Equations::solve_system(double mu) {
  const PhaseTimer timer(robot_.clock, Phase::kSystem);
  assemble();
  ++factorizations_;
  return solve(mu);
}

bool Equations::follow_bodies(const std::vector<Vec6>& motions) {
  const bool held = bodies_held_;
  bodies_held_ = false;
  const bool regular = condense_rods(false);
  x_.setZero(size_);
  const int N = freedoms_;
  for (std::size_t b = 0; b < motions.size(); ++b) {
    const auto at = static_cast<Eigen::Index>(b) * N;
    if (N == 6)
      x_.segment<6>(at) = motions[b];
    else
      x_.segment<3>(at) = in_plane_.transpose() * motions[b];
  }
  for (std::size_t i = 0; i < eliminations_.size(); ++i) {
    Elimination& e = eliminations_[i];
    if (e.delayed) {
      // a rod without stiffness in some direction: the smallest motion that closes its joints
      const RobotRod& rod = robot_.rods[i];
      const CondensedRod& c = condensed_[i];
      VecX rhs = c.t.head(N);
      if (rod.base.body >= 0) rhs += c.T_A.topLeftCorner(N, N) * x_.segment(N * rod.base.body, N);
      if (rod.tip_held && rod.tip.body >= 0)
        rhs += c.T_B.topLeftCorner(N, N) * x_.segment(N * rod.tip.body, N);
      x_.segment(e.offset, N) = -least_norm_solution(c.T.topLeftCorner(N, N), rhs, kSingularPivot);
    }
  }
  if (regular) distribute();
  bodies_held_ = held;
  return regular;
}

}  // namespace cprsim
