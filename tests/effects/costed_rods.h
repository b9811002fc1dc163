// SPDX-License-Identifier: BSD-3-Clause
// One rod in every combination of effects whose cost is told, at rest or at the first stage of a
// time step: what tests of costs and docs/effects.md measure.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/support/methods.h"
#include "tests/support/robots.h"

namespace cprsim {

struct RodCase {
  const char* name;  ///< of the effect that it adds to the rod without any
  bool moving = false;
  std::function<void(Scene&)> add = [](Scene&) {};
};

/// The rod without effects first, at rest and moving; then one effect each.
std::vector<RodCase> costed_cases();

/// A steel rod of 0.4 m and 2 mm, clamped, bent by 0.5 N at its tip, by ten steps of shooting, one
/// element of strains or four of collocation; by so many times more of them with `fineness`.
class CostedRod {
 public:
  CostedRod(const RodCase& of, Method method, int fineness = 1);

  RodModel& model() { return *equilibrium_.robot.rods[0].model; }

  Port base() const { return equilibrium_.robot.port(equilibrium_.robot.rods[0].base); }

  Port tip() const { return equilibrium_.robot.port(equilibrium_.robot.rods[0].tip); }

 private:
  Scene scene_;
  Equilibrium equilibrium_;
  Stepper stepper_{{SchemeKind::kEsdirk32}};
};

}  // namespace cprsim
