// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/contact.h"

#include "engine/math/so3.h"

namespace cprsim {
namespace {

/// P a and its derivative by x through n alone: d(P a) = -(n.a) H dx - n (a^T H dx).
Mat3 projected_by_x(const Distance& at, const Vec3& a) {
  return -at.n.dot(a) * at.H - at.n * (a.transpose() * at.H);
}

/// value += part; derivatives by x, u and f of one term.
struct Term {
  Vec3 value = Vec3::Zero();
  Mat3 by_x = Mat3::Zero(), by_u = Mat3::Zero(), by_f = Mat3::Zero();
};

Term tangential_row(const RodContact& contact, const Distance& at, const Vec3& u,
                    const ContactScale& scale) {
  const Mat3 P = Mat3::Identity() - at.n * at.n.transpose();
  const Vec3 f = contact.force / scale.force, rate = u / scale.rate;
  Term row;
  if (contact.grip == Grip::kStick) {
    row.value = P * rate;
    row.by_x = projected_by_x(at, rate);
    row.by_u = P / scale.rate;
    row.by_f = scale.axial_compliance / scale.length * contact.axis * contact.axis.transpose();
    row.value += row.by_f * (contact.force - contact.held);
    return row;
  }
  row.value = P * f;
  row.by_x = projected_by_x(at, f);
  row.by_f = P / scale.force;
  if (contact.grip == Grip::kSmooth) return row;
  // tau / |tau| with tau = P w
  const Vec3 w = f - contact.kappa * rate, tau = P * w;
  const double size = tau.norm();
  if (!(size > 0)) return row;
  const Vec3 along = tau / size;
  const Mat3 turn = (Mat3::Identity() - along * along.transpose()) / size;
  const double mu_n = contact.friction * at.n.dot(f);
  row.value -= mu_n * along;
  row.by_x -=
      mu_n * turn * projected_by_x(at, w) + contact.friction * along * (f.transpose() * at.H);
  row.by_u += mu_n * contact.kappa / scale.rate * turn * P;
  row.by_f -= (mu_n * turn * P + contact.friction * along * at.n.transpose()) / scale.force;
  return row;
}

}  // namespace

ContactWeights::ContactWeights(double xi)
    : H{(1 + 2 * xi) * (1 - xi) * (1 - xi), xi * xi * (3 - 2 * xi)},
      G{xi * (1 - xi) * (1 - xi), xi * xi * (xi - 1)},
      S{1 - xi, xi} {}

Vec3 contact_point(double xi, double h, const ContactNode ends[2]) {
  const ContactWeights c(xi);
  Vec3 x = c.H[0] * ends[0].p + c.G[0] * h * ends[0].t;
  if (xi > 0) x += c.H[1] * ends[1].p + c.G[1] * h * ends[1].t;
  return x;
}

ContactRows contact_rows(const RodContact& contact, const Surface& surface, double radius, double h,
                         const ContactNode ends[2], const ContactScale& scale) {
  const ContactWeights c(contact.xi);
  const int count = contact.at_node() ? 1 : 2;
  const Vec3& l = contact.lever;
  ContactRows rows;
  rows.slip.setZero();
  // (6)
  for (int a = 0; a < count; ++a) {
    const ContactNode& end = ends[a];
    rows.slip += c.H[a] * end.v + c.G[a] * h * end.w.cross(end.t) + c.S[a] * end.w.cross(l);
  }
  rows.at = distance_to(*surface.shape, surface.X_WC, contact_point(contact.xi, h, ends));
  const Vec3& n = rows.at.n;
  const double gap = (rows.at.d - radius) / scale.length;
  const Term row = tangential_row(contact, rows.at, rows.slip, scale);
  rows.value = gap * n + row.value;
  const Mat3 by_x = gap * rows.at.H + n * n.transpose() / scale.length + row.by_x;
  rows.by_force = row.by_f;
  for (int a = 0; a < count; ++a) {
    const ContactNode& end = ends[a];
    // d(w × t) = dw × t + w × (phi × t)
    const Mat3 turning = -(hat(end.t) * end.w_by_phi + hat(end.w) * hat(end.t));
    rows.by_p[a] = c.H[a] * (by_x + end.v_by_p * row.by_u);
    rows.by_phi[a] = -c.G[a] * h * by_x * hat(end.t) +
                     row.by_u * (c.G[a] * h * turning - c.S[a] * hat(l) * end.w_by_phi);
  }
  return rows;
}

}  // namespace cprsim
