// SPDX-License-Identifier: BSD-3-Clause
// What a rod's ends give to its two-port (engine/rod/rod_model.h), whatever is between them. In a
// plane only the leading blocks are written. Y (12 × (2d + 1)) says how the state at an end
// answers: (phi, dp, dn, dm) = Y [z; zeta_A; 1]. Columns beyond those are of contacts' forces, then
// of unknowns of tendons (engine/rod/tendon_border.h).
#pragma once

#include "engine/rod/end_condition.h"
#include "engine/rod/rod_model.h"
#include "engine/rod/tendon_border.h"

namespace cprsim {

/// Wrench (moment, force) on the body that holds the end, about its reference point.
Vec6 wrench_on_base(const MotionSpace& space, const NodeState& start, const Port& base);
Vec6 wrench_on_tip(const MotionSpace& space, const NodeState& end, const Port& tip);

/// Who takes the columns beyond those of the two-port; null where there are none.
struct MorePorts {
  OpenPorts* forces = nullptr;
  TensionPorts* tensions = nullptr;
  Eigen::Index unknowns = 0;  ///< of tendons
};

/// (1) and (3): the tip's rows, and the wrench on its body if one holds it.
void condense_tip(const MotionSpace& space, const ConditionRows& rows, bool held,
                  const NodeState& end, const Port& tip, const MatX& Y, CondensedRod& out,
                  const MorePorts& more = {});

/// (2): the wrench on the base's body.
void condense_base(const MotionSpace& space, const NodeState& start, const Port& base,
                   const MatX& Y, CondensedRod& out, const MorePorts& more = {});

}  // namespace cprsim
