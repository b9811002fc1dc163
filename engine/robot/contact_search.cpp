// SPDX-License-Identifier: BSD-3-Clause
// The geometry of it: where a rod is lowest, and where points belong.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/golden_section.h"
#include "engine/robot/contacts.h"

namespace cprsim {
namespace {

// of the radius: how deep a point sinks before it touches; well below the tolerance, well above
// what a converged solve leaves
constexpr double kNotice = 0.1 * kContactTolerance;
// of a cell: contacts between nodes stay this far from them
constexpr double kEdge = 1e-5;
// turn of the surface's normal along a cell: less is flat
constexpr double kFlat = 1e-6;
// a slip rate that is nearly nothing must not drown in round-off what it is weighed against
constexpr double kMostKappa = 1e3;
// of a cell: a node this near to a contact needs none of its own
constexpr double kBeside = 0.1;
// in cells: how far apart two points of one valley may be
constexpr double kValley = 1.5;

}  // namespace

double RodContacts::length(const Rod& rod, std::size_t cell) const {
  const std::vector<double>& grid = rod.side->contact_grid();
  return (grid[cell + 1] - grid[cell]) * rod.rod->length;
}

Vec3 RodContacts::point(const Rod& rod, std::size_t cell, double xi) const {
  return point(rod, rod.side->contact_nodes(), cell, xi);
}

Vec3 RodContacts::point(const Rod& rod, const std::vector<NodeState>& nodes, std::size_t cell,
                        double xi) const {
  ContactNode ends[2];
  ends[0].p = position_of(nodes[cell]);
  if (xi == 0) return ends[0].p;
  ends[0].t = rotation_of(nodes[cell]).col(2);
  ends[1].p = position_of(nodes[cell + 1]);
  ends[1].t = rotation_of(nodes[cell + 1]).col(2);
  return contact_point(xi, length(rod, cell), ends);
}

Vec3 RodContacts::tangent(const Rod& rod, std::size_t cell, double xi) const {
  const std::vector<NodeState>& nodes = rod.side->contact_nodes();
  const bool end = cell + 1 == nodes.size();
  return rotation_of(nodes[end || xi < 0.5 ? cell : cell + 1]).col(2);
}

/// How far a surface curves away from a tangent within a cell along the rod, either side of its
/// middle.
double RodContacts::sagitta(const Rod& rod, std::size_t obstacle, std::size_t cell,
                            double xi) const {
  const Vec3 t = tangent(rod, cell, xi);
  const double h = length(rod, std::min(cell, rod.side->contact_nodes().size() - 2));
  return t.dot(distance(rod, obstacle, cell, xi).H * t) * h * h / 8;
}

/// Whether contact is a line, not a point: a surface does not curve away along the rod, or a shape
/// not by more within a cell than is tolerated.
bool RodContacts::flat(const Rod& rod, std::size_t obstacle, std::size_t cell, double xi) const {
  const double h = length(rod, std::min(cell, rod.side->contact_nodes().size() - 2));
  const double away = sagitta(rod, obstacle, cell, xi);
  return 8 * away < kFlat * h ||
         (rod.obstacles[obstacle].rod < 0 && away < kContactTolerance * rod.radius);
}

double RodContacts::lowest(const Rod& rod, std::size_t obstacle, std::size_t cell,
                           double& xi) const {
  const Lowest found = lowest_of([&](double at) { return distance(rod, obstacle, cell, at).d; });
  xi = found.at;
  return found.value;
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
  // what comes rubs before it may stick: where a rod was led to is where it slid to. But one that
  // nothing else holds would be free to go
  const bool loose = !rod.rod->base_held && !rod.rod->tip_held;
  contact.grip = contact.friction > 0 && loose && !lagged_ ? Grip::kStick : Grip::kSmooth;
  if (lagged_) contact.bound = 0;
  contact.may_rest = eased_ > 0;
  contact.lever = -rod.radius * distance(rod, obstacle, cell, xi).n;
  contact.axis = tangent(rod, cell, xi);
  contact.give = rod.obstacles[obstacle].give;
  if (rates_) contact.lag = rod.obstacles[obstacle].lag;
  contact.sunk = sunk(rod, contact);
  const bool fixed = rod.obstacles[obstacle].fixed();
  if (fixed && rod.side->owns_forces()) return contact;
  contact.role = ContactRole::kShared;
  if (fixed) return contact;
  contact.body = rod.obstacles[obstacle].body;
  // what has passed through another rod within the step is to go back
  const std::size_t last = rod.side->contact_nodes().size() - 2;
  const Vec3& was = near(rod.start, rod, std::min(cell, last), obstacle).normal;
  if (contact.body < 0 && contact.lever.dot(was) > 0) contact.lever *= -1;
  place_foot(rod, contact);
  return contact;
}

// Rods that are nearly parallel are near in a wide valley: pushed apart at one place, they are
// nearest at another, on the other side of its middle, and pushed there, at the first again. Two
// points hold such a valley, and neither moves on to the other.
bool RodContacts::brackets(Rod& rod, const RodContact& contact, double by) const {
  if (rod.obstacles[static_cast<std::size_t>(contact.surface)].rod < 0) return false;
  const double at = static_cast<double>(contact.cell) + contact.xi;
  const auto lies = [&](double other) {
    return (other - at) * by > 0 && std::abs(other - at) < kValley;
  };
  const std::vector<RodContact>& all = rod.side->contacts();
  if (std::any_of(all.begin(), all.end(), [&](const RodContact& other) {
        return other.found() && other.surface == contact.surface &&
               lies(static_cast<double>(other.cell) + other.xi);
      }))
    return true;
  const auto stays = [&](const std::pair<int, double>& valley) {
    return valley.first == contact.surface && std::abs(valley.second - at) < kValley;
  };
  if (std::any_of(rod.valleys.begin(), rod.valleys.end(), stays)) return true;
  const bool back = std::any_of(rod.slides.begin(), rod.slides.end(), [&](const Slide& slide) {
    return slide.surface == contact.surface && slide.to == at && slide.by * by < 0 &&
           std::abs(by) > 0.5 * std::abs(slide.by);
  });
  if (back) rod.valleys.emplace_back(contact.surface, at);
  return back;
}

// To where the rod is nearest now, along its cell or on to the next; points on a plane stay at
// their nodes. @return whether it was elsewhere
bool RodContacts::slide(Rod& rod, RodContact& contact) const {
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
    // over the node only if what is nearest lies behind it
    double beyond = 0;
    if (xi > 1 - kEdge / 2 && cell + 1 < cells) {
      lowest(rod, obstacle, cell + 1, beyond);
      xi = 1 - kEdge / 2;
      if (beyond > kEdge / 2) {
        ++cell;
        xi = kEdge;
      }
    } else if (xi < kEdge / 2 && cell > 0) {
      lowest(rod, obstacle, cell - 1, beyond);
      xi = kEdge / 2;
      if (beyond < 1 - kEdge / 2) {
        --cell;
        xi = 1 - kEdge;
      }
    }
    xi = std::clamp(xi, kEdge / 2, 1.0);
  }
  const double at = static_cast<double>(contact.cell) + contact.xi;
  const double by = static_cast<double>(cell) + xi - at;
  const Vec3 t = tangent(rod, cell, xi);
  const double way = std::abs(by) * length(rod, cell);
  const double turn = way * std::abs(t.dot(distance(rod, obstacle, cell, xi).H * t));
  const bool elsewhere = way > kSlide * rod.radius || turn > kTurn;
  if (elsewhere && brackets(rod, contact, by)) return false;
  if (elsewhere) leap(rod, contact, by, cell, xi);
  contact.cell = cell;
  contact.xi = xi;
  return elsewhere;
}

