// SPDX-License-Identifier: BSD-3-Clause
// Why a solve may have failed, judged from the numbers of the problem; the likeliest first, at most
// five.
#pragma once

#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "engine/run/simulation.h"

namespace cprsim {

/// @param time s simulated when it failed
/// @param started the start was found; false: the static equilibrium at t = 0 was not
std::vector<std::string> likely_causes(const Scene& scene, const ProblemFacts& facts,
                                       const SolveReport& solve, double time, bool started);

}  // namespace cprsim
