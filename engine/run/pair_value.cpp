// SPDX-License-Identifier: BSD-3-Clause
#include "engine/run/pair_value.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace cprsim {

namespace {

/// What a pair's contacts come to, as seen by its first: a force that is counted for the other has
/// its sign changed.
struct PairSum {
  int count = 0;
  double normal = 0, friction = 0, slip = 0, depth = 0;
  Vec3 force = Vec3::Zero(), place = Vec3::Zero();

  template <typename Point>
  void add(const Point& point, bool turned) {
    const double pressure = point.normal.dot(point.force);
    ++count;
    force += (turned ? -1 : 1) * point.force;
    normal += pressure;
    friction += (point.force - pressure * point.normal).norm();
    slip = std::max(slip, point.slip.norm());
    depth = std::max(depth, -point.gap);
    place += pressure * point.position;
  }
};

PairSum sum_of(const ContactPair& pair, const ContactSample& contact) {
  PairSum sum;
  const auto add = [&](const ContactPair& of, const auto& point) {
    if (same_pair(pair, of)) sum.add(point, !(pair[0] == of[0]));
  };
  for (const ContactPoint& point : contact.points)
    add({ContactParty{true, point.rod}, point.other}, point);
  for (const LinkContact& point : contact.links)
    add({ContactParty{false, point.link}, ContactParty{false, point.other}}, point);
  return sum;
}

}  // namespace

double pair_value(const Channel& channel, const ContactSample& contact) {
  const PairSum sum = sum_of(channel.pair, contact);
  const auto measured =
      std::find_if(contact.distances.begin(), contact.distances.end(),
                   [&](const PairDistance& of) { return same_pair(of.pair, channel.pair); });
  const bool known = measured != contact.distances.end();
  switch (channel.quantity) {
    case Quantity::kContactCount:
      return sum.count;
    case Quantity::kContactPenetration:
      return std::max(sum.depth, known ? -measured->gap : 0);
    case Quantity::kContactGap:
      return known ? measured->gap : std::numeric_limits<double>::infinity();
    case Quantity::kForce:
      return sum.force[channel.component];
    case Quantity::kContactForce:
      return sum.normal;
    case Quantity::kContactFriction:
      return sum.friction;
    case Quantity::kPosition:
      if (sum.normal > 0) return sum.place[channel.component] / sum.normal;
      return known ? measured->position[channel.component] : 0;
    case Quantity::kContactSlip:
      return sum.slip;
    default:
      throw std::invalid_argument("channel '" + channel.name + "' has no value");
  }
}

}  // namespace cprsim
