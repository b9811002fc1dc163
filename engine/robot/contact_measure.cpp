// SPDX-License-Identifier: BSD-3-Clause
// How near two are, for those who ask (Scene::watched).
#include <cmath>
#include <limits>

#include "engine/robot/contacts.h"

namespace cprsim {

ContactPair RodContacts::pair_of(const Rod& rod, const Obstacle& obstacle) const {
  const int own = static_cast<int>(rod.index);
  if (obstacle.rod < 0) return {ContactParty{true, own}, ContactParty{false, obstacle.link}};
  const Rod& other = rods_[static_cast<std::size_t>(obstacle.rod)];
  return {ContactParty{true, own}, ContactParty{true, static_cast<int>(other.index)}};
}

/// How near a pair is, wherever it is nearest. Infinitely far where nothing is to meet.
PairDistance RodContacts::measure(const ContactPair& pair) const {
  PairDistance out;
  out.pair = pair;
  out.gap = std::numeric_limits<double>::infinity();
  for (const Rod& rod : rods_)
    for (std::size_t o = 0; o < rod.obstacles.size(); ++o) {
      const Obstacle& obstacle = rod.obstacles[o];
      if (!same_pair(pair, pair_of(rod, obstacle))) continue;
      const std::size_t cells = rod.side->contact_nodes().size() - 1;
      const auto look = [&](std::size_t cell, double xi) {
        const Distance at = distance(rod, o, cell, xi);
        if (at.d - rod.radius >= out.gap) return;
        out.gap = at.d - rod.radius;
        out.position = point(rod, cell, xi) - rod.radius * at.n;
      };
      std::vector<double> ends(cells + 1);
      for (std::size_t c = 0; c <= cells; ++c) {
        ends[c] = c < cells ? distance(rod, o, c, 0).d : distance(rod, o, c - 1, 1).d;
        c < cells ? look(c, 0) : look(c - 1, 1);
      }
      for (std::size_t c = 0; c < cells; ++c) {
        // no walk along the cell leads nearer than this (see scan())
        const double walk = (obstacle.itself ? 2.2 : 1.1) * length(rod, c);
        const double bound =
            std::isfinite(ends[c + 1]) ? 0.5 * (ends[c] + ends[c + 1] - walk) : ends[c] - walk;
        if (bound - rod.radius >= out.gap) continue;
        double xi = 0;
        lowest(rod, o, c, xi);
        look(c, xi);
      }
    }
  return out;
}

ContactSample RodContacts::sample() {
  ContactSample out;
  bodies_.add_to(out);
  for (Rod& rod : rods_) {
    if (far_away(rod)) continue;
    scan(rod);
    out.penetration = std::max(out.penetration, -rod.scan.clearance);
    const std::vector<RodContact>& contacts = rod.side->contacts();
    const std::vector<ContactRows>& rows = rod.side->contact_state();
    for (std::size_t i = 0; i < contacts.size() && i < rows.size(); ++i) {
      if (!contacts[i].found()) continue;
      const Vec3& n = rows[i].at.n;
      const double pressure = n.dot(contacts[i].force);
      ContactPoint at;
      at.rod = static_cast<int>(rod.index);
      at.position = point(rod, contacts[i].cell, contacts[i].xi) - rod.radius * n;
      at.normal = n;
      at.force = contacts[i].force;
      at.slip = rows[i].slip - n.dot(rows[i].slip) * n;
      at.gap = rows[i].at.d - rod.radius;
      at.other = pair_of(rod, rod.obstacles[static_cast<std::size_t>(contacts[i].surface)])[1];
      out.points.push_back(at);
      ++out.count;
      out.force += pressure;
      out.friction += (contacts[i].force - pressure * n).norm();
      out.slip = std::max(out.slip, at.slip.norm());
    }
  }
  for (const ContactPair& pair : robot_.scene->watched)
    if (pair[0].rod || pair[1].rod) out.distances.push_back(measure(pair));
  return out;
}

}  // namespace cprsim
