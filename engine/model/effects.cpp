// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/effects.h"

namespace cprsim {

const char* effect_name(Effect effect) {
  constexpr std::array<const char*, kEffectCount> kNames{
      "gravity", "extension",    "shear",    "rotary_inertia",  "damping",  "drag",
      "contact", "self_contact", "friction", "tendon_friction", "magnetic", "thermal"};
  return kNames[static_cast<std::size_t>(effect)];
}

}  // namespace cprsim
