// SPDX-License-Identifier: BSD-3-Clause
// What the ends of rods are attached to: links, frames, and ends of other rods.
#pragma once

#include <vector>

#include "scenes/loader/reading.h"

namespace cprsim {

/// An end whose place is known once the rod that it is attached to is.
struct RodOnRod {
  std::size_t rod = 0, owner = 0;      ///< indices into Scene::rods
  bool at_tip = false, on_tip = true;  ///< which end of the rod, on which of its owner
  Pose X_OE;                           ///< from the owner's end
  const Node* node = nullptr;
};

/// Of the rod that is next in Scene::rods.
void read_rod_ends(Reading& reading, const RodEntry& entry, RodSpec& rod,
                   std::vector<RodOnRod>& on_rods);

/// Where an end is clamped to a link, rods attached to it are attached to that link. Where it is
/// free it gets a link without mass, which holds them together; it is named like the end.
/// @pre all rods are read
void join_rods(Reading& reading, std::vector<RodOnRod> on_rods);

}  // namespace cprsim
