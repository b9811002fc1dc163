// SPDX-License-Identifier: BSD-3-Clause
// What a rod's ends give to its two-port (engine/rod/rod_model.h), whatever is between them.
#pragma once

#include "engine/rod/rod_model.h"

namespace cprsim {

using Mat12x6 = Eigen::Matrix<double, 12, 6>;

/// The state at an end (phi, dp, dn, dm) = by_z z + by_A zeta_A + affine.
struct EndColumns {
  Mat12x6 by_z = Mat12x6::Zero(), by_A = Mat12x6::Zero();
  Vec12 affine = Vec12::Zero();
};

/// Wrench (moment, force) on the body that holds the end, about its reference point.
Vec6 wrench_on_base(const NodeState& start, const Port& base);
Vec6 wrench_on_tip(const NodeState& end, const Port& tip);

/// (1) and (3): the tip's six rows, and the wrench on its body. @param gap left open in the rows.
void condense_tip(const RodEnd& rod_end, const NodeState& end, const Port& tip,
                  const RodScale& scale, const Vec6& gap, const EndColumns& Y, CondensedRod& out);

/// (2): the wrench on the base's body; zero unless `moves`.
void condense_base(bool moves, const NodeState& start, const Port& base, const EndColumns& Y,
                   CondensedRod& out);

}  // namespace cprsim
