// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cprsim {
namespace {

// of the radius: how deep a point sinks before it touches; well below the tolerance, well above
// what a converged solve leaves
constexpr double kNotice = 0.1 * kContactTolerance;
// of the radius: how far a contact may have slid along its rod before it is moved after
constexpr double kSlide = 1e-3;
// of the robot's force: pulls below are round-off
constexpr double kPull = 1e-9;
// of a cell: contacts between nodes stay this far from them
constexpr double kEdge = 1e-3;
// turn of the surface's normal along a cell: less is flat
constexpr double kFlat = 1e-6;
// of a cell: a node this near to a contact needs none of its own
constexpr double kBeside = 0.1;
// from this round on one change at a time
constexpr int kPatience = 12;

/// Before: contacts within a cell come after the node at its start.
double order(const RodContact& contact) {
  return static_cast<double>(contact.cell) + (contact.at_node() ? 0 : 0.5);
}

bool off_for(const RodSpec& rod, const char* effect) {
  return std::find(rod.without.begin(), rod.without.end(), effect) != rod.without.end();
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
    if (!mine.side || off_for(*rod.spec, "contact")) continue;
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
    mine.side->set_surfaces(surfaces, mine.radius, friction_);
    rods_.push_back(std::move(mine));
  }
}

double RodContacts::length(const Rod& rod, std::size_t cell) const {
  const std::vector<double>& grid = rod.side->contact_grid();
  return (grid[cell + 1] - grid[cell]) * rod.rod->length;
}

Vec3 RodContacts::point(const Rod& rod, std::size_t cell, double xi) const {
  const std::vector<NodeState>& nodes = rod.side->contact_nodes();
  ContactNode ends[2];
  ends[0].p = position_of(nodes[cell]);
  if (xi == 0) return ends[0].p;
  ends[0].t = rotation_of(nodes[cell]).col(2);
  ends[1].p = position_of(nodes[cell + 1]);
  ends[1].t = rotation_of(nodes[cell + 1]).col(2);
  return contact_point(xi, length(rod, cell), ends);
}

Distance RodContacts::distance(const Rod& rod, std::size_t obstacle, std::size_t cell,
                               double xi) const {
  const Surface& surface = rod.obstacles[obstacle].surface;
  return distance_to(*surface.shape, surface.X_WC, point(rod, cell, xi));
}

Vec3 RodContacts::tangent(const Rod& rod, std::size_t cell, double xi) const {
  const std::vector<NodeState>& nodes = rod.side->contact_nodes();
  const bool end = cell + 1 == nodes.size();
  return rotation_of(nodes[end || xi < 0.5 ? cell : cell + 1]).col(2);
}

/// Whether a surface does not curve away along the rod: contact is a line there, not a point.
bool RodContacts::flat(const Rod& rod, std::size_t obstacle, std::size_t cell, double xi) const {
  const Vec3 t = tangent(rod, cell, xi);
  const std::size_t last = rod.side->contact_nodes().size() - 2;
  return t.dot(distance(rod, obstacle, cell, xi).H * t) * length(rod, std::min(cell, last)) < kFlat;
}

// Samples, then golden section around the lowest.
double RodContacts::lowest(const Rod& rod, std::size_t obstacle, std::size_t cell,
                           double& xi) const {
  constexpr int kSamples = 8;
  constexpr double kGolden = 0.3819660112501051;
  const auto depth = [&](double at) { return distance(rod, obstacle, cell, at).d; };
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSamples; ++i) {
    const double at = static_cast<double>(i) / kSamples, d = depth(at);
    if (d >= best) continue;
    best = d;
    xi = at;
  }
  double a = std::max(0.0, xi - 1.0 / kSamples), b = std::min(1.0, xi + 1.0 / kSamples);
  double x1 = a + kGolden * (b - a), x2 = b - kGolden * (b - a), d1 = depth(x1), d2 = depth(x2);
  // a minimum is known to the square root of round-off
  while (b - a > 1e-7) {
    if (d1 < d2) {
      b = x2;
      x2 = x1;
      d2 = d1;
      d1 = depth(x1 = a + kGolden * (b - a));
    } else {
      a = x1;
      x1 = x2;
      d1 = d2;
      d2 = depth(x2 = b - kGolden * (b - a));
    }
  }
  if (std::min(d1, d2) < best) {
    best = std::min(d1, d2);
    xi = d1 < d2 ? x1 : x2;
  }
  return best;
}

