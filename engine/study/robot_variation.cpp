// SPDX-License-Identifier: BSD-3-Clause
#include "engine/study/robot_variation.h"

#include <cmath>

#include "engine/math/linear_solve.h"
#include "engine/math/so3.h"

namespace cprsim {
namespace {

constexpr double kDependent = 1e-10;

/// Matrix of the form f·(phi × (phi × r)), symmetric.
Mat3 swing(const Vec3& f, const Vec3& r) {
  const Mat3 outer = r * f.transpose();
  return 0.5 * (outer + outer.transpose()) - f.dot(r) * Mat3::Identity();
}

void add_product(MatX& K, const MatX& a, const MatX& b) {
  // a form a·b as half of itself and its transpose
  const MatX product = 0.5 * (a.transpose() * b);
  K += product + product.transpose();
}

/// One end of a rod with its body's motion, all as rows over (x, y_A, y_B).
struct End {
  const RodEndSpec* spec;
  NodeState state;
  Port port;
  Vec3 force, moment;  ///< on the rod
  MatX pose;           ///< (phi, d) of the rod's end
  MatX body;           ///< (phi, d) of the body's reference point
};

/// The rows of the joint that hold positions or rotations; the others are about reactions.
MatX holding_rows(const End& end, double length) {
  const RodEnd joint(*end.spec);
  if (!joint.held()) return MatX(0, end.pose.cols());
  const EndRows rows = joint.rows(end.state, end.port, {length, 1, 1});
  MatX all(6, end.pose.cols());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (rows.by_state.block<1, 6>(i, 6).cwiseAbs().maxCoeff() > 0) continue;
    all.row(count++) = rows.by_state.block<1, 6>(i, 0) * end.pose + rows.by_body.row(i) * end.body;
  }
  return all.topRows(count);
}

void add_reactions(const End& end, MatX& K) {
  if (end.spec->joint == EndJoint::kFree) return;
  const MatX phi_B = end.body.topRows<3>(), phi_E = end.pose.topRows<3>();
  add_product(K, phi_B, swing(end.force, end.port.arm) * phi_B);
  // m·(phi_B × phi_E) = phi_B·(phi_E × m)
  add_product(K, phi_B, -hat(end.moment) * phi_E);
  const RodEnd joint(*end.spec);
  Vec3 a, b;
  if (!joint.turns_about(end.state, end.port, a, b)) return;
  const MatX turn = phi_E - phi_B;
  add_product(K, end.moment.dot(a.cross(b)) * (a.transpose() * turn), b.transpose() * turn);
}

ReducedRod reduce(const Robot& robot, const RobotRod& rod, bool rotary, bool metric, double share) {
  RodField field = rod.model->field();
  if (metric) {  // by the material's length
    field.added_mass = 0;
    field.disks.clear();
    for (SectionProperties& section : field.sections) {
      section.rhoA = field.rhoA;
      section.rhoJ = field.rhoJ;
      section.fluid.added_mass = 0;
    }
  }
  RodVariation own = rod_variation(field, rotary || metric);
  // of the metric: unit density along all rods
  if (metric) own.M *= share / field.rhoA;
  const Eigen::Index n = own.size();
  const auto over_all = [&](const MatX& rows) {
    MatX wide = MatX::Zero(rows.rows(), n + 12);
    wide.leftCols(n) = rows;
    return wide;
  };
  End base{&rod.spec->base,        field.base,         robot.port(rod.base), -force_of(field.base),
           -moment_of(field.base), over_all(own.base), MatX::Zero(6, n + 12)};
  End tip{&rod.spec->tip,       field.tip,         robot.port(rod.tip),  force_of(field.tip),
          moment_of(field.tip), over_all(own.tip), MatX::Zero(6, n + 12)};
  ReducedRod out;
  if (rod.base_held) out.base_body = rod.base.body;
  if (rod.tip_held) out.tip_body = rod.tip.body;
  if (out.base_body >= 0) base.body.middleCols<6>(n).setIdentity();
  if (out.tip_body >= 0) tip.body.middleCols<6>(n + 6).setIdentity();
  MatX K = MatX::Zero(n + 12, n + 12), M = K;
  K.topLeftCorner(n, n) = own.K;
  M.topLeftCorner(n, n) = own.M;
  add_reactions(base, K);
  add_reactions(tip, K);
  const MatX rows_base = holding_rows(base, rod.length), rows_tip = holding_rows(tip, rod.length);
  MatX C(rows_base.rows() + rows_tip.rows() + own.held.rows(), n + 12);
  C << rows_base, rows_tip, over_all(own.held) / rod.length;
  // lengths per unit: psi in 1/L, d in L
  VecX unit = VecX::Constant(n, 1);
  unit.segment<3>(3).setConstant(rod.length);
  const auto point = (n - 6) / static_cast<Eigen::Index>(field.points.size());
  for (Eigen::Index i = 6; i < n; i += point)
    unit.segment<3>(i).setConstant(1 / rod.length);
  MatX motions = unit.asDiagonal(), in_plane;
  if (robot.plane) {
    in_plane = planar_motions(field, robot.plane->col(2));
    motions *= in_plane;
  }
  const MatX Cx = C.leftCols(n) * motions;
  const MatX Z = motions * kernel_of(Cx, kDependent);
  const MatX X = motions * least_norm_solutions(Cx, -C.rightCols<12>(), kDependent);
  // what a rod cannot follow, like a change of distance where it is straight and does not stretch
  out.demands = kernel_of(Cx.transpose(), kDependent).transpose() * C.rightCols<12>();
  out.inner = Z.cols();
  out.expand.resize(n, out.inner + 12);
  out.expand << Z, X;
  // E^T F E with E = (Z X; 0 I), block by block
  const auto by_motions = [&](const MatX& F) {
    const MatX all = unit.asDiagonal() * F * unit.asDiagonal();
    return robot.plane ? MatX(in_plane.transpose() * all * in_plane) : all;
  };
  const auto reduced = [&](const MatX& F) {
    const MatX across = F.topLeftCorner(n, n) * X + F.topRightCorner(n, 12);
    MatX all(out.inner + 12, out.inner + 12);
    all.topLeftCorner(out.inner, out.inner) =
        between_kernel(Cx, kDependent, by_motions(F.topLeftCorner(n, n)));
    all.topRightCorner(out.inner, 12) = onto_kernel(Cx, kDependent, motions.transpose() * across);
    all.bottomLeftCorner(12, out.inner) = all.topRightCorner(out.inner, 12).transpose();
    all.bottomRightCorner<12, 12>() =
        X.transpose() * across + F.bottomLeftCorner(12, n) * X + F.bottomRightCorner<12, 12>();
    return all;
  };
  out.K = reduced(K);
  out.M = reduced(M);
  if (!metric) out.nodes = own.nodes * out.expand;
  return out;
}

void add_bodies(const Robot& robot, bool metric, RobotVariation& v) {
  double length = robot.scale.length;
  for (std::size_t b = 0; b < robot.bodies.size(); ++b) {
    const RigidBody& body = robot.bodies[b];
    const Eigen::Index at = 6 * static_cast<Eigen::Index>(b);
    v.K.block<3, 3>(at, at) -= swing(body.gravity_mass * robot.gravity, body.R * body.gravity_arm);
    if (metric) {
      // enough to make the form definite where no rod moves with the body
      v.M.block<3, 3>(at, at) += 1e-3 * length * length * Mat3::Identity();
      v.M.block<3, 3>(at + 3, at + 3) += 1e-3 * Mat3::Identity();
    } else {
      v.M.block<3, 3>(at, at) += body.R * body.inertia * body.R.transpose();
      v.M.block<3, 3>(at + 3, at + 3) += body.mass * Mat3::Identity();
    }
  }
  for (const BodyLoad& load : robot.body_loads) {
    const RigidBody& body = robot.bodies[static_cast<std::size_t>(load.at.body)];
    const PointLoad now = load_at(*load.spec, 0, true);
    const Vec3 arm = (body.pose() * load.at.X).p - body.p;
    const Eigen::Index at = 6 * load.at.body;
    if (now.follower || now.torque.norm() > 0) v.potential = false;
    if (!now.follower) v.K.block<3, 3>(at, at) -= swing(now.force, arm);
  }
  for (const RobotRod& rod : robot.rods) {
    for (const PointLoad& load : rod.forcing.loads)
      if (load.follower || load.torque.norm() > 0) v.potential = false;
    for (const LineLoad& line : rod.forcing.lines)
      if (line.follower || line.torque.norm() > 0) v.potential = false;
    const FluidProperties& fluid = rod.section.fluid;
    if ((fluid.normal > 0 || fluid.tangential > 0) && !rod.forcing.wind.isZero(0))
      v.potential = false;
  }
}

/// A ball's first three rows are no demand but its spring's moment, child axes; in K with the sign
/// of a stiffness, action on the child and reaction on the parent.
void add_ball(const Joint& joint, const Joint::Rows& rows, Eigen::Index row, RobotVariation& v) {
  const Mat3 R_JC = rows.by_lambda.topLeftCorner<3, 3>().transpose();
  const Mat3 by_child = R_JC * rows.by_child.topLeftCorner<3, 3>(),
             by_parent = R_JC * rows.by_parent.topLeftCorner<3, 3>();
  const Eigen::Index p = 6 * joint.parent, c = 6 * joint.child;
  v.C.middleRows<3>(row).setZero();
  if (joint.child >= 0) v.K.block<3, 3>(c, c) += by_child;
  if (joint.parent >= 0) v.K.block<3, 3>(p, p) -= by_parent;
  if (joint.child < 0 || joint.parent < 0) return;
  v.K.block<3, 3>(c, p) += by_parent;
  v.K.block<3, 3>(p, c) -= by_child;
}

void add_joints(const Robot& robot, RobotVariation& v) {
  Eigen::Index q = 6 * static_cast<Eigen::Index>(robot.bodies.size());
  Eigen::Index row = 0;
  v.C = MatX::Zero(6 * static_cast<Eigen::Index>(robot.joints.size()), v.K.cols());
  for (const Joint& joint : robot.joints) {
    const Pose P = robot.body_pose(joint.parent), B = robot.body_pose(joint.child);
    const Joint::Rows rows = joint.rows(P, B, StageRates{}, robot.scale.length, 1, 1);
    const Joint::Wrenches w = joint.wrenches(P, B);
    const Eigen::Index p = 6 * joint.parent, c = 6 * joint.child;
    if (joint.parent >= 0) {
      v.C.block<6, 6>(row, p) = rows.by_parent;
      v.K.block<6, 6>(p, p) -= w.parent_by_parent;
    }
    if (joint.child >= 0) {
      v.C.block<6, 6>(row, c) = rows.by_child;
      v.K.block<6, 6>(c, c) -= w.child_by_child;
    }
    if (joint.parent >= 0 && joint.child >= 0) v.K.block<6, 6>(p, c) -= w.parent_by_child;
    if (joint.is_ball()) add_ball(joint, rows, row, v);
    for (std::size_t i = 0; i < joint.freedoms.size(); ++i) {
      const int unknown = joint.freedoms[i].unknown;
      if (unknown < 0) continue;
      const auto k = static_cast<Eigen::Index>(i);
      v.C.block<6, 1>(row, q + unknown) = rows.by_q.col(k);
      if (joint.parent >= 0) v.K.block<1, 6>(q + unknown, p) += rows.effort_by_parent.row(k);
      for (std::size_t j = 0; j < joint.freedoms.size(); ++j)
        if (joint.freedoms[j].unknown >= 0)
          v.K(q + unknown, q + joint.freedoms[j].unknown) +=
              rows.effort_by_q(k, static_cast<Eigen::Index>(j));
    }
    q += joint.unknown_coordinates();
    row += 6;
  }
  v.K = 0.5 * (v.K + MatX(v.K.transpose()));
}

void add_demands(RobotVariation& v) {
  for (const ReducedRod& rod : v.rods) {
    const Eigen::Index before = v.C.rows();
    v.C.conservativeResize(before + rod.demands.rows(), Eigen::NoChange);
    v.C.bottomRows(rod.demands.rows()).setZero();
    if (rod.base_body >= 0)
      v.C.block(before, 6 * rod.base_body, rod.demands.rows(), 6) += rod.demands.leftCols<6>();
    if (rod.tip_body >= 0)
      v.C.block(before, 6 * rod.tip_body, rod.demands.rows(), 6) += rod.demands.rightCols<6>();
  }
}

}  // namespace

