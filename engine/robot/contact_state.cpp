// SPDX-License-Identifier: BSD-3-Clause
// What contacts of rods remember from step to step, for checkpoints and hashes.
#include "engine/robot/contacts.h"

namespace cprsim {

// Sizes are those of the robot.
void RodContacts::visit(Archive& archive) {
  archive(eased_);
  archive(lagged_);
  bodies_.visit(archive);
  for (Rod& rod : rods_) {
    Scan& scan = rod.scan;
    bool scanned = !scan.nodes.empty();
    archive(scanned);
    if (!scanned) continue;
    const std::size_t nodes = rod.side->contact_grid().size(), obstacles = rod.obstacles.size();
    if (archive.reading()) {
      scan.nodes.resize(nodes);
      scan.near.resize((nodes - 1) * obstacles);
      scan.bodies.resize(robot_.rods_meet ? obstacles : 0);
      scan.others.resize(robot_.rods_meet ? obstacles : 0);
    }
    archive(scan.clearance);
    if (archive.reading()) ++scan.number;
    for (Vec3& node : scan.nodes)
      archive(node);
    for (std::size_t k = 0; k < scan.near.size(); ++k) {
      Near& near = scan.near[k];
      archive(near.distance);
      archive(near.normal);
      const int other = rod.obstacles[k % obstacles].rod;
      const std::size_t feet =
          other < 0 ? 1 : rods_[static_cast<std::size_t>(other)].side->contact_grid().size() - 1;
      near.foot = archive.count(near.foot, feet);
    }
    for (Pose& body : scan.bodies)
      archive(body);
    for (std::size_t o = 0; o < scan.others.size(); ++o) {
      const int other = rod.obstacles[o].rod;
      if (other < 0) continue;
      scan.others[o].resize(rods_[static_cast<std::size_t>(other)].side->contact_grid().size());
      for (Vec3& node : scan.others[o])
        archive(node);
    }
  }
}

}  // namespace cprsim