double RodContacts::moved(const Rod& rod, const Scan& since) const {
  const std::vector<NodeState>& nodes = rod.side->contact_nodes();
  if (since.nodes.size() != nodes.size()) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    most = std::max(most, (position_of(nodes[k]) - since.nodes[k]).squaredNorm());
  return std::sqrt(most);
}

// Twice, since a cell between its ends moves with their tangents too.
bool RodContacts::far_away(const Rod& rod) const {
  return rod.side->contacts().empty() && 2 * moved(rod, rod.scan) < rod.scan.clearance;
}

void RodContacts::scan(Rod& rod) const {
  Scan& out = rod.scan;
  const std::vector<NodeState>& nodes = rod.side->contact_nodes();
  out.nodes.clear();
  for (const NodeState& node : nodes)
    out.nodes.emplace_back(position_of(node));
  out.cells.assign(nodes.size() - 1, {});
  out.clearance = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c + 1 < nodes.size(); ++c) {
    Near& near = out.cells[c];
    near.distance = std::numeric_limits<double>::infinity();
    for (std::size_t o = 0; o < rod.obstacles.size(); ++o) {
      // a distance changes no faster than one walks
      double d = 0.5 * (distance(rod, o, c, 0).d +
                        distance_to(*rod.obstacles[o].surface.shape, rod.obstacles[o].surface.X_WC,
                                    position_of(nodes[c + 1]))
                            .d -
                        1.1 * length(rod, c));
      double xi = 0.5;
      if (d < rod.radius) d = lowest(rod, o, c, xi);
      out.clearance = std::min(out.clearance, d - rod.radius);
      if (d >= near.distance) continue;
      near = {d, distance(rod, o, c, xi).n, !rod.obstacles[o].plane};
    }
  }
}

/// What a joint holds cannot be pushed.
bool RodContacts::held(const Rod& rod, std::size_t node) const {
  return (node == 0 && rod.rod->base_held) ||
         (node + 1 == rod.side->contact_nodes().size() && rod.rod->tip_held);
}

RodContact RodContacts::new_contact(const Rod& rod, std::size_t obstacle, std::size_t cell,
                                    double xi) const {
  RodContact contact;
  contact.surface = static_cast<int>(obstacle);
  contact.cell = cell;
  contact.xi = xi;
  contact.friction = rod.obstacles[obstacle].friction;
  contact.grip = contact.friction > 0 ? Grip::kStick : Grip::kSmooth;
  contact.lever = -rod.radius * distance(rod, obstacle, cell, xi).n;
  contact.axis = tangent(rod, cell, xi);
  return contact;
}

// To where the rod is nearest now, along its cell or on to the next; points on a plane stay at
// their nodes. @return whether it was elsewhere
bool RodContacts::slide(const Rod& rod, RodContact& contact) const {
  const auto obstacle = static_cast<std::size_t>(contact.surface);
  const std::size_t cells = rod.side->contact_nodes().size() - 1;
  std::size_t cell = contact.cell;
  double xi = contact.xi;
  if (contact.at_node()) {
    if (flat(rod, obstacle, cell, 0)) return false;
    double left_xi = 0, right_xi = 0;
    const double inf = std::numeric_limits<double>::infinity();
    const double left = cell > 0 ? lowest(rod, obstacle, cell - 1, left_xi) : inf;
    const double right = cell < cells ? lowest(rod, obstacle, cell, right_xi) : inf;
    if (left < right) --cell;
    xi = left < right ? left_xi : right_xi;
    if (xi < kEdge || xi > 1 - kEdge) return false;
  } else {
    lowest(rod, obstacle, cell, xi);
    if (xi > 1 - kEdge / 2 && cell + 1 < cells) {
      ++cell;
      xi = kEdge;
    } else if (xi < kEdge / 2 && cell > 0) {
      --cell;
      xi = 1 - kEdge;
    }
    xi = std::clamp(xi, kEdge, 1.0);
  }
  const double by = static_cast<double>(cell) + xi - static_cast<double>(contact.cell) - contact.xi;
  contact.cell = cell;
  contact.xi = xi;
  return std::abs(by) * length(rod, cell) > kSlide * rod.radius;
}

