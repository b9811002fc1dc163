// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/ties.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/robot/echoes.h"
#include "engine/section/along.h"

namespace cprsim {
namespace {

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

/// A rod as one that can be tied.
TouchingRod& side_of(Robot& robot, int index) {
  RobotRod& rod = robot.rods[static_cast<std::size_t>(index)];
  TouchingRod* side = rod.model->touching();
  if (!side)
    throw std::invalid_argument("rod '" + rod.spec->name +
                                "' is tied to another: no method in a plane can be");
  if (!side->may_touch()) side->set_surfaces({}, rod.section.half_width, false);
  return *side;
}

}  // namespace

void tie_rods(Robot& robot) {
  for (const TieSpec& tie : robot.scene->ties) {
    TouchingRod &side = side_of(robot, tie.rod), &other = side_of(robot, tie.other);
    const RobotRod &a = robot.rods[static_cast<std::size_t>(tie.rod)],
                   &b = robot.rods[static_cast<std::size_t>(tie.other)];
    for (std::size_t k = 0; k < tie.s.size(); ++k) {
      const Pose X_a = unloaded(robot, a, tie.s[k]), X_b = unloaded(robot, b, tie.other_s[k]);
      RodContact own;
      own.grip = Grip::kTie;
      own.role = ContactRole::kShared;
      own.cell = node_at(side, tie.s[k]);
      own.arm = tie.offset.value_or(X_a.R.transpose() * (X_b.p - X_a.p));
      own.other_rod = tie.other;
      own.other_cell = node_at(other, tie.other_s[k]);
      side.contacts().push_back(own);
    }
  }
  if (robot.scene->ties.empty()) return;
  robot.rods_meet = true;
  mirror_contacts(robot);
}

}  // namespace cprsim