// A force that moves after the point it pushes away may never catch up with it: from the second
// move of a solve on, the secant method tells where both agree.
void RodContacts::leap(Rod& rod, const RodContact& contact, double by, std::size_t& cell,
                       double& xi) const {
  const double at = static_cast<double>(contact.cell) + contact.xi;
  const auto last = std::find_if(rod.slides.begin(), rod.slides.end(), [&](const Slide& slide) {
    return slide.surface == contact.surface && slide.to == at;
  });
  Slide now{contact.surface, at, by, 0};
  if (last != rod.slides.end()) {
    const double step = -by * (at - last->from) / (by - last->by);
    if (std::isfinite(step)) {
      const double to = at + std::clamp(step, -2 * std::abs(by), 2 * std::abs(by));
      const auto cells = static_cast<double>(rod.side->contact_nodes().size() - 1);
      cell = static_cast<std::size_t>(std::clamp(to, 0.0, cells - 1));
      xi = std::clamp(to - static_cast<double>(cell), kEdge, 1 - kEdge / 2);
    }
    rod.slides.erase(last);
  }
  now.to = static_cast<double>(cell) + xi;
  rod.slides.push_back(now);
}

/// Moves a contact to where the rod now is nearest. @return whether it was elsewhere
bool RodContacts::follow(Rod& rod, RodContact& contact, const ContactRows& rows,
                         bool slides) const {
  const Vec3 lever = -rod.radius * rows.at.n;
  const bool turned = contact.friction > 0 && (lever - contact.lever).norm() > 1e-6 * rod.radius;
  contact.lever = lever;
  contact.axis = tangent(rod, contact.cell, contact.xi);
  if (contact.grip == Grip::kSlip) {
    // slip and force weigh the same in the direction of friction
    const double rate = rows.slip.norm(), force = contact.force.norm();
    if (rate > 0 && force > 0) contact.kappa = std::clamp(force / rate, 1.0, kMostKappa);
  }
  const bool slid = slides && slide(rod, contact), stepped = place_foot(rod, contact);
  contact.sunk = sunk(rod, contact);
  return slid || stepped || turned;
}

