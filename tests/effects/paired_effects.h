// SPDX-License-Identifier: BSD-3-Clause
// One rod, bent by a force at its tip, and effects of any amplitude that may be added to it, one or
// more at a time, in any order.
#pragma once

#include <functional>
#include <vector>

#include "tests/support/robots.h"

namespace cprsim {

struct PairedEffect {
  const char* name;
  /// Adds it with a share of its full amplitude; 0 would be a rod without it.
  std::function<void(Scene&, double share)> add;
  bool moving = false;      ///< does nothing at rest
  bool whole = false;       ///< comes with its full amplitude only
  bool in_plane = true;     ///< may be asked for with <planar normal="0 1 0">
  bool constrains = false;  ///< has no share, and changes what others do by much
  bool at_base = false;     ///< puts something in the place of the clamp
};

/// Every effect that changes the answer by a few hundredths of the length at its full amplitude.
std::vector<PairedEffect> paired_effects();

/// 0.4 m of rubber, 40 mm thick, clamped at the origin along z, with a force at its tip.
Scene rod_for_pairs(bool moves);

/// Whether they may be taken together: there is one base.
bool may_be_combined(const PairedEffect& a, const PairedEffect& b);

}  // namespace cprsim