Eigen::Index RobotVariation::inner() const {
  Eigen::Index sum = 0;
  for (const ReducedRod& rod : rods)
    sum += rod.inner;
  return sum;
}

MatX RobotVariation::free() const {
  return kernel_of(C, kDependent);
}

void RobotVariation::assemble(MatX& stiffness, MatX& mass) const {
  const MatX F = free();
  const Eigen::Index first = inner(), all = first + F.cols();
  for (const bool is_mass : {false, true}) {
    MatX& total = is_mass ? mass : stiffness;
    total = MatX::Zero(all, all);
    MatX y = is_mass ? M : K;
    MatX coupling = MatX::Zero(first, outer());
    Eigen::Index at = 0;
    for (const ReducedRod& rod : rods) {
      const MatX& own = is_mass ? rod.M : rod.K;
      const Eigen::Index k = rod.inner;
      total.block(at, at, k, k) = own.topLeftCorner(k, k);
      const int bodies[2] = {rod.base_body, rod.tip_body};
      for (int i = 0; i < 2; ++i) {
        if (bodies[i] < 0) continue;
        coupling.block(at, 6 * bodies[i], k, 6) += own.block(0, k + 6 * i, k, 6);
        for (int j = 0; j < 2; ++j)
          if (bodies[j] >= 0)
            y.block<6, 6>(6 * bodies[i], 6 * bodies[j]) += own.block<6, 6>(k + 6 * i, k + 6 * j);
      }
      at += k;
    }
    total.topRightCorner(first, F.cols()) = coupling * F;
    total.bottomLeftCorner(F.cols(), first) = total.topRightCorner(first, F.cols()).transpose();
    total.bottomRightCorner(F.cols(), F.cols()) = F.transpose() * y * F;
  }
}

