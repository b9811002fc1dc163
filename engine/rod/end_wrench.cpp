// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/end_wrench.h"

#include "engine/math/so3.h"

namespace cprsim {
namespace {

/// From the body's reference point to the rod's end.
Vec3 arm_of(const NodeState& end, const Port& port) {
  return position_of(end) - port.p + port.arm;
}

}  // namespace

Vec6 wrench_on_base(const NodeState& start, const Port& base) {
  Vec6 w;
  w << moment_of(start) + arm_of(start, base).cross(force_of(start)), force_of(start);
  return w;
}

Vec6 wrench_on_tip(const NodeState& end, const Port& tip) {
  return -wrench_on_base(end, tip);
}

void condense_tip(const RodEnd& rod_end, const NodeState& end, const Port& tip,
                  const RodScale& scale, const Vec6& gap, const EndColumns& Y, CondensedRod& out) {
  const EndRows rows = rod_end.rows(end, tip, scale);
  out.T = rows.by_state * Y.by_z;
  out.t = rows.value - gap + rows.by_state * Y.affine;
  out.T_A = rows.by_state * Y.by_A;
  out.T_B = rows.by_body;
  out.WB_z.setZero();
  out.WB_A.setZero();
  out.WB_B.setZero();
  out.wb.setZero();
  if (!rod_end.held()) return;
  // force -n, moment -(m + r × n), r from the body's reference point to the rod's end
  const Vec3 n = force_of(end);
  Mat6x12 W = Mat6x12::Zero();
  W.block<3, 3>(0, 3) = hat(n);
  W.block<3, 3>(0, 6) = -hat(arm_of(end, tip));
  W.block<3, 3>(0, 9) = -Mat3::Identity();
  W.block<3, 3>(3, 6) = -Mat3::Identity();
  out.WB_z = W * Y.by_z;
  out.WB_A = W * Y.by_A;
  out.WB_B.block<3, 3>(0, 3) = -hat(n);
  out.wb = wrench_on_tip(end, tip) + W * Y.affine;
}

void condense_base(bool moves, const NodeState& start, const Port& base, const EndColumns& Y,
                   CondensedRod& out) {
  out.WA_z.setZero();
  out.WA_A.setZero();
  out.wa.setZero();
  if (!moves) return;
  const Vec3 n = force_of(start);
  Mat6x12 W = Mat6x12::Zero();
  W.block<3, 3>(0, 3) = -hat(n);
  W.block<3, 3>(0, 6) = hat(arm_of(start, base));
  W.block<3, 3>(0, 9) = Mat3::Identity();
  W.block<3, 3>(3, 6) = Mat3::Identity();
  out.WA_z = W * Y.by_z;
  out.WA_A = W * Y.by_A;
  out.WA_A.block<3, 3>(0, 3) += hat(n);
  out.wa = wrench_on_base(start, base) + W * Y.affine;
}

}  // namespace cprsim
