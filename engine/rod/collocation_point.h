// SPDX-License-Identifier: BSD-3-Clause
// The Cosserat balance in strong form at one place of a rod, in mixed unknowns: unit quaternion q,
// centreline p, internal force n and moment m are fields of their own. With R = R(q / |q|) and the
// letters of engine/rod/cell.h:
//   q · q_s = 0                                  (1)   |q| stays what it is at the base
//   2 vec(q* q_s) / |q|² = u = u0 + C_bt R^T m   (2)   curvature law
//   p_s = R v,  v = v0 + C_se R^T n              (3)   shear and stretch law
//   n_s = k p + b + g                            (4)
//   m_s = -p_s × n + t(R)                        (5)
// where g is a fluid's force (engine/section/fluid.h); loads along the rod and magnetic ones
// stand in (4), (5) as engine/section/line_load.h and magnetic_load.h say. With tendons n and m are
// those of rod and tendons together; in (2), (3) the rod's own part is less Lambda_m(u, v),
// Lambda_n(u, v) of engine/section/tendon_law.h, there with v = R^T p_s. No row divides by a
// stiffness; a rigid mode is a zero of C_bt, C_se. Everything but (1) is unchanged by q -> a q, and
// a constant left factor of q turns the frame: rows (2)-(5) turn with it. Source: Weeger, Yeung,
// Dunn, CMAME 316 (2017) 100-122, whose mixed rows these are; that (2), (3) are as many as (4), (5)
// is explained in engine/rod/collocation.h.
#pragma once

#include "engine/math/types.h"
#include "engine/section/fluid_section.h"
#include "engine/section/outer_field.h"
#include "engine/section/tendon_section.h"

namespace cprsim {

using Vec13 = Eigen::Matrix<double, 13, 1>;
using Mat13 = Eigen::Matrix<double, 13, 13>;

/// Where fields stand in a Vec13: q = (w, x, y, z), p, n, m; and rows (1), (2); (3); (4); (5).
/// Increments of a control point: relative growth of |q|, rotation phi (world), then dp, dn, dm.
constexpr int kQ = 0, kP = 4, kN = 7, kM = 10;

/// What all points of a rod share during one solve.
struct PointModel {
  Vec3 C_bt = Vec3::Zero(), C_se = Vec3::Zero();
  double k = 0;  ///< N/m²
  bool rotary = false;
  double rhoJ[3] = {};      ///< section inertia, kg m
  double c_v = 0, c_w = 0;  ///< engine/time/scheme.h, for the rotary term and a fluid
  bool body_rates = false;
  const OuterField* field = nullptr;  ///< around it, if it is magnetised
};

/// Rotary inertia at a point (engine/section/rotary.h); rotations row-major.
struct PointSpin {
  double R[9] = {}, R_start[9] = {};
  double theta_h[3] = {}, omega_h[3] = {};  ///< histories
  double theta[3] = {}, theta_t[3] = {}, omega[3] = {}, omega_t[3] = {};
  double torque[3] = {}, torque_phi[9] = {};  ///< t of (5), and by the world rotation increment
};

struct CollocationPoint {
  Vec3 u0 = Vec3::Zero(), v0 = Vec3::UnitZ(), b = Vec3::Zero();  ///< inputs of the balance
  PointSpin spin;

  // what the last evaluation found
  Vec13 y = Vec13::Zero(), y_s = Vec13::Zero();  ///< fields and their derivatives by arc length
  Mat3 R = Mat3::Identity();
  Vec3 u = Vec3::Zero(), v = Vec3::UnitZ();  ///< u of the motion, v of the law

  Vec3 p() const { return y.segment<3>(kP); }

  Vec3 n() const { return y.segment<3>(kN); }

  Vec3 m() const { return y.segment<3>(kM); }
};

/// R(q / |q|).
Mat3 rotation_of(const Vec4& q);

/// The unit quaternion of the rotation vector (rad), and of a rotation matrix.
Vec4 quaternion_of(const Vec3& turn);
Vec4 quaternion_of(const Mat3& R);

/// a b.
Vec4 quaternion_product(const Vec4& a, const Vec4& b);

/// phi = G dq: the world rotation increment that an increment of q makes.
Eigen::Matrix<double, 3, 4> turn_by_quaternion(const Vec4& q);

/// dq of a control point = [q, ½ (0, e_i) q] (growth, phi).
Eigen::Matrix4d quaternion_by_increment(const Vec4& q);

/// Reads y, y_s and the inputs, fills the rest. @return left minus right sides of (1) to (5).
/// @param fluid, tendons at this point, evaluated, too; null without any
Vec13 evaluate_point(const PointModel& model, CollocationPoint& point,
                     FluidSection* fluid = nullptr, TendonSection* tendons = nullptr);

/// Derivatives of these rows by y and y_s, after evaluate_point().
void linearize_point(const PointModel& model, const CollocationPoint& point, Mat13& by_y,
                     Mat13& by_y_s, const FluidSection* fluid = nullptr,
                     const TendonSection* tendons = nullptr);

}  // namespace cprsim
