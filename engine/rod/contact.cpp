// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/contact.h"

#include "engine/math/so3.h"

namespace cprsim {
namespace {

/// P a and its derivative by n: d(P a) = -(n.a) dn - n (a.dn).
Mat3 projected_by_n(const Vec3& n, const Vec3& a) {
  return -n.dot(a) * Mat3::Identity() - n * a.transpose();
}

}  // namespace

Distance distance_to(const Surface& surface, const Pose& X_WC, const Vec3& x) {
  if (!surface.mesh) return distance_to(*surface.shape, X_WC, x);
  return carried((*surface.mesh)(X_WC.inverse() * x), X_WC.R);
}

namespace {

/// (3) to (5), of what is rigid.
GripRows rigid_rows(const RodContact& contact, double gap, const Vec3& n, const Vec3& u,
                    const ContactScale& scale) {
  const Mat3 P = Mat3::Identity() - n * n.transpose();
  const Vec3 f = contact.force / scale.force, rate = u / scale.rate;
  GripRows row;
  row.value = gap / scale.length * n;
  row.by_gap = n / scale.length;
  row.by_n = gap / scale.length * Mat3::Identity();
  const Mat3 give = scale.axial_compliance / scale.length * contact.axis * contact.axis.transpose();
  const Vec3 given = give * (contact.force - contact.held);
  if (contact.grip == Grip::kStick) {
    row.by_force = give;
    row.value += P * rate + given;
    row.by_n += projected_by_n(n, rate);
    row.by_u = P / scale.rate;
    return row;
  }
  row.value += P * f;
  row.by_n += projected_by_n(n, f);
  row.by_force = P / scale.force;
  if (contact.grip == Grip::kSmooth) return row;
  // tau = P w. A contact that pulls will be dropped: until then (5) goes on as it was, lest
  // Newton's method stop at the kink
  const double limit = contact.most_friction(n.dot(contact.force)) / scale.force;
  const bool pulls = !(limit > 0), by_pressure = contact.bound < 0;
  const double kappa = contact.kappa;
  Vec3 w = -kappa * (rate + given);
  Mat3 w_by_force = -kappa * give;
  if (!pulls) {
    w += f;
    w_by_force += Mat3::Identity() / scale.force;
  }
  const Vec3 tau = P * w;
  const double size = tau.norm();
  if (pulls && !(size > 0)) return row;
  if (contact.may_rest && size <= limit) {
    row.value -= tau;
    row.by_n -= projected_by_n(n, w);
    row.by_u = kappa / scale.rate * P;
    row.by_force -= P * w_by_force;
    return row;
  }
  const Vec3 along = tau / size;
  const Mat3 turn = limit * (Mat3::Identity() - along * along.transpose()) / size;
  row.value -= limit * along;
  row.by_n -= turn * projected_by_n(n, w);
  row.by_u += kappa / scale.rate * turn * P;
  row.by_force -= turn * P * w_by_force;
  if (by_pressure) {
    row.by_n -= contact.friction * along * f.transpose();
    row.by_force -= contact.friction / scale.force * along * n.transpose();
  }
  return row;
}

}  // namespace

GripRows grip_rows(const RodContact& contact, double gap, const Vec3& n, const Vec3& u,
                   const ContactScale& scale) {
  if (contact.give == 0) return rigid_rows(contact, gap, n, u, scale);
  // (7)
  const Vec3 yields = contact.give * contact.force + contact.lag * u;
  GripRows row = rigid_rows(contact, gap + n.dot(yields), n, u, scale);
  row.by_n += row.by_gap * yields.transpose();
  row.by_u += contact.lag * row.by_gap * n.transpose();
  row.by_force += contact.give * row.by_gap * n.transpose();
  return row;
}

double contact_loss(const RodContact& contact, const ContactRows& rows) {
  if (contact.give == 0) return -contact.force.dot(rows.slip);
  const double rate = rows.at.n.dot(rows.slip);
  const Vec3 rubs = rows.slip - rate * rows.at.n;
  return contact.lag / contact.give * rate * rate - contact.force.dot(rubs);
}

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

// (6)
Vec3 contact_velocity(double xi, const Vec3& l, const ContactEnds& ends) {
  const ContactWeights c(xi);
  Vec3 u = Vec3::Zero();
  for (int a = 0; a < (xi == 0 ? 1 : 2); ++a) {
    const ContactNode& end = ends.node[a];
    u += c.H[a] * end.v + c.G[a] * ends.h * end.w.cross(end.t) + c.S[a] * end.w.cross(l);
  }
  return u;
}

void carry_to_ends(double xi, const Vec3& l, const ContactEnds& ends, const Mat3& by_x,
                   const Mat3& by_u, Mat3 by_phi[2], Mat3 by_p[2]) {
  const ContactWeights c(xi);
  for (int a = 0; a < (xi == 0 ? 1 : 2); ++a) {
    const ContactNode& end = ends.node[a];
    // d(w × t) = dw × t + w × (phi × t)
    const Mat3 turning = -(hat(end.t) * end.w_by_phi + hat(end.w) * hat(end.t));
    by_p[a] = c.H[a] * (by_x + end.v_by_p * by_u);
    by_phi[a] = -c.G[a] * ends.h * by_x * hat(end.t) +
                by_u * (c.G[a] * ends.h * turning - c.S[a] * hat(l) * end.w_by_phi);
  }
}

ContactRows contact_rows(const RodContact& contact, const Surface& surface, double radius,
                         const ContactEnds& ends, const ContactScale& scale) {
  ContactRows rows;
  rows.slip = contact_velocity(contact.xi, contact.lever, ends);
  rows.at = distance_to(surface, surface.X_WC, contact_point(contact.xi, ends.h, ends.node));
  const GripRows row =
      grip_rows(contact, rows.at.d - radius - contact.sunk, rows.at.n, rows.slip, scale);
  rows.value = row.value;
  rows.by_force = row.by_force;
  carry_to_ends(contact.xi, contact.lever, ends,
                row.by_gap * rows.at.n.transpose() + row.by_n * rows.at.H, row.by_u, rows.by_phi,
                rows.by_p);
  return rows;
}

namespace {

constexpr std::size_t kMostContacts = 100'000;

/// An enumerator, none beyond `last`.
template <class Enum>
void visit(Enum& value, Enum last, Archive& archive) {
  auto number = static_cast<std::size_t>(value);
  number = archive.count(number, static_cast<std::size_t>(last));
  value = static_cast<Enum>(number);
}

}  // namespace

void visit(std::vector<RodContact>& contacts, Archive& archive) {
  contacts.resize(archive.count(contacts.size(), kMostContacts));
  for (RodContact& c : contacts) {
    archive(c.surface);
    archive(c.cell);
    archive(c.xi);
    visit(c.grip, Grip::kTie, archive);
    archive(c.friction);
    archive(c.may_rest);
    for (double* value : {&c.bound, &c.sunk, &c.give, &c.lag, &c.kappa})
      archive(*value);
    for (Vec3* vector : {&c.lever, &c.axis, &c.arm, &c.held, &c.force})
      archive(*vector);
    visit(c.role, ContactRole::kEcho, archive);
    for (int* index : {&c.body, &c.other_rod, &c.partner})
      archive(*index);
    archive(c.other_cell);
    archive(c.other_xi);
    archive(c.other_lever);
  }
}

void visit(std::vector<ContactRows>& rows, Archive& archive) {
  rows.resize(archive.count(rows.size(), kMostContacts));
  for (ContactRows& row : rows) {
    archive(row.at.d);
    archive(row.at.n);
    archive(row.slip);
  }
}

}  // namespace cprsim
