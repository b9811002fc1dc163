// SPDX-License-Identifier: BSD-3-Clause
// Distances from what contacts of rods meet: shapes that stand still or ride on a body, and other
// rods, whose nearest point is found on the Hermite curve through its nodes,
//   f(xi) = (c(xi) - x) . c'(xi) = 0                                                       (1)
// by Newton's method, by halves where that would leave the bracket.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/robot/contacts.h"

namespace cprsim {
namespace {

/// Coefficients of a cell's cubic: c = a + b xi + e xi² + g xi³.
struct Cubic {
  Vec3 a, b, e, g;

  Cubic(const NodeState& from, const NodeState& to, double h) {
    const Vec3 p = position_of(from), t0 = h * rotation_of(from).col(2),
               t1 = h * rotation_of(to).col(2), chord = position_of(to) - p;
    a = p;
    b = t0;
    e = 3 * chord - 2 * t0 - t1;
    g = t0 + t1 - 2 * chord;
  }

  Vec3 at(double xi) const { return a + xi * (b + xi * (e + xi * g)); }

  Vec3 slope(double xi) const { return b + xi * (2 * e + xi * 3 * g); }

  Vec3 bend(double xi) const { return 2 * e + xi * 6 * g; }
};

/// Where (1) holds between lower and upper, f being negative below and positive above.
double root(const Cubic& c, const Vec3& x, double lower, double upper) {
  double xi = 0.5 * (lower + upper);
  for (int i = 0; i < 60; ++i) {
    const Vec3 gap = c.at(xi) - x, slope = c.slope(xi);
    const double f = gap.dot(slope), by_xi = slope.squaredNorm() + gap.dot(c.bend(xi));
    (f > 0 ? upper : lower) = xi;
    double next = xi - f / by_xi;
    if (!(next > lower && next < upper)) next = 0.5 * (lower + upper);
    if (std::abs(next - xi) < 1e-15) break;
    xi = next;
  }
  return xi;
}

/// Nearest point of one cell beyond `first`: samples tell where to look for roots. @return squared
/// distance
double nearest_in(const Cubic& c, const Vec3& x, double first, double& xi) {
  constexpr int kSamples = 4;
  double best = std::numeric_limits<double>::infinity();
  const auto look = [&](double at) {
    const double d = (c.at(at) - x).squaredNorm();
    if (d >= best) return;
    best = d;
    xi = at;
  };
  const auto f = [&](double at) { return (c.at(at) - x).dot(c.slope(at)); };
  look(first);
  look(1);
  double before = f(first), last = first;
  for (int i = 1; i <= kSamples; ++i) {
    const double at = first + (1 - first) * i / kSamples, now = f(at);
    if (before < 0 && now > 0) look(root(c, x, last, at));
    if (now == 0) look(at);
    before = now;
    last = at;
  }
  return best;
}

}  // namespace

// Among what lies beyond the arc length `from`.
RodContacts::Foot RodContacts::foot(const Rod& other, const std::vector<NodeState>& nodes,
                                    const Vec3& x, double from) const {
  const std::vector<double>& grid = other.side->contact_grid();
  const double start = from / other.rod->length;
  double best = std::numeric_limits<double>::infinity(), least = best;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    if (grid[k] >= start) best = std::min(best, (position_of(nodes[k]) - x).norm());
  Foot out;
  out.at.d = least;
  for (std::size_t c = 0; c + 1 < nodes.size(); ++c) {
    if (grid[c + 1] <= start) continue;
    const double h = length(other, c);
    const double first = std::max(0.0, (start - grid[c]) / (grid[c + 1] - grid[c]));
    // a curve through both ends leads no nearer than this
    const double bound = 0.5 * ((position_of(nodes[c]) - x).norm() +
                                (position_of(nodes[c + 1]) - x).norm() - 1.1 * h);
    if (bound > best) continue;
    const Cubic cubic(nodes[c], nodes[c + 1], h);
    double xi = 0;
    const double d = std::sqrt(nearest_in(cubic, x, first, xi));
    best = std::min(best, d);
    if (d >= least) continue;
    least = d;
    out.cell = c;
    out.xi = xi;
    const Vec3 gap = x - cubic.at(xi);
    out.at.d = d - other.radius;
    out.at.n = d > 0 ? Vec3(gap / d) : Vec3(rotation_of(nodes[c]).col(0));
    out.at.H = (Mat3::Identity() - out.at.n * out.at.n.transpose()) / std::max(d, other.radius);
    const bool end = (c == 0 && xi == 0) || (c + 2 == nodes.size() && xi == 1);
    if (end) continue;
    const Vec3 t = cubic.slope(xi).normalized();
    out.at.H -= t * t.transpose() / std::max(d, other.radius);
  }
  return out;
}

/// Of a rod's point on a rod that is an obstacle to it.
RodContacts::Foot RodContacts::foot(const Rod& rod, const Obstacle& obstacle, std::size_t cell,
                                    double xi) const {
  const Rod& other = rods_[static_cast<std::size_t>(obstacle.rod)];
  return foot(other, other.side->contact_nodes(), point(rod, cell, xi),
              beyond(rod, obstacle, cell, xi));
}

/// Arc length from which on an obstacle that is a rod is looked at from a point.
double RodContacts::beyond(const Rod& rod, const Obstacle& obstacle, std::size_t cell,
                           double xi) const {
  if (!obstacle.itself) return 0;
  const double arc = rod.side->contact_grid()[cell] * rod.rod->length;
  return arc + (xi > 0 ? xi * length(rod, cell) : 0) + rod.apart;
}

/// e of engine/rod/contact.h for a point of a rod.
double RodContacts::sunk(const Rod& rod, const RodContact& contact) const {
  if (left_ == 0 || rod.begun.empty() || contact.give > 0) return 0;
  return left_ * std::min(0.0, begun_distance(rod, contact) - rod.radius);
}

/// Of the point from what it touches when the step began.
double RodContacts::begun_distance(const Rod& rod, const RodContact& contact) const {
  const auto o = static_cast<std::size_t>(contact.surface);
  const Obstacle& obstacle = rod.obstacles[o];
  const Vec3 x = point(rod, rod.begun, contact.cell, contact.xi);
  if (obstacle.rod >= 0) {
    const Rod& other = rods_[static_cast<std::size_t>(obstacle.rod)];
    return foot(other, other.begun, x, beyond(rod, obstacle, contact.cell, contact.xi)).at.d;
  }
  const Surface& surface = obstacle.surface;
  const Pose X_WC = obstacle.body < 0 ? surface.X_WC : rod.start.bodies[o] * surface.X_WC;
  return distance_to(surface, X_WC, x).d;
}

/// Where damping holds back what leaves, a point may let go before it is out again: it touches anew
/// only as it comes nearer.
bool RodContacts::comes_nearer(const Rod& rod, const RodContact& contact, double d) const {
  return contact.lag == 0 || rod.begun.empty() || d < begun_distance(rod, contact);
}

Distance RodContacts::distance(const Rod& rod, std::size_t o, std::size_t cell, double xi) const {
  const Obstacle& obstacle = rod.obstacles[o];
  if (obstacle.rod >= 0) return foot(rod, obstacle, cell, xi).at;
  const Surface& surface = obstacle.surface;
  const Pose X_WC =
      obstacle.body < 0 ? surface.X_WC : robot_.body_pose(obstacle.body) * surface.X_WC;
  return distance_to(surface, X_WC, point(rod, cell, xi));
}

/// Puts the other side of a contact where it is nearest. @return whether it was elsewhere
bool RodContacts::place_foot(const Rod& rod, RodContact& contact) const {
  const Obstacle& obstacle = rod.obstacles[static_cast<std::size_t>(contact.surface)];
  if (obstacle.rod < 0) return false;
  const Rod& other = rods_[static_cast<std::size_t>(obstacle.rod)];
  const Foot now = foot(rod, obstacle, contact.cell, contact.xi);
  const double by = static_cast<double>(now.cell) + now.xi -
                    static_cast<double>(contact.other_cell) - contact.other_xi;
  const bool elsewhere = contact.other_rod < 0 || now.cell != contact.other_cell ||
                         std::abs(by) * length(other, now.cell) > kSlide * other.radius;
  contact.other_rod = static_cast<int>(other.index);
  contact.other_cell = now.cell;
  contact.other_xi = now.xi;
  contact.other_lever = -other.radius / rod.radius * contact.lever;
  return elsewhere;
}

}  // namespace cprsim