/// Bodies of a planar robot do not leave their plane.
void add_plane(const Robot& robot, RobotVariation& v) {
  if (!robot.plane) return;
  const Mat3& axes = *robot.plane;  // e1, e2, normal
  const Eigen::Index before = v.C.rows();
  const auto bodies = static_cast<Eigen::Index>(robot.bodies.size());
  v.C.conservativeResize(before + 3 * bodies, Eigen::NoChange);
  v.C.bottomRows(3 * bodies).setZero();
  for (Eigen::Index b = 0; b < bodies; ++b) {
    v.C.block<2, 3>(before + 3 * b, 6 * b) = axes.leftCols<2>().transpose();
    v.C.block<1, 3>(before + 3 * b + 2, 6 * b + 3) = axes.col(2).transpose() / robot.scale.length;
  }
}

RobotVariation robot_variation(const Robot& robot, Inertia inertia) {
  RobotVariation v;
  const bool metric = inertia == Inertia::kMetric;
  const bool rotary = robot.scene->effects.has(Effect::kRotaryInertia);
  double total = 0;
  for (const RobotRod& rod : robot.rods)
    total += rod.length;
  for (const RobotRod& rod : robot.rods)
    v.rods.push_back(reduce(robot, rod, rotary, metric, 1 / total));
  Eigen::Index outer = 6 * static_cast<Eigen::Index>(robot.bodies.size());
  for (const Joint& joint : robot.joints)
    outer += joint.unknown_coordinates();
  v.K = MatX::Zero(outer, outer);
  v.M = MatX::Zero(outer, outer);
  add_bodies(robot, metric, v);
  add_joints(robot, v);
  add_demands(v);
  add_plane(robot, v);
  return v;
}

}  // namespace cprsim
