// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/body_contact.h"

#include "engine/math/so3.h"

namespace cprsim {

void visit(std::vector<BodyContact>& contacts, Archive& archive) {
  std::vector<RodContact> laws;
  for (const BodyContact& contact : contacts)
    laws.push_back(contact.law);
  visit(laws, archive);
  contacts.resize(laws.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts[i].law = laws[i];
    archive(contacts[i].probe);
    archive(contacts[i].at);
    archive(contacts[i].bounce);
    archive(contacts[i].give);
    archive(contacts[i].fresh);
  }
}

BodyContactRows rows_between(const BodyProbe& probe, const BodyContact& contact,
                             const MovingBody& body, const MovingBody& other,
                             const ContactScale& scale) {
  const RodContact& law = contact.law;
  BodyContactRows rows;
  rows.x = body.X * contact.at;
  rows.y = rows.x + law.lever;
  rows.at = distance_to(probe.surface, other.X * probe.surface.X_WC, rows.x);
  const Vec3& n = rows.at.n;
  const PointMotion own(body, rows.y), opposite(other, rows.y);
  rows.slip = own.v - opposite.v;
  // (3), or (4) as a length
  const double time = scale.length / scale.rate, given = contact.give * n.dot(law.force);
  const bool bounces = contact.bounce > 0;
  const double gap =
      bounces ? time * (n.dot(rows.slip) - contact.bounce) : rows.at.d - probe.radius - law.sunk;
  GripRows row = grip_rows(law, gap + given, n, rows.slip, scale);
  row.by_n += contact.give * row.by_gap * law.force.transpose();
  row.by_force += contact.give * row.by_gap * n.transpose();
  Mat3 by_d = row.by_gap * n.transpose();
  if (bounces) {
    row.by_n += time * row.by_gap * rows.slip.transpose();
    row.by_u += time * by_d;
    by_d.setZero();
  }
  if (law.grip == Grip::kStick) {  // (3)
    const double unit = contact.give / scale.length;
    const Vec3 more = law.force - law.held;
    row.value += unit * (more - n.dot(more) * n);
    row.by_n += unit * (-n.dot(more) * Mat3::Identity() - n * more.transpose());
    row.by_force += unit * (Mat3::Identity() - n * n.transpose());
  }
  rows.value = row.value;
  rows.by_force = row.by_force;
  // x and y move with the body that has the point: dx = dy = dp + phi × (x - p)
  const Mat3 by_distance = by_d + row.by_n * rows.at.H;
  const Mat3 by_x = by_distance + row.by_u * (own.by_y - opposite.by_y);
  rows.by_body << row.by_u * own.by_phi - by_x * hat(rows.x - body.X.p), by_x + row.by_u * own.by_p;
  // the other carries the normal along: dn = H (dx - dp - phi × (x - p)) + phi × n
  rows.by_other << by_distance * hat(rows.x - other.X.p) - row.by_n * hat(n) -
                       row.by_u * opposite.by_phi,
      -by_distance - row.by_u * opposite.by_p;
  return rows;
}

}  // namespace cprsim
