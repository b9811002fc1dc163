// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/break_rod.h"

#include <algorithm>
#include <stdexcept>

namespace cprsim {
namespace {

void add_tendons(const Scene& scene, std::size_t index, RobotRod& rod) {
  for (std::size_t k = 0; k < scene.tendons.size(); ++k) {
    const TendonSpec& spec = scene.tendons[k];
    if (spec.rod != static_cast<int>(index)) continue;
    if (rod.length_drive)
      throw std::invalid_argument("the length of rod '" + rod.spec->name +
                                  "' cannot be driven: tendon '" + spec.name + "' runs along it");
    RobotTendon tendon{static_cast<int>(k), &spec, nullptr};
    for (const DriveSpec& drive : scene.drives)
      if (drive.tendon == tendon.index) tendon.drive = &drive;
    if (scene.planar_normal && tendon.drive &&
        tendon.drive->quantity == DriveQuantity::kDisplacement)
      throw std::invalid_argument("tendon '" + spec.name + "' is displaced in a planar scene");
    rod.tendons.push_back(tendon);
    for (double s : Tendon(spec).breaks())
      if (std::find(rod.breaks.begin(), rod.breaks.end(), s) == rod.breaks.end())
        rod.breaks.push_back(s);
  }
}

// What is not smooth along the rod is a station of it.
void add_line_loads(RobotRod& rod) {
  if (rod.line_loads.empty()) return;
  if (rod.length_drive)
    throw std::invalid_argument("rod '" + rod.spec->name +
                                "' has a load along it, and a length drive, too");
  for (const LoadSpec* load : rod.line_loads)
    for (const double s : {load->rod_s, *load->to})
      if (s > 0 && s < 1 && std::find(rod.breaks.begin(), rod.breaks.end(), s) == rod.breaks.end())
        rod.breaks.push_back(s);
}

void add_magnets(RobotRod& rod) {
  if (!rod.magnetic) return;
  if (rod.length_drive)
    throw std::invalid_argument("the length of rod '" + rod.spec->name +
                                "' cannot be driven: it is magnetised");
  for (const MagnetSpec& magnet : rod.spec->magnets)
    for (const double s : {magnet.from, magnet.to})
      if (s > 0 && s < 1 && std::find(rod.breaks.begin(), rod.breaks.end(), s) == rod.breaks.end())
        rod.breaks.push_back(s);
}

// They are fastened to the material, which a length drive pulls through the base.
void add_disks(RobotRod& rod) {
  if (rod.spec->disks.empty()) return;
  if (rod.length_drive)
    throw std::invalid_argument("the length of rod '" + rod.spec->name +
                                "' cannot be driven: it carries disks");
  for (const DiskSpec& disk : rod.spec->disks)
    if (std::find(rod.breaks.begin(), rod.breaks.end(), disk.s) == rod.breaks.end())
      rod.breaks.push_back(disk.s);
}

}  // namespace

void break_rod(const Scene& scene, std::size_t index, RobotRod& rod) {
  add_tendons(scene, index, rod);
  add_magnets(rod);
  add_line_loads(rod);
  add_disks(rod);
}

}  // namespace cprsim
