// SPDX-License-Identifier: BSD-3-Clause
// What loads, tendons, magnetic fields and heat do to a rod at an instant.
#include <algorithm>

#include "engine/robot/robot.h"

namespace cprsim {

PointLoad load_at(const LoadSpec& load, double t, bool before) {
  const double f = load.has_profile ? load.profile.evaluate(t, before).value : 1.0;
  return {load.rod_s, f * (load.R_expressed * load.force), f * (load.R_expressed * load.torque),
          load.follower};
}

LineLoad line_load_at(const LoadSpec& load, double t, bool before) {
  const PointLoad at = load_at(load, t, before);
  LineLoad line{load.rod_s, *load.to, at.force, at.torque, at.follower, {}};
  if (load.law < 0) return line;
  line.law.law = load.law;
  line.law.from = line.from;
  line.law.to = line.to;
  line.law.strength = load.has_profile ? load.profile.evaluate(t, before).value : 1.0;
  std::copy(load.law_values.begin(), load.law_values.end(), line.law.values);
  return line;
}

MagneticSources sources_at(const MagneticFieldSpec& field, double t, bool before) {
  const double f = field.has_profile ? field.profile.evaluate(t, before).value : 1.0;
  MagneticSources sources;
  if (!field.dipole) {
    sources.uniform = f * field.uniform;
    return sources;
  }
  const Vec3 &p = field.position, m = f * field.moment;
  sources.dipoles.push_back({{p.x(), p.y(), p.z()}, {m.x(), m.y(), m.z()}});
  return sources;
}

MagneticSources sources_at(const Scene& scene, double t, bool before, double share) {
  MagneticSources all;
  for (const MagneticFieldSpec& field : scene.magnetic_fields) {
    const MagneticSources one = sources_at(field, t, before);
    all.uniform += share * one.uniform;
    for (MagneticDipole dipole : one.dipoles) {
      for (double& component : dipole.moment)
        component *= share;
      all.dipoles.push_back(dipole);
    }
  }
  return all;
}

// A section at T(x, y) = T + g_x x + g_y y stretches by alpha T(x, y) = (u × r)_z = u_x y - u_y x
// and alpha T.
ThermalStrain thermal_strain_at(const RodSpec& rod, double t, bool before) {
  const TemperatureSpec& heat = *rod.temperature;
  const double f = heat.has_profile ? heat.profile.evaluate(t, before).value : 1.0;
  const ThermalExpansion alpha = thermal_expansion(rod);
  return {f * alpha.bending * Vec3(heat.gradient.y(), -heat.gradient.x(), 0),
          f * alpha.axial * heat.rise};
}

TendonPull pull_at(const RobotTendon& tendon, double t, bool before) {
  if (!tendon.drive) return {};
  return {tendon.drive->profile.evaluate(t, before).value,
          tendon.drive->quantity == DriveQuantity::kDisplacement};
}

void pull_tendons(RobotRod& rod, double t, bool before, double share) {
  for (double s : rod.breaks) {
    rod.forcing.loads.emplace_back();
    rod.forcing.loads.back().s = s;
  }
  rod.forcing.tendons.clear();
  for (const RobotTendon& tendon : rod.tendons) {
    rod.forcing.tendons.push_back(pull_at(tendon, t, before));
    rod.forcing.tendons.back().value *= share;
  }
}

}  // namespace cprsim
