// SPDX-License-Identifier: BSD-3-Clause
// The effects a scene may call for. Bending and torsion are always there; nothing else is.
#pragma once

#include <array>

#include "engine/model/place.h"

namespace cprsim {

enum class Effect {
  kGravity,
  kExtension,
  kShear,
  kRotaryInertia,
  kDamping,
  kDrag,
  kContact,
  kSelfContact,
  kFriction,
  kTendonFriction,
  kMagnetic,
  kThermal
};
constexpr int kEffectCount = 12;

/// Name as written in a scene, e.g. "rotary_inertia".
const char* effect_name(Effect effect);

struct Effects {
  std::array<bool, kEffectCount> on{};
  std::array<Place, kEffectCount> asked_at{};

  bool has(Effect e) const { return on[static_cast<std::size_t>(e)]; }

  void set(Effect e, bool value, Place place = {}) {
    on[static_cast<std::size_t>(e)] = value;
    asked_at[static_cast<std::size_t>(e)] = place;
  }
};

}  // namespace cprsim
