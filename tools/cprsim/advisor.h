// SPDX-License-Identifier: BSD-3-Clause
// The effect advisor: for each rod and effect the dimensionless number that says how much it would
// matter, so that leaving an effect out is a decision.
#pragma once

#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "engine/run/simulation.h"

namespace cprsim {

enum class Advice {
  kNegligible,   ///< number < 1e-4: may be left out
  kOptional,     ///< between
  kListed,       ///< matters and is listed
  kWorthListing  ///< number > 1e-2 and not listed
};

const char* to_string(Advice advice);

struct AdviceLine {
  Effect effect;
  std::string formula;
  double number = 0;
  bool listed = false;
  Advice advice = Advice::kNegligible;
};

/// For one rod.
std::vector<AdviceLine> advise(const Scene& scene, const RodFacts& rod);

}  // namespace cprsim
