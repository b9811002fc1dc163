// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/ties.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/section/along.h"

namespace cprsim {
namespace {

/// One end of a tie, on one rod.
struct TiedPoint {
  double s = 0;
  int tie = 0;  ///< counts the points of all ties
  RodContact contact;
};

std::size_t node_at(const TouchingRod& side, double s) {
  const std::vector<double>& grid = side.contact_grid();
  const auto nearest = std::min_element(grid.begin(), grid.end(), [s](double a, double b) {
    return std::abs(a - s) < std::abs(b - s);
  });
  return static_cast<std::size_t>(nearest - grid.begin());
}

Pose unloaded(const Robot& robot, const RobotRod& rod, double s) {
  return robot.pose_of(rod.base) * SectionsAlong(*rod.spec, false).unloaded(s, rod.length);
}

}  // namespace

void tie_rods(Robot& robot) {
  std::vector<std::vector<TiedPoint>> points(robot.rods.size());
  int count = 0;
  for (const TieSpec& tie : robot.scene->ties) {
    const auto a = static_cast<std::size_t>(tie.rod), b = static_cast<std::size_t>(tie.other);
    for (std::size_t k = 0; k < tie.s.size(); ++k, ++count) {
      const Pose X_a = unloaded(robot, robot.rods[a], tie.s[k]),
                 X_b = unloaded(robot, robot.rods[b], tie.other_s[k]);
      RodContact own;
      own.grip = Grip::kTie;
      own.role = ContactRole::kShared;
      own.other_rod = tie.other;
      own.arm = tie.offset.value_or(X_a.R.transpose() * (X_b.p - X_a.p));
      RodContact echo;
      echo.grip = Grip::kTie;
      echo.role = ContactRole::kEcho;
      echo.other_rod = tie.rod;
      points[a].push_back({tie.s[k], count, own});
      points[b].push_back({tie.other_s[k], count, echo});
    }
  }
  if (count == 0) return;
  robot.rods_meet = true;
  // where the two ends of each tie stand in their rods' lists
  std::vector<int> own_entry(static_cast<std::size_t>(count)), echo_entry(own_entry);
  for (std::vector<TiedPoint>& all : points) {
    std::stable_sort(all.begin(), all.end(),
                     [](const TiedPoint& p, const TiedPoint& q) { return p.s < q.s; });
    for (std::size_t i = 0; i < all.size(); ++i)
      (all[i].contact.role == ContactRole::kShared
           ? own_entry
           : echo_entry)[static_cast<std::size_t>(all[i].tie)] = static_cast<int>(i);
  }
  for (std::size_t r = 0; r < points.size(); ++r) {
    if (points[r].empty()) continue;
    TouchingRod* side = robot.rods[r].model->touching();
    if (!side)
      throw std::invalid_argument("rod '" + robot.rods[r].spec->name +
                                  "' is tied to another: no method in a plane can be");
    side->set_surfaces({}, robot.rods[r].section.half_width, false);
    for (const TiedPoint& point : points[r]) {
      RodContact contact = point.contact;
      contact.cell = node_at(*side, point.s);
      contact.partner =
          (contact.role == ContactRole::kShared ? echo_entry
                                                : own_entry)[static_cast<std::size_t>(point.tie)];
      side->contacts().push_back(contact);
    }
  }
}

}  // namespace cprsim
