// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/contact_pair.h"

#include "engine/math/so3.h"

namespace cprsim {
namespace {

// eps of (3): rods that cross at less than about sqrt(2 eps), 8 degrees, are taken for parallel
constexpr double kParallel = 0.01;

/// dx/dxi / h of the Hermite curve: weights of p over h and of t.
struct SlopeWeights {
  double H[2], G[2];

  explicit SlopeWeights(double xi)
      : H{6 * xi * (xi - 1), 6 * xi * (1 - xi)}, G{(1 - xi) * (1 - 3 * xi), xi * (3 * xi - 2)} {}
};

Vec3 slope(double xi, const ContactEnds& ends) {
  if (xi == 0) return ends.node[0].t;
  const SlopeWeights c(xi);
  Vec3 b = Vec3::Zero();
  for (int a = 0; a < 2; ++a)
    b += c.H[a] / ends.h * ends.node[a].p + c.G[a] * ends.node[a].t;
  return b;
}

/// Puts what carry_to_ends() found side by side.
Mat3x12 side_by_side(double xi, const Mat3 by_phi[2], const Mat3 by_p[2]) {
  Mat3x12 out = Mat3x12::Zero();
  out << by_phi[0], by_p[0], by_phi[1], by_p[1];
  if (xi == 0) out.rightCols<6>().setZero();
  return out;
}

Mat3x12 by_ends_of(double xi, const Vec3& l, const ContactEnds& ends, const Mat3& by_x,
                   const Mat3& by_u) {
  Mat3 by_phi[2] = {Mat3::Zero(), Mat3::Zero()}, by_p[2] = {Mat3::Zero(), Mat3::Zero()};
  carry_to_ends(xi, l, ends, by_x, by_u, by_phi, by_p);
  return side_by_side(xi, by_phi, by_p);
}

Mat3x12 slope_by_ends(double xi, const ContactEnds& ends) {
  Mat3x12 out = Mat3x12::Zero();
  if (xi == 0) {
    out.leftCols<3>() = -hat(ends.node[0].t);
    return out;
  }
  const SlopeWeights c(xi);
  for (int a = 0; a < 2; ++a) {
    out.middleCols<3>(6 * a) = -c.G[a] * hat(ends.node[a].t);
    out.middleCols<3>(6 * a + 3) = c.H[a] / ends.h * Mat3::Identity();
  }
  return out;
}

}  // namespace

Mat3x12 point_by_ends(double xi, const ContactEnds& ends) {
  return by_ends_of(xi, Vec3::Zero(), ends, Mat3::Identity(), Mat3::Zero());
}

MovingBody moving_body(const RigidBody& body, const StageRates& rates, const Pose& X_0) {
  MovingBody out;
  out.X = body.pose();
  out.X_0 = X_0;
  out.rates = rates.dynamic();
  if (!out.rates) return out;
  out.v = rates.c_v * body.p + body.position.x_h;
  out.v_by_p = rates.c_v;
  const RigidBody::Turning turning = body.turning(rates);
  out.w = body.R * turning.omega;
  out.w_by_phi = turning.by_phi - hat(out.w);
  return out;
}

PointMotion::PointMotion(const MovingBody& body, const Vec3& y) {
  const Vec3 arm = y - body.X.p;
  if (body.rates) {
    v = body.v + body.w.cross(arm);
    by_y = hat(body.w);
    by_p = body.v_by_p * Mat3::Identity() - by_y;
    by_phi = -hat(arm) * body.w_by_phi;
    return;
  }
  const Mat3 back = body.X_0.R * body.X.R.transpose();
  v = y - body.X_0.p - back * arm;
  by_y = Mat3::Identity() - back;
  by_p = back;
  by_phi = -back * hat(arm);
}

PairRows rows_with_world(const RodContact& contact, const Surface& surface, double radius,
                         const ContactEnds& ends, const ContactScale& scale) {
  const ContactRows rows = contact_rows(contact, surface, radius, ends, scale);
  PairRows out;
  out.value = rows.value;
  out.by_force = rows.by_force;
  out.at = rows.at;
  out.slip = rows.slip;
  for (int end = 0; end < (contact.at_node() ? 1 : 2); ++end)
    out.by_ends.middleCols<6>(6 * end) << rows.by_phi[end], rows.by_p[end];
  return out;
}

PairRows rows_with_body(const RodContact& contact, const Surface& surface, const MovingBody& body,
                        double radius, const ContactEnds& ends, const ContactScale& scale) {
  PairRows rows;
  const Vec3 x = contact_point(contact.xi, ends.h, ends.node), y = x + contact.lever;
  rows.at = distance_to(surface, body.X * surface.X_WC, x);
  const Vec3& n = rows.at.n;
  const PointMotion under(body, y);
  rows.slip = contact_velocity(contact.xi, contact.lever, ends) - under.v;
  const GripRows row = grip_rows(contact, rows.at.d - radius - contact.sunk, n, rows.slip, scale);
  rows.value = row.value;
  rows.by_force = row.by_force;
  const Mat3 by_distance = row.by_gap * n.transpose() + row.by_n * rows.at.H;
  rows.by_ends =
      by_ends_of(contact.xi, contact.lever, ends, by_distance - row.by_u * under.by_y, row.by_u);
  // the body's motion carries the normal along: dn = H (dx - dp - phi × (x - p)) + phi × n
  rows.by_body.leftCols<3>() =
      by_distance * hat(x - body.X.p) - row.by_n * hat(n) - row.by_u * under.by_phi;
  rows.by_body.rightCols<3>() = -by_distance - row.by_u * under.by_p;
  return rows;
}

PairRows rows_with_rod(const RodContact& contact, const RodSide& own, const RodSide& other,
                       const ContactScale& scale) {
  const double xi = contact.xi, other_xi = contact.other_xi;
  const Vec3 g = contact_point(xi, own.ends.h, own.ends.node) -
                 contact_point(other_xi, other.ends.h, other.ends.node);
  // (3)
  Eigen::Matrix<double, 3, 2> B = Eigen::Matrix<double, 3, 2>::Zero();
  if (!own.at_end) B.col(0) = slope(xi, own.ends);
  if (!other.at_end) B.col(1) = slope(other_xi, other.ends);
  const Eigen::Matrix2d A = B.transpose() * B + kParallel * Eigen::Matrix2d::Identity();
  const Eigen::Matrix<double, 3, 2> BK = B * A.inverse();
  const Vec2 y = BK.transpose() * g;
  const Vec3 m = g - B * y;
  const double side = m.dot(contact.lever) > 0 ? -1 : 1, d = side * m.norm();
  PairRows rows;
  rows.at.d = d - other.radius;
  rows.at.n = m / d;
  rows.at.H = (Mat3::Identity() - rows.at.n * rows.at.n.transpose()) / d;
  rows.slip = contact_velocity(xi, contact.lever, own.ends) -
              contact_velocity(other_xi, contact.other_lever, other.ends);
  const GripRows row =
      grip_rows(contact, rows.at.d - own.radius - contact.sunk, rows.at.n, rows.slip, scale);
  rows.value = row.value;
  rows.by_force = row.by_force;
  // dm = M (dg - dB y) - B K dB^T m
  const Mat3 by_m = row.by_gap * rows.at.n.transpose() + row.by_n * rows.at.H;
  const Mat3 M = Mat3::Identity() - BK * B.transpose(), by_g = by_m * M;
  const auto by_slope = [&](int i) -> Mat3 {
    return by_m * (-y[i] * M - BK.col(i) * m.transpose());
  };
  rows.by_ends = by_ends_of(xi, contact.lever, own.ends, by_g, row.by_u);
  if (!own.at_end) rows.by_ends += by_slope(0) * slope_by_ends(xi, own.ends);
  rows.by_other = by_ends_of(other_xi, contact.other_lever, other.ends, -by_g, -row.by_u);
  if (!other.at_end) rows.by_other += by_slope(1) * slope_by_ends(other_xi, other.ends);
  return rows;
}

PairRows tie_rows(const Vec3& arm, const Vec3& other_arm, const ContactEnds& own,
                  const ContactEnds& other, const ContactScale& scale) {
  const ContactNode &a = own.node[0], &b = other.node[0];
  const Vec3 l = a.R * arm, other_l = b.R * other_arm;
  const double unit = 1 / scale.length;
  PairRows rows;
  rows.value = unit * (a.p + l - b.p - other_l);
  rows.by_ends.leftCols<6>() << -unit * hat(l), unit * Mat3::Identity();
  rows.by_other.leftCols<6>() << unit * hat(other_l), -unit * Mat3::Identity();
  rows.slip.setZero();
  return rows;
}

}  // namespace cprsim