// New points: the lowest between two nodes, or a node that is not above what its cells' lowest are.
// On a flat face all nodes that sank: they will lie on it in a line.
// Late in a solve a point near one that touches the same rod is left to the next solve, which may
// move that: where rods are nearly parallel both would pull by turns.
void RodContacts::search(std::size_t index, std::vector<Change>& changes, bool late) const {
  const Rod& rod = rods_[index];
  const std::vector<RodContact>& contacts = rod.side->contacts();
  const double noticed = rod.radius * (1 - kNotice), fine = kNotice * rod.radius;
  const std::size_t cells = rod.scan.nodes.size() - 1;
  // contacts with what stands still share cells with no other such
  const auto same = [&](const RodContact& contact, std::size_t o) {
    return contact.found() && (contact.surface == static_cast<int>(o) ||
                               (rod.obstacles[static_cast<std::size_t>(contact.surface)].fixed() &&
                                rod.obstacles[o].fixed()));
  };
  const auto beside = [&](std::size_t node, std::size_t o) {
    return std::any_of(contacts.begin(), contacts.end(), [&](const RodContact& contact) {
      if (!same(contact, o)) return false;
      const double at = static_cast<double>(contact.cell) + contact.xi;
      return std::abs(at - static_cast<double>(node)) < kBeside;
    });
  };
  const auto taken = [&](std::size_t cell, std::size_t o) {
    return std::any_of(contacts.begin(), contacts.end(), [&](const RodContact& contact) {
      return same(contact, o) &&
             (contact.cell == cell || (contact.at_node() && contact.cell == cell + 1));
    });
  };
  // downhill all the way from one that touches: that one will get there itself
  const auto downhill = [&](std::size_t o, double from, double to) {
    constexpr int kLooks = 4;
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kLooks; ++i) {
      const double at = from + (to - from) * i / kLooks;
      const std::size_t cell = std::min(static_cast<std::size_t>(at), cells - 1);
      const double d = distance(rod, o, cell, at - static_cast<double>(cell)).d;
      if (d > last) return false;
      last = d;
    }
    return true;
  };
  const auto open = [&](std::size_t o, double at) {
    return std::any_of(rod.valleys.begin(), rod.valleys.end(), [&](const auto& valley) {
      return valley.first == static_cast<int>(o) && std::abs(valley.second - at) < kValley;
    });
  };
  const auto settled = [&](std::size_t o, double at) {
    return rod.obstacles[o].rod >= 0 &&
           std::any_of(contacts.begin(), contacts.end(), [&](const RodContact& contact) {
             if (!contact.found() || contact.surface != static_cast<int>(o)) return false;
             const double other = static_cast<double>(contact.cell) + contact.xi;
             const double way = std::abs(at - other);
             return (late && way < 1) ||
                    (way < kValley && !open(o, other) && downhill(o, other, at));
           });
  };
  const auto add = [&](std::size_t o, std::size_t cell, double xi, double d) {
    if (settled(o, static_cast<double>(cell) + xi)) return;
    const RodContact contact = new_contact(rod, o, cell, xi);
    // what had sunk before may lie deep
    const double depth = rod.radius + contact.sunk - d;
    if (depth > fine && comes_nearer(rod, contact, d))
      changes.push_back({depth / rod.radius, index, -1, false, contact});
  };
  std::vector<double> xi(cells), low(cells);
  for (std::size_t o = 0; o < rod.obstacles.size(); ++o) {
    for (std::size_t c = 0; c < cells; ++c) {
      low[c] = std::numeric_limits<double>::infinity();
      if (near(rod.scan, rod, c, o).distance < noticed) low[c] = lowest(rod, o, c, xi[c]);
    }
    for (std::size_t k = 0; k <= cells; ++k) {
      const std::size_t left = k > 0 ? k - 1 : 0, right = std::min(k, cells - 1);
      const double below = std::min(low[left], low[right]);
      const double d = below < noticed
                           ? (k < cells ? distance(rod, o, k, 0).d : distance(rod, o, k - 1, 1).d)
                           : noticed;
      const bool lowest_here = d < below + fine || (d < noticed && flat(rod, o, k, 0));
      if (d < noticed && lowest_here && !held(rod, k) && !beside(k, o)) add(o, k, 0, d);
    }
    for (std::size_t c = 0; c < cells; ++c) {
      const bool inside = xi[c] > kEdge && xi[c] < 1 - kEdge;
      if (!(low[c] < noticed) || !inside) continue;
      const double ends = std::min(distance(rod, o, c, 0).d, distance(rod, o, c, 1).d);
      const double away = flat(rod, o, c, xi[c]) ? sagitta(rod, o, c, xi[c]) : 0;
      if (low[c] < ends - fine - away && !taken(c, o)) add(o, c, xi[c], low[c]);
    }
  }
}

}  // namespace cprsim