/// Moves a contact to where the rod now is nearest. @return whether it was elsewhere
bool RodContacts::follow(const Rod& rod, RodContact& contact, const ContactRows& rows) const {
  const Vec3 lever = -rod.radius * rows.at.n;
  const bool turned = contact.friction > 0 && (lever - contact.lever).norm() > 1e-6 * rod.radius;
  contact.lever = lever;
  contact.axis = tangent(rod, contact.cell, contact.xi);
  if (contact.grip == Grip::kSlip) {
    // slip and force weigh the same in the direction of friction
    const double rate = rows.slip.norm(), force = contact.force.norm();
    if (rate > 0 && force > 0) contact.kappa = std::max(1.0, force / rate);
  }
  return slide(rod, contact) || turned;
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

// New points: the lowest between two nodes, or a node that is not above what its cells' lowest are.
// On a flat face all nodes that sank: they will lie on it in a line.
void RodContacts::search(std::size_t index, std::vector<Change>& changes) const {
  const Rod& rod = rods_[index];
  const std::vector<RodContact>& contacts = rod.side->contacts();
  const double noticed = rod.radius * (1 - kNotice), fine = kNotice * rod.radius;
  const std::size_t cells = rod.scan.cells.size();
  const auto beside = [&](std::size_t node) {
    return std::any_of(contacts.begin(), contacts.end(), [&](const RodContact& contact) {
      const double at = static_cast<double>(contact.cell) + contact.xi;
      return std::abs(at - static_cast<double>(node)) < kBeside;
    });
  };
  const auto taken = [&](std::size_t cell) {
    return std::any_of(contacts.begin(), contacts.end(), [&](const RodContact& contact) {
      return contact.cell == cell || (contact.at_node() && contact.cell == cell + 1);
    });
  };
  const auto add = [&](std::size_t o, std::size_t cell, double xi, double d) {
    changes.push_back(
        {(rod.radius - d) / rod.radius, index, -1, false, new_contact(rod, o, cell, xi)});
  };
  std::vector<double> xi(cells), low(cells);
  for (std::size_t o = 0; o < rod.obstacles.size(); ++o) {
    for (std::size_t c = 0; c < cells; ++c) {
      low[c] = std::numeric_limits<double>::infinity();
      if (rod.scan.cells[c].distance < noticed) low[c] = lowest(rod, o, c, xi[c]);
    }
    for (std::size_t k = 0; k <= cells; ++k) {
      const std::size_t left = k > 0 ? k - 1 : 0, right = std::min(k, cells - 1);
      const double below = std::min(low[left], low[right]);
      const double d = below < noticed
                           ? (k < cells ? distance(rod, o, k, 0).d : distance(rod, o, k - 1, 1).d)
                           : noticed;
      const bool lowest_here = d < below + fine || (d < noticed && flat(rod, o, k, 0));
      if (d < noticed && lowest_here && !held(rod, k) && !beside(k)) add(o, k, 0, d);
    }
    for (std::size_t c = 0; c < cells; ++c) {
      const bool inside = xi[c] > kEdge && xi[c] < 1 - kEdge;
      if (!(low[c] < noticed) || !inside) continue;
      const double ends = std::min(distance(rod, o, c, 0).d, distance(rod, o, c, 1).d);
      if (low[c] < ends - fine && !taken(c)) add(o, c, xi[c], low[c]);
    }
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
  return std::any_of(rods_.begin(), rods_.end(),
                     [](const Rod& rod) { return !rod.side->contacts().empty(); });
}

void RodContacts::begin_step() {
  for (Rod& rod : rods_) {
    rod.before = rod.side->contacts();
    if (!far_away(rod) || moved(rod, rod.scan) > 0) scan(rod);
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

double RodContacts::worst_depth() {
  double deepest = 0;
  for (Rod& rod : rods_) {
    if (far_away(rod)) continue;
    scan(rod);
    deepest = std::max(deepest, -rod.scan.clearance / rod.radius);
  }
  return deepest;
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
