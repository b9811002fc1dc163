// SPDX-License-Identifier: BSD-3-Clause
// Solving with contacts: a smooth problem for a given set of touching points, and the set revised
// until it fits.
#pragma once

#include "engine/robot/contacts.h"
#include "engine/robot/equations.h"
#include "engine/solve/newton.h"

namespace cprsim {

/// Goes on from a first solve. @return its report with what was added; kStalled where the points
/// find no rest
SolveReport settle_contacts(RodContacts& contacts, Problem& problem, const SolveOptions& options,
                            SolveReport first);

/// The static equilibrium reached when loads grow from nothing, rods assembled without them: with
/// obstacles there are many, and this is the one that is led to. On failure the unknowns are those
/// of the largest part of the loads that could be carried.
SolveReport load_gradually(RodContacts& contacts, Equations& equations,
                           const SolveOptions& options);

/// Rods in the shapes they were given, as springs along them hold them there that are so stiff that
/// what else acts, joints excepted, matters little.
SolveReport hold_shape(Equations& equations, const SolveOptions& options);

/// From there to the equilibrium that a rod in syrup comes to when it is let go: the springs become
/// drag, which falls step by step (engine/solve/newton.h, relaxation()), and what touches on the
/// way is touched. Friction counts from the shape that was given: it is Coulomb's, found as the
/// limit of friction that is bounded by what pressed a solve before, which needs no set of sticking
/// points to be guessed.
SolveReport relax_from_shape(RodContacts& contacts, Equations& equations,
                             const SolveOptions& options);

}  // namespace cprsim
