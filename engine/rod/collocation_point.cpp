// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/collocation_point.h"

#include <cmath>

#include "engine/math/so3.h"
#include "engine/section/line_load.h"
#include "engine/section/rotary.h"
#include "engine/section/tendon_law.h"

namespace cprsim {
namespace {

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Mat3x4 = Eigen::Matrix<double, 3, 4>;

/// vec(q* r) = A(q) r for the quaternion r.
Mat3x4 vector_of_conjugate_product(const Vec4& q) {
  Mat3x4 A;
  A.col(0) = -q.tail<3>();
  A.rightCols<3>() = q[0] * Mat3::Identity() - cprsim::hat(q.tail<3>());
  return A;
}

}  // namespace

Mat3 rotation_of(const Vec4& q) {
  const double w = q[0];
  const Vec3 x = q.tail<3>();
  return ((w * w - x.squaredNorm()) * Mat3::Identity() + 2 * (x * x.transpose()) +
          2 * w * cprsim::hat(x)) /
         q.squaredNorm();
}

Vec4 quaternion_of(const Vec3& turn) {
  const double half = 0.5 * turn.norm();
  const double sinc = half > 1e-8 ? std::sin(half) / half : 1;
  Vec4 q;
  q << std::cos(half), 0.5 * sinc * turn;
  return q;
}

Vec4 quaternion_of(const Mat3& R) {
  const Quat q(R);
  return {q.w(), q.x(), q.y(), q.z()};
}

Vec4 quaternion_product(const Vec4& a, const Vec4& b) {
  const Vec3 x = a.tail<3>(), y = b.tail<3>();
  Vec4 c;
  c << a[0] * b[0] - x.dot(y), a[0] * y + b[0] * x + x.cross(y);
  return c;
}

// dR = phi^ R with phi = 2 vec(dq q*) / |q|²
Mat3x4 turn_by_quaternion(const Vec4& q) {
  Mat3x4 G;
  G.col(0) = -q.tail<3>();
  G.rightCols<3>() = q[0] * Mat3::Identity() + cprsim::hat(q.tail<3>());
  return 2 / q.squaredNorm() * G;
}

Eigen::Matrix4d quaternion_by_increment(const Vec4& q) {
  Eigen::Matrix4d M;
  M.col(0) = q;
  for (int i = 0; i < 3; ++i) {
    Vec4 e = Vec4::Zero();
    e[1 + i] = 0.5;
    M.col(1 + i) = quaternion_product(e, q);
  }
  return M;
}

Vec13 evaluate_point(const PointModel& model, CollocationPoint& point, FluidSection* fluid,
                     TendonSection* tendons) {
  const Vec4 q = point.y.head<4>(), q_s = point.y_s.head<4>();
  const Vec3 p_s = point.y_s.segment<3>(kP);
  point.R = rotation_of(q);
  point.u = 2 / q.squaredNorm() * (vector_of_conjugate_product(q) * q_s);
  Vec3 own_m = point.R.transpose() * point.m(), own_n = point.R.transpose() * point.n();
  if (tendons) {
    const Vec3 v = point.R.transpose() * p_s;
    evaluate_tendons(*tendons, {point.u.x(), point.u.y(), point.u.z()}, {v.x(), v.y(), v.z()});
    own_m -= Eigen::Map<const Vec3>(tendons->moment);
    own_n -= Eigen::Map<const Vec3>(tendons->force);
  }
  point.v = point.v0 + model.C_se.cwiseProduct(own_n);
  Vec13 r;
  r[kQ] = q.dot(q_s);                                                           // (1)
  r.segment<3>(kQ + 1) = point.u - point.u0 - model.C_bt.cwiseProduct(own_m);   // (2)
  r.segment<3>(kP) = p_s - point.R * point.v;                                   // (3)
  r.segment<3>(kN) = point.y_s.segment<3>(kN) - model.k * point.p() - point.b;  // (4)
  if (fluid) {
    const RowMatrix R = point.R;
    evaluate_surroundings(model.c_v, model.c_w, load(point.y.data() + kP), load_matrix(R.data()),
                          model.field, *fluid);
    r.segment<3>(kN) -= Eigen::Map<const Vec3>(fluid->force);
  }
  r.segment<3>(kM) = point.y_s.segment<3>(kM) + p_s.cross(point.n());  // (5)
  if (fluid && fluid->loaded != 0) r.segment<3>(kM) -= Eigen::Map<const Vec3>(fluid->moment);
  if (model.rotary) {
    Eigen::Map<RowMatrix>(point.spin.R) = point.R;
    evaluate_rotary(model, point.spin);
    r.segment<3>(kM) -= Eigen::Map<const Vec3>(point.spin.torque);
  }
  return r;
}

void linearize_point(const PointModel& model, const CollocationPoint& point, Mat13& by_y,
                     Mat13& by_y_s, const FluidSection* fluid, const TendonSection* tendons) {
  by_y.setZero();
  by_y_s.setZero();
  const Vec4 q = point.y.head<4>(), q_s = point.y_s.head<4>();
  const Vec3 p_s = point.y_s.segment<3>(kP), n = point.n(), tau = point.R * point.v;
  const Mat3x4 G = turn_by_quaternion(q);
  // (1)
  by_y.block<1, 4>(kQ, kQ) = q_s.transpose();
  by_y_s.block<1, 4>(kQ, kQ) = q.transpose();
  // (2): vec(dq* q_s) = -A(q_s) dq but for the sign of its scalar part
  Mat3x4 by_q;
  by_q.col(0) = q_s.tail<3>();
  by_q.rightCols<3>() = -q_s[0] * Mat3::Identity() + cprsim::hat(q_s.tail<3>());
  by_q = 2 / q.squaredNorm() * (by_q - point.u * q.transpose()).eval();
  const Mat3 C_bt = point.R * model.C_bt.asDiagonal() * point.R.transpose();
  const Mat3 C_se = point.R * model.C_se.asDiagonal() * point.R.transpose();
  const Mat3 law = point.R.transpose() * C_bt;
  by_y.block<3, 4>(kQ + 1, kQ) = by_q - law * cprsim::hat(point.m()) * G;
  by_y.block<3, 3>(kQ + 1, kM) = -law;
  by_y_s.block<3, 4>(kQ + 1, kQ) = 2 / q.squaredNorm() * vector_of_conjugate_product(q);
  // (3): d(R v) = phi × R v + R C_se R^T (dn + n × phi)
  by_y.block<3, 4>(kP, kQ) = (cprsim::hat(tau) - C_se * cprsim::hat(n)) * G;
  by_y.block<3, 3>(kP, kN) = -C_se;
  by_y_s.block<3, 3>(kP, kP).setIdentity();
  // (4)
  by_y.block<3, 3>(kN, kP).diagonal().setConstant(-model.k);
  by_y_s.block<3, 3>(kN, kN).setIdentity();
  if (fluid) {
    by_y.block<3, 3>(kN, kP) -= Eigen::Map<const RowMatrix>(fluid->force_p);
    by_y.block<3, 4>(kN, kQ) -= Eigen::Map<const RowMatrix>(fluid->force_phi) * G;
  }
  // (5)
  by_y.block<3, 3>(kM, kN) = cprsim::hat(p_s);
  by_y_s.block<3, 3>(kM, kP) = -cprsim::hat(n);
  by_y_s.block<3, 3>(kM, kM).setIdentity();
  if (tendons) {
    // + C_bt dLambda_m in (2), + R C_se dLambda_n in (3), with du = by_q dq + ... and
    // dv = R^T (dp_s + p_s × phi)
    const Mat3 m_u = Eigen::Map<const RowMatrix>(tendons->moment_u),
               m_v = Eigen::Map<const RowMatrix>(tendons->moment_v),
               n_v = Eigen::Map<const RowMatrix>(tendons->force_v);
    const Mat3x4 u_by_q_s = 2 / q.squaredNorm() * vector_of_conjugate_product(q),
                 v_by_q = point.R.transpose() * cprsim::hat(p_s) * G;
    const Mat3 soft = model.C_bt.asDiagonal(), turned = point.R * model.C_se.asDiagonal();
    by_y.block<3, 4>(kQ + 1, kQ) += soft * (m_u * by_q + m_v * v_by_q);
    by_y_s.block<3, 4>(kQ + 1, kQ) += soft * m_u * u_by_q_s;
    by_y_s.block<3, 3>(kQ + 1, kP) += soft * m_v * point.R.transpose();
    by_y.block<3, 4>(kP, kQ) += turned * (m_v.transpose() * by_q + n_v * v_by_q);
    by_y_s.block<3, 4>(kP, kQ) += turned * m_v.transpose() * u_by_q_s;
    by_y_s.block<3, 3>(kP, kP) += turned * n_v * point.R.transpose();
  }
  if (model.rotary)
    by_y.block<3, 4>(kM, kQ) = -Eigen::Map<const RowMatrix>(point.spin.torque_phi) * G;
  if (fluid && fluid->loaded != 0)
    by_y.block<3, 4>(kM, kQ) -= Eigen::Map<const RowMatrix>(fluid->moment_phi) * G;
  if (fluid && fluid->magnetic != 0 && model.field && model.field->magnetic.count > 0)
    by_y.block<3, 3>(kM, kP) -= Eigen::Map<const RowMatrix>(fluid->moment_p);
}

}  // namespace cprsim
