// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/contacts.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cprsim {
namespace {

// of the robot's force: pulls below are round-off
constexpr double kPull = 1e-9;
// from this round on one change at a time
constexpr int kPatience = 12;

/// Before: contacts within a cell come after the node at its start.
double order(const RodContact& contact) {
  return static_cast<double>(contact.cell) + (contact.at_node() ? 0 : 0.5);
}

bool may_touch(const SurfaceSpec& a, const SurfaceSpec& b) {
  return ((a.category_bitmask & b.collide_bitmask) | (b.category_bitmask & a.collide_bitmask)) != 0;
}

}  // namespace

RodContacts::RodContacts(Robot& robot) : robot_(robot) {
  const Scene& scene = *robot.scene;
  friction_ = scene.effects.has(Effect::kFriction);
  if (!scene.effects.has(Effect::kContact)) return;
  for (RobotRod& rod : robot.rods) {
    Rod mine;
    mine.rod = &rod;
    mine.side = rod.model->touching();
    mine.radius = rod.section.half_width;
    if (rod.spec->lacks("contact")) continue;
    std::vector<Surface> surfaces;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (robot.links[i].body != LinkPlace::kGround) continue;
      for (const ColliderSpec& collider : scene.bodies[i].colliders) {
        if (!has_distance(collider.shape.kind) || !may_touch(collider.surface, rod.spec->surface))
          continue;
        const Surface surface{&collider.shape, robot.links[i].X * collider.X_BC};
        const double friction = collider.surface.friction * rod.spec->surface.friction;
        mine.obstacles.push_back({scene.bodies[i].name + "::" + collider.name, surface,
                                  friction_ ? friction : 0,
                                  collider.shape.kind == ShapeKind::kPlane});
        surfaces.push_back(surface);
      }
    }
    if (surfaces.empty()) continue;
    if (!mine.side)
      throw std::invalid_argument("rod '" + rod.spec->name +
                                  "' may touch obstacles: only method shooting in space can");
    mine.side->set_surfaces(surfaces, mine.radius, friction_);
    rods_.push_back(std::move(mine));
  }
}

// Of neighbours that pull, only the hardest lets go: the others may press once it has.
bool RodContacts::pulls_most(const Rod& rod, std::size_t contact) const {
  const std::vector<RodContact>& contacts = rod.side->contacts();
  const std::vector<ContactRows>& rows = rod.side->contact_state();
  const auto pressure = [&](std::size_t i) { return rows[i].at.n.dot(contacts[i].force); };
  const double own = pressure(contact);
  return own < 0 && (contact == 0 || own <= pressure(contact - 1)) &&
         (contact + 1 == contacts.size() || own <= pressure(contact + 1));
}

// Points that pull go; beyond the friction cone stick becomes slip, and slip along the friction
// force stick.
void RodContacts::review(std::size_t index, std::vector<Change>& changes) const {
  const Rod& rod = rods_[index];
  const std::vector<RodContact>& contacts = rod.side->contacts();
  const std::vector<ContactRows>& rows = rod.side->contact_state();
  const double unit = robot_.scale.force;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const RodContact& contact = contacts[i];
    const Vec3& n = rows[i].at.n;
    const double pressure = n.dot(contact.force);
    const Vec3 grip = contact.force - pressure * n, slip = rows[i].slip - n.dot(rows[i].slip) * n;
    Change change{0, index, static_cast<int>(i), false, contact};
    if (pressure < -kPull * unit) {
      if (!pulls_most(rod, i)) continue;
      change.urgency = -pressure / unit;
      change.drop = true;
    } else if (contact.grip == Grip::kStick &&
               grip.norm() > contact.friction * pressure + kPull * unit) {
      change.urgency = (grip.norm() - contact.friction * pressure) / unit;
      change.contact.grip = Grip::kSlip;
    } else if (contact.grip == Grip::kSlip && slip.dot(grip) > 0) {
      change.urgency = grip.norm() / unit;
      change.contact.grip = Grip::kStick;
    } else {
      continue;
    }
    changes.push_back(change);
  }
}

void RodContacts::apply(const std::vector<Change>& changes) {
  for (std::size_t r = 0; r < rods_.size(); ++r) {
    std::vector<RodContact> next;
    std::vector<RodContact>& contacts = rods_[r].side->contacts();
    std::vector<char> gone(contacts.size(), 0);
    for (const Change& change : changes) {
      if (change.rod != r) continue;
      if (change.existing < 0) {
        next.push_back(change.contact);
      } else if (change.drop) {
        gone[static_cast<std::size_t>(change.existing)] = 1;
      } else {
        contacts[static_cast<std::size_t>(change.existing)] = change.contact;
      }
    }
    for (std::size_t i = 0; i < contacts.size(); ++i)
      if (!gone[i]) next.push_back(contacts[i]);
    std::stable_sort(next.begin(), next.end(),
                     [](const RodContact& a, const RodContact& b) { return order(a) < order(b); });
    contacts = std::move(next);
  }
}

