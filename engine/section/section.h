// SPDX-License-Identifier: BSD-3-Clause
// Stiffness, damping and inertia of a rod's cross-section, from shape and material or given
// directly.
//
// One letter, one meaning, in all of engine/ (frames: W world, S section; rod-local symbols):
//   s, L     arc length of the unloaded rod, total length            m
//   p, R     centreline point, section orientation (z = tangent)     W
//   u, v     curvature and torsion; shear and stretch, v_rest = z    S; 1/m, 1
//   n, m     internal force and moment, far part on near part        W; N, N m
//   K_bt, K_se, B_bt, B_se   stiffness and Kelvin-Voigt damping      S, diagonal
//   rhoA, rhoJ   mass and inertia per length                         kg/m, kg m
#pragma once

#include "engine/math/types.h"
#include "engine/model/effects.h"
#include "engine/model/rod_spec.h"

namespace cprsim {

/// Of the fluid around a section, per length; all 0 unless the scene lists drag.
struct FluidProperties {
  double normal = 0, tangential = 0;  ///< of the drag, kg/m²
  double added_mass = 0;              ///< across the axis, kg/m
  double displaced_mass = 0;          ///< kg/m

  /// Whether it does more than carry weight.
  bool resists() const { return normal > 0 || tangential > 0 || added_mass > 0; }
};

struct SectionProperties {
  double area = 0;
  Vec3 second_moments = Vec3::Zero();  ///< about x, about y, torsion constant, m⁴
  Vec3 K_bt = Vec3::Zero();            ///< EI_x, EI_y, GJ
  Vec3 K_se = Vec3::Zero();            ///< GA_x, GA_y, EA
  Vec3 B_bt = Vec3::Zero(), B_se = Vec3::Zero();
  Vec3 u_rest = Vec3::Zero();  ///< curvature and twist of the unloaded rod, the same all along it
  double rhoA = 0;
  Vec3 rhoJ = Vec3::Zero();  ///< rho (I_x, I_y, I_x + I_y)
  double half_width = 0;     ///< largest distance from the centre, m
  FluidProperties fluid;

  /// What gravity pulls at: mass per length less that of the fluid displaced.
  double weighing_mass() const { return rhoA - fluid.displaced_mass; }
};

/// Area, I_x, I_y and Saint-Venant torsion constant of a shape. Rectangle: the series of Timoshenko
/// & Goodier, Theory of Elasticity, art. 109; ellipse: ibid. art. 105.
void section_geometry(const SectionSpec& section, double& area, Vec3& second_moments);

/// The part of the fluid that the rod's <drag> describes.
FluidProperties fluid_properties(const DragSpec& drag, double area);

/// Relative, 1/K: of the length where all of the section is warmed, and of bending where a gradient
/// warms one side. Of layers the averages by their stiffness; where they are alike, both are
/// theirs.
struct ThermalExpansion {
  double axial = 0, bending = 0;
};

/// Of a rod with a material.
ThermalExpansion thermal_expansion(const RodSpec& rod);

/// All properties but the fluid's. Layers bonded to a round section strain with it as one: about
/// the common centre their stiffnesses and inertias add up. Direct stiffnesses replace the sums.
SectionProperties section_properties(const RodSpec& rod);

}  // namespace cprsim
