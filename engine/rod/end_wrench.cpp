// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/end_wrench.h"

#include "engine/math/so3.h"

namespace cprsim {
namespace {

/// From the body's reference point to the rod's end.
Vec3 arm_of(const NodeState& end, const Port& port) {
  return position_of(end) - port.p + port.arm;
}

/// (m + r × n, n), r from the body's reference point to the end: its derivative by the state, ...
Mat6x12 by_state(const NodeState& end, const Port& port) {
  Mat6x12 W = Mat6x12::Zero();
  W.block<3, 3>(0, 3) = -hat(force_of(end));
  W.block<3, 3>(0, 6) = hat(arm_of(end, port));
  W.block<3, 3>(0, 9) = W.block<3, 3>(3, 6) = Mat3::Identity();
  return W;
}

/// ... and by the body's motion.
Mat6 by_body(const NodeState& end) {
  Mat6 W = Mat6::Zero();
  W.block<3, 3>(0, 3) = hat(force_of(end));
  return W;
}

}  // namespace

Vec6 wrench_on_base(const MotionSpace& space, const NodeState& start, const Port& base) {
  Vec6 w;
  w << moment_of(start) + arm_of(start, base).cross(force_of(start)), force_of(start);
  return space.motion * (space.motion.transpose() * w);
}

Vec6 wrench_on_tip(const MotionSpace& space, const NodeState& end, const Port& tip) {
  return -wrench_on_base(space, end, tip);
}

void condense_tip(const MotionSpace& space, const ConditionRows& rows, bool held,
                  const NodeState& end, const Port& tip, const MatX& Y, CondensedRod& out,
                  const MorePorts& more) {
  const Eigen::Index d = space.freedoms();
  const MatX T = rows.by_state * Y;
  out.T.topLeftCorner(d, d) = T.leftCols(d);
  out.T_A.topLeftCorner(d, d) = T.middleCols(d, d);
  out.t.head(d) = rows.value + T.col(2 * d);
  out.T_B.topLeftCorner(d, d) = rows.by_body * space.motion;
  MatX W = MatX::Zero(d, 2 * d + 1);
  out.WB_B.topLeftCorner(d, d).setZero();
  if (held) {
    W = -space.motion.transpose() * by_state(end, tip) * Y;
    W.col(2 * d) += space.motion.transpose() * wrench_on_tip(space, end, tip);
    out.WB_B.topLeftCorner(d, d) = -space.motion.transpose() * by_body(end) * space.motion;
  }
  out.WB_z.topLeftCorner(d, d) = W.leftCols(d);
  out.WB_A.topLeftCorner(d, d) = W.middleCols(d, d);
  out.wb.head(d) = W.col(2 * d);
  const Eigen::Index forces = Y.cols() - 2 * d - 1 - more.unknowns;
  if (!held) W.setZero(d, Y.cols());
  if (more.forces) {
    more.forces->T_F = T.middleCols(2 * d + 1, forces);
    more.forces->WB_F = W.middleCols(2 * d + 1, forces);
  }
  if (!more.tensions) return;
  more.tensions->T = T.rightCols(more.unknowns);
  more.tensions->WB = W.rightCols(more.unknowns);
}

void condense_base(const MotionSpace& space, const NodeState& start, const Port& base,
                   const MatX& Y, CondensedRod& out, const MorePorts& more) {
  const Eigen::Index d = space.freedoms();
  const MatX W = space.motion.transpose() * by_state(start, base) * Y;
  out.WA_z.topLeftCorner(d, d) = W.leftCols(d);
  out.WA_A.topLeftCorner(d, d) =
      W.middleCols(d, d) + space.motion.transpose() * by_body(start) * space.motion;
  out.wa.head(d) = W.col(2 * d) + space.motion.transpose() * wrench_on_base(space, start, base);
  if (more.forces)
    more.forces->WA_F = W.middleCols(2 * d + 1, W.cols() - 2 * d - 1 - more.unknowns);
  if (more.tensions) more.tensions->WA = W.rightCols(more.unknowns);
}

}  // namespace cprsim