bool RodContacts::revise(int round) {
  bool again = false;
  std::vector<Change> changes;
  for (std::size_t r = 0; r < rods_.size(); ++r) {
    Rod& rod = rods_[r];
    if (far_away(rod)) continue;
    scan(rod);
    std::vector<RodContact>& contacts = rod.side->contacts();
    for (std::size_t i = 0; i < contacts.size(); ++i)
      if (follow(rod, contacts[i], rod.side->contact_state()[i])) again = true;
    review(r, changes);
    search(r, changes);
  }
  if (changes.empty() && !again) return false;
  if (round >= kPatience && !changes.empty()) {
    const auto worst =
        std::max_element(changes.begin(), changes.end(),
                         [](const Change& a, const Change& b) { return a.urgency < b.urgency; });
    changes = {*worst};
  }
  apply(changes);
  return true;
}

bool RodContacts::touching() const {
  return std::any_of(rods_.begin(), rods_.end(), [](const Rod& rod) { return touches(rod); });
}

void RodContacts::begin_step() {
  for (Rod& rod : rods_) {
    rod.before = rod.side->contacts();
    // while a rod is far away, the distances of an older scan will do
    if (rod.scan.nodes.empty() || touches(rod) || 8 * moved(rod, rod.scan) >= rod.scan.clearance)
      scan(rod);
    rod.start = rod.scan;
  }
}

bool RodContacts::changed() const {
  return std::any_of(rods_.begin(), rods_.end(), [](const Rod& rod) {
    const std::vector<RodContact>& now = rod.side->contacts();
    const auto alike = [](const RodContact& a, const RodContact& b) {
      return a.surface == b.surface && a.grip == b.grip;
    };
    return now.size() != rod.before.size() ||
           !std::equal(now.begin(), now.end(), rod.before.begin(), alike);
  });
}

bool RodContacts::leapt() const {
  for (const Rod& rod : rods_) {
    if (2 * moved(rod, rod.start) < rod.start.clearance) continue;
    const std::vector<NodeState>& nodes = rod.side->contact_nodes();
    const std::vector<RodContact>& contacts = rod.side->contacts();
    for (std::size_t c = 0; c < rod.start.cells.size(); ++c) {
      const Near& near = rod.start.cells[c];
      if (!near.solid) continue;
      const double far = std::max((position_of(nodes[c]) - rod.start.nodes[c]).norm(),
                                  (position_of(nodes[c + 1]) - rod.start.nodes[c + 1]).norm());
      if (far <= 0.5 * near.distance) continue;
      const bool held_back =
          std::any_of(contacts.begin(), contacts.end(), [&](const RodContact& contact) {
            return (contact.cell == c || (contact.at_node() && contact.cell == c + 1)) &&
                   contact.lever.dot(near.normal) < -0.5 * rod.radius;
          });
      if (!held_back) return true;
    }
  }
  return false;
}

std::string RodContacts::overlap() {
  for (Rod& rod : rods_) {
    scan(rod);
    if (rod.scan.clearance >= -kContactTolerance * rod.radius) continue;
    for (std::size_t o = 0; o < rod.obstacles.size(); ++o)
      for (std::size_t c = 0; c < rod.scan.cells.size(); ++c) {
        double xi = 0;
        const double gap = lowest(rod, o, c, xi) - rod.radius;
        if (gap < -kContactTolerance * rod.radius)
          return "rod '" + rod.rod->spec->name + "' begins inside '" + rod.obstacles[o].name + "'";
      }
  }
  return {};
}

ContactSample RodContacts::sample() {
  ContactSample out;
  for (Rod& rod : rods_) {
    if (far_away(rod)) continue;
    scan(rod);
    out.penetration = std::max(out.penetration, -rod.scan.clearance);
    const std::vector<RodContact>& contacts = rod.side->contacts();
    const std::vector<ContactRows>& rows = rod.side->contact_state();
    for (std::size_t i = 0; i < contacts.size() && i < rows.size(); ++i) {
      const Vec3& n = rows[i].at.n;
      const double pressure = n.dot(contacts[i].force);
      ++out.count;
      out.force += pressure;
      out.friction += (contacts[i].force - pressure * n).norm();
      out.slip = std::max(out.slip, (rows[i].slip - n.dot(rows[i].slip) * n).norm());
    }
  }
  return out;
}

}  // namespace cprsim
