// SPDX-License-Identifier: BSD-3-Clause
// Reference solution of a rod with tendons in the formulation of Rucker & Webster, IEEE Trans.
// Robotics 27 (2011) 1033-1044, without a line of the engine: n, m are the rod's own, tendons load
// it along their way and at the tip where they end,
//   (1) n' = -(tau t)' - f,   m' = -p' × n - (R r) × (tau t)',    n(L) = F - tau t,
//       m(L) = -(R r) × tau t
// (tau t)' holds second derivatives of the tendon's way, so that u', v' follow from a linear
// system at every s. Integrated by Runge and Kutta's rule from the tip, whose frame is the world.
// With friction tau is integrated along: tau' = -mu |t'| tau in world axes, of which t' holds u',
// v' and is found together with them by repeated substitution.
#pragma once

#include <vector>

#include "engine/math/types.h"

namespace cprsim {

/// A helix about the centreline; turns = 0: parallel to it.
struct ReferenceTendon {
  double radius = 0, angle = 0, turns = 0, tension = 0;  ///< at the tip
  double mu = 0;
};

struct PulledReferenceRod {
  double length = 0;
  Vec3 K_bt, K_se;
  std::vector<ReferenceTendon> tendons;
  Vec3 load = Vec3::Zero();   ///< N/m, axes of the tip
  Vec3 force = Vec3::Zero();  ///< N, at the tip, axes of the tip

  bool rubs() const {
    for (const ReferenceTendon& tendon : tendons)
      if (tendon.mu > 0) return true;
    return false;
  }
};

struct ReferenceBase {
  Pose X_TB;  ///< base in the axes of the tip
  Vec3 u, v;  ///< strains at the base
  VecX tensions;
};

ReferenceBase solve_tendon_rod(const PulledReferenceRod& rod, int steps);

}  // namespace cprsim
