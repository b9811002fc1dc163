// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/field.h"

namespace cprsim {

void describe_section(RodField& field, const SectionProperties& section, bool shear,
                      bool extension) {
  field.K_bt = section.K_bt;
  if (shear) field.K_se.head<2>() = section.K_se.head<2>();
  if (extension) field.K_se.z() = section.K_se.z();
  field.rhoA = section.rhoA;
  field.added_mass = section.fluid.added_mass;
  field.rhoJ = section.rhoJ;
}

}  // namespace cprsim
