// SPDX-License-Identifier: BSD-3-Clause
// How near a rod is to what, and how far both have moved since somebody looked.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/robot/contacts.h"

namespace cprsim {
namespace {

/// Around the centreline between two nodes, which leaves that of the nodes by less than `margin`.
Eigen::AlignedBox3d box_of(const std::vector<NodeState>& nodes, std::size_t first, std::size_t last,
                           double margin) {
  Eigen::AlignedBox3d box;
  for (std::size_t k = first; k <= last; ++k)
    box.extend(position_of(nodes[k]));
  return {box.min() - Vec3::Constant(margin), box.max() + Vec3::Constant(margin)};
}

/// Of any two of their points.
double farthest(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  return (a.max() - b.min()).cwiseAbs().cwiseMax((b.max() - a.min()).cwiseAbs()).norm();
}

}  // namespace

/// At most so much nearer are they now.
double RodContacts::moved(const Rod& rod, const Scan& since) const {
  const std::vector<NodeState>& nodes = rod.side->contact_nodes();
  if (since.nodes.size() != nodes.size()) return std::numeric_limits<double>::infinity();
  double own = 0, most = 0;
  Eigen::AlignedBox3d ways;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Vec3 way = position_of(nodes[k]) - since.nodes[k];
    own = std::max(own, way.norm());
    ways.extend(way);
  }
  for (std::size_t o = 0; o < rod.obstacles.size(); ++o) {
    const Obstacle& obstacle = rod.obstacles[o];
    double far = own;
    if (obstacle.body >= 0) {
      far = 0;
      const Pose shift = robot_.body_pose(obstacle.body) * since.bodies[o].inverse();
      for (std::size_t k = 0; k < nodes.size(); ++k)
        far = std::max(far, (position_of(nodes[k]) - shift * since.nodes[k]).norm());
    } else if (obstacle.rod >= 0) {
      const auto& others = rods_[static_cast<std::size_t>(obstacle.rod)].side->contact_nodes();
      Eigen::AlignedBox3d theirs;
      for (std::size_t m = 0; m < others.size(); ++m)
        theirs.extend(position_of(others[m]) - since.others[o][m]);
      far = farthest(ways, theirs);
    }
    most = std::max(most, far);
  }
  return most;
}

/// How far a cell's ends have moved, seen from an obstacle.
double RodContacts::passed(const Rod& rod, const Scan& since, std::size_t o, std::size_t c) const {
  const Obstacle& obstacle = rod.obstacles[o];
  const std::vector<NodeState>& nodes = rod.side->contact_nodes();
  const Pose shift =
      obstacle.body < 0 ? Pose{} : robot_.body_pose(obstacle.body) * since.bodies[o].inverse();
  const Vec3 by[2] = {position_of(nodes[c]) - shift * since.nodes[c],
                      position_of(nodes[c + 1]) - shift * since.nodes[c + 1]};
  if (obstacle.rod < 0) return std::max(by[0].norm(), by[1].norm());
  const auto& others = rods_[static_cast<std::size_t>(obstacle.rod)].side->contact_nodes();
  const std::size_t foot = near(since, rod, c, o).foot;
  const bool anywhere = foot + 1 == others.size();
  const std::size_t first = anywhere || foot == 0 ? 0 : foot - 1;
  double far = 0;
  for (std::size_t k = first; k < std::min(foot + 3, others.size()); ++k) {
    const Vec3 their = position_of(others[k]) - since.others[o][k];
    far = std::max({far, (by[0] - their).norm(), (by[1] - their).norm()});
  }
  return far;
}

// Twice, since a cell between its ends moves with their tangents too.
bool RodContacts::far_away(const Rod& rod) const {
  return !touches(rod) && 2 * moved(rod, rod.scan) < rod.scan.clearance;
}

void RodContacts::scan(Rod& rod) const {
  Scan& out = rod.scan;
  ++out.number;
  const std::vector<NodeState>& nodes = rod.side->contact_nodes();
  out.nodes.clear();
  for (const NodeState& node : nodes)
    out.nodes.emplace_back(position_of(node));
  out.near.assign((nodes.size() - 1) * rod.obstacles.size(), {});
  out.clearance = std::numeric_limits<double>::infinity();
  // most rods are far from each other: boxes around them show it
  std::vector<Eigen::AlignedBox3d> boxes(robot_.rods_meet ? rods_.size() : 0);
  for (std::size_t r = 0; r < boxes.size(); ++r) {
    const std::vector<NodeState>& others = rods_[r].side->contact_nodes();
    boxes[r] = box_of(others, 0, others.size() - 1, 0.1 * length(rods_[r], 0));
  }
  for (std::size_t o = 0; o < rod.obstacles.size(); ++o) {
    const Obstacle& obstacle = rod.obstacles[o];
    for (std::size_t c = 0; c + 1 < nodes.size(); ++c) {
      if (obstacle.rod >= 0 && !obstacle.itself) {
        const std::size_t other = static_cast<std::size_t>(obstacle.rod);
        const Eigen::AlignedBox3d cell = box_of(nodes, c, c + 1, 0.1 * length(rod, c));
        const double apart =
            std::sqrt(boxes[other].squaredExteriorDistance(cell)) - rods_[other].radius;
        if (apart > std::max(2 * rod.radius, 0.25 * length(rod, c))) {
          out.clearance = std::min(out.clearance, apart - rod.radius);
          out.near[c * rod.obstacles.size() + o] = {apart, Vec3::Zero(),
                                                    rods_[other].side->contact_nodes().size() - 1};
          continue;
        }
      }
      // a distance changes no faster than one walks, that of a rod from itself twice as fast: what
      // is far along it begins later as one walks on, until nothing is left
      const double walk = (obstacle.itself ? 2.2 : 1.1) * length(rod, c);
      const double here = distance(rod, o, c, 0).d, there = distance(rod, o, c + 1, 0).d;
      double d = std::isfinite(there) ? 0.5 * (here + there - walk) : here - walk;
      double xi = 0.5;
      if (d < rod.radius) d = lowest(rod, o, c, xi);
      out.clearance = std::min(out.clearance, d - rod.radius);
      Near& near = out.near[c * rod.obstacles.size() + o];
      near = {d, distance(rod, o, c, xi).n, 0};
      if (obstacle.rod >= 0) near.foot = foot(rod, obstacle, c, xi).cell;
    }
  }
  if (!robot_.rods_meet) return;
  out.bodies.assign(rod.obstacles.size(), {});
  out.others.assign(rod.obstacles.size(), {});
  for (std::size_t o = 0; o < rod.obstacles.size(); ++o) {
    const Obstacle& obstacle = rod.obstacles[o];
    if (obstacle.body >= 0) out.bodies[o] = robot_.body_pose(obstacle.body);
    if (obstacle.rod < 0) continue;
    for (const NodeState& node :
         rods_[static_cast<std::size_t>(obstacle.rod)].side->contact_nodes())
      out.others[o].emplace_back(position_of(node));
  }
}

}  // namespace cprsim
