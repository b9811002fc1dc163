// SPDX-License-Identifier: BSD-3-Clause
// Disks along a rod of splines: where its pieces end.
#include "engine/rod/arc_grid.h"
#include "engine/rod/collocation.h"

namespace cprsim {

// A jump is where its piece ends; the node there belongs to the next one.
void CollocationRod::place_disks() {
  std::vector<double> ends, nodes;
  for (const Piece& piece : pieces_)
    ends.push_back(sites_[static_cast<std::size_t>(piece.first_point)].s);
  ends.push_back(1);
  for (const Site& node : nodes_)
    nodes.push_back(node.s);
  std::vector<RodDisks::Station> stations;
  for (const DiskSpec& disk : options_.disks)
    stations.push_back({nodes_at(ends, {disk.s})[0], nodes_at(nodes, {disk.s})[0]});
  disks_ =
      std::make_unique<RodDisks>(options_.disks, stations, points_.size(), options_.rotary_inertia);
}

/// The end of the piece before a station.
const Vec13& CollocationRod::end_of_piece(std::size_t station) const {
  return control_[station < pieces_.size()
                      ? static_cast<std::size_t>(pieces_[station].first_control) - 1
                      : control_.size() - 1];
}

void CollocationRod::meet_disks() {
  for (std::size_t g = 1; g <= pieces_.size(); ++g) {
    const Vec13& y = end_of_piece(g);
    disks_->evaluate(g, rotation_of(Vec4(y.head<4>())), y.segment<3>(kP));
  }
}

}  // namespace cprsim
