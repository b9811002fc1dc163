// SPDX-License-Identifier: BSD-3-Clause
// The numbers: gravity ρAgL³/EI, shear EI/(κGA L²), extension I/(A L²), rotary inertia of
// sections and disks J/(M L²), damping
// the ratio ζ₁ of the first bending mode, drag the largest ratio of a fluid's forces to the rod's
// own, magnetic M B L²/EI, thermal the largest of elongation, turn and what clamps make of it
// (engine/run/facts.cpp).
#include "tools/cprsim/advisor.h"

namespace cprsim {

namespace {

constexpr double kNegligibleBelow = 1e-4;
constexpr double kMattersAbove = 1e-2;

Advice judge(double number, bool listed) {
  if (number < kNegligibleBelow) return Advice::kNegligible;
  if (number <= kMattersAbove) return Advice::kOptional;
  return listed ? Advice::kListed : Advice::kWorthListing;
}

}  // namespace

const char* to_string(Advice advice) {
  switch (advice) {
    case Advice::kNegligible:
      return "negligible";
    case Advice::kOptional:
      return "small";
    case Advice::kListed:
      return "matters, listed";
    case Advice::kWorthListing:
      return "matters, NOT listed";
  }
  return "";
}

std::vector<AdviceLine> advise(const Scene& scene, const RodFacts& rod) {
  std::vector<AdviceLine> lines;
  const auto add = [&](Effect effect, const char* formula, double number) {
    const bool listed = scene.effects.has(effect);
    lines.push_back({effect, formula, number, listed, judge(number, listed)});
  };
  add(Effect::kGravity, "rho A g L^3 / EI", rod.gravity_number);
  add(Effect::kShear, "EI / (k G A L^2)", rod.shear_number);
  add(Effect::kExtension, "I / (A L^2)", rod.extension_number);
  // without <drag> nothing is known of the fluid
  if (rod.drag_number > 0) add(Effect::kDrag, "fluid / own force", rod.drag_number);
  // likewise of magnets and heat
  if (rod.magnetic_number > 0) add(Effect::kMagnetic, "M B L^2 / EI", rod.magnetic_number);
  if (rod.thermal_number > 0) add(Effect::kThermal, "alpha T, alpha g L", rod.thermal_number);
  if (scene.simulation.mode == Mode::kDynamic) {
    if (rod.rolling_number > 0)
      add(Effect::kRotaryInertia, "J / (J + M r^2)", rod.rolling_number);
    else
      add(Effect::kRotaryInertia, "J / (M L^2)", rod.rotary_number);
    add(Effect::kDamping, "zeta_1", rod.damping_ratio);
  }
  return lines;
}

}  // namespace cprsim
