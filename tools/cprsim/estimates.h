// SPDX-License-Identifier: BSD-3-Clause
// What leaving an effect out, or listing it, is estimated to change, without a run.
//
// At rest: the equilibrium at t = 0 moves by one Newton step of the robot with one effect less or
// more, to first order in what that effect does; in quasi-statics the equilibria at six instants
// do, those that are found from where the robot starts. In motion the phase of a swing a drifts:
// with n = I/(A L²) or EI/(k G A L²) the first frequency changes by 2.3 n of itself (Rayleigh's
// quotient of the cantilever's first mode, half of (integral of y'²)/(integral of y²) = 4.65/L²),
//   change = a min(1, 2.3 n omega t),  t the duration or, if it is less, 1/(zeta omega)   (1)
// Damping takes a min(1, zeta omega t), drag a min(1, its number) (engine/run/facts.cpp). The swing
// is what loads do to the equilibrium. Magnets and heat that grow during a run do what their
// numbers say: a third of M B L²/EI, half of alpha T or alpha g L.
#pragma once

#include <string>
#include <vector>

#include "engine/run/simulation.h"
#include "tools/cprsim/scene_options.h"

namespace cprsim {

struct EffectEstimate {
  Effect effect;
  bool listed = false;  ///< the change is that of leaving it out, otherwise of listing it
  double change = 0;    ///< over the longest rod's length, at most 1
  const char* by = "";  ///< "equilibrium", "motion", "number"
  std::string unknown;  ///< why there is no estimate; empty: there is one
};

struct EffectEstimates {
  std::string watched;  ///< the channel that changes
  double length = 0;    ///< of the longest rod, m
  std::vector<EffectEstimate> effects;
};

/// @param path of the scene, which is read again with each effect more or less
EffectEstimates estimate_effects(const std::string& path, const SceneOptions& options,
                                 const Scene& scene, const ProblemFacts& facts);

}  // namespace cprsim
