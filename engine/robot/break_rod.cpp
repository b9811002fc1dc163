// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/break_rod.h"

#include <algorithm>
#include <stdexcept>

namespace cprsim {
namespace {

void break_within(RobotRod& rod, double s) {
  if (s > 0 && s < 1) rod.break_at(s);
}

void add_tendons(const Scene& scene, std::size_t index, RobotRod& rod) {
  for (std::size_t k = 0; k < scene.tendons.size(); ++k) {
    const TendonSpec& spec = scene.tendons[k];
    if (spec.rod != static_cast<int>(index)) continue;
    RobotTendon tendon{static_cast<int>(k), &spec, nullptr};
    for (const DriveSpec& drive : scene.drives)
      if (drive.tendon == tendon.index) tendon.drive = &drive;
    rod.tendons.push_back(tendon);
    for (const double s : Tendon(spec).breaks())
      rod.break_at(s);
  }
}

// What is not smooth along the rod is a station of it.
void add_line_loads(RobotRod& rod) {
  for (const LoadSpec* load : rod.line_loads) {
    break_within(rod, load->rod_s);
    break_within(rod, *load->to);
  }
}

void add_magnets(RobotRod& rod) {
  if (!rod.magnetic) return;
  for (const MagnetSpec& magnet : rod.spec->magnets) {
    break_within(rod, magnet.from);
    break_within(rod, magnet.to);
  }
}

void add_disks(RobotRod& rod) {
  for (const DiskSpec& disk : rod.spec->disks)
    rod.break_at(disk.s);
}

void add_ties(const Scene& scene, std::size_t index, RobotRod& rod) {
  bool inside = false;
  const auto add = [&](const std::vector<double>& all) {
    for (const double s : all)
      rod.break_at(s);
    rod.tied = true;
    inside = inside || std::any_of(all.begin(), all.end(), [](double s) { return s < 1; });
  };
  for (const TieSpec& tie : scene.ties) {
    if (tie.rod == static_cast<int>(index)) add(tie.s);
    if (tie.other == static_cast<int>(index)) add(tie.other_s);
  }
  // what is fed in at the base moves along with the rod, places at fractions of its length do not
  if (inside && rod.length_drive)
    throw std::invalid_argument("the length of rod '" + rod.spec->name +
                                "' cannot be driven: it is tied to another before its tip");
}

}  // namespace

void RobotRod::break_at(double s) {
  if (std::find(breaks.begin(), breaks.end(), s) == breaks.end()) breaks.push_back(s);
}

void break_rod(const Scene& scene, std::size_t index, RobotRod& rod) {
  add_tendons(scene, index, rod);
  add_magnets(rod);
  add_line_loads(rod);
  add_disks(rod);
  add_ties(scene, index, rod);
}

}  // namespace cprsim
