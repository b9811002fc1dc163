// SPDX-License-Identifier: BSD-3-Clause
#include "engine/section/section.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cprsim {
namespace {

constexpr double kPi = std::numbers::pi;

// Torsion constant of a rectangle with sides a >= b: 1/3 - 64 b / (pi^5 a) sum tanh(n pi a / 2b) /
// n^5 over odd n. With tanh x = 1 - 2 / (e^2x + 1) all but a few terms are 31/32 zeta(5).
double rectangle_torsion(double a, double b) {
  double sum = 1.0045237627951396;
  for (int n = 1; n <= 11; n += 2)
    sum -= 2 / ((std::exp(n * kPi * a / b) + 1) * std::pow(n, 5));
  return a * b * b * b * (1.0 / 3 - 64 / std::pow(kPi, 5) * (b / a) * sum);
}

void add_material(const MaterialSpec& m, double area, const Vec3& I, SectionProperties& s) {
  const double E = m.youngs_modulus, G = m.shear_modulus;
  s.K_bt += Vec3(E * I.x(), E * I.y(), G * I.z());
  s.K_se += area * Vec3(G, G, E);
  s.rhoA += m.density * area;
  s.rhoJ += m.density * Vec3(I.x(), I.y(), I.x() + I.y());
}

}  // namespace

void section_geometry(const SectionSpec& section, double& area, Vec3& second_moments) {
  const double x = section.size.x(), y = section.size.y();
  switch (section.shape) {
    case SectionShape::kCircle: {
      const double I = kPi / 4 * std::pow(x, 4);
      area = kPi * x * x;
      second_moments = {I, I, 2 * I};
      return;
    }
    case SectionShape::kAnnulus: {
      const double I = kPi / 4 * (std::pow(x, 4) - std::pow(y, 4));
      area = kPi * (x * x - y * y);
      second_moments = {I, I, 2 * I};
      return;
    }
    case SectionShape::kRectangle:
      area = x * y;
      second_moments = {x * y * y * y / 12, y * x * x * x / 12,
                        rectangle_torsion(std::max(x, y), std::min(x, y))};
      return;
    case SectionShape::kEllipse:
      area = kPi * x * y;
      second_moments = {kPi / 4 * x * y * y * y, kPi / 4 * y * x * x * x,
                        kPi * std::pow(x * y, 3) / (x * x + y * y)};
      return;
  }
}

FluidProperties fluid_properties(const DragSpec& drag, double area) {
  const double displaced = drag.fluid_density * area;
  return {drag.normal, drag.tangential, drag.added_mass * displaced, displaced};
}

ThermalExpansion thermal_expansion(const RodSpec& rod) {
  if (rod.layers.empty()) return {rod.material->thermal_expansion, rod.material->thermal_expansion};
  double EA = 0, EI = 0;
  ThermalExpansion sum;
  const auto add = [&](const SectionSpec& section, const MaterialSpec& material) {
    double area = 0;
    Vec3 I;
    section_geometry(section, area, I);
    const double E = material.youngs_modulus;
    EA += E * area;
    EI += E * I.x();
    sum.axial += E * area * material.thermal_expansion;
    sum.bending += E * I.x() * material.thermal_expansion;
  };
  add(rod.section, *rod.material);
  for (const LayerSpec& layer : rod.layers)
    add(layer.section, layer.material);
  return {sum.axial / EA, sum.bending / EI};
}

SectionProperties section_properties(const RodSpec& rod) {
  SectionProperties s;
  section_geometry(rod.section, s.area, s.second_moments);
  if (rod.material) add_material(*rod.material, s.area, s.second_moments, s);
  for (const LayerSpec& layer : rod.layers) {
    double area = 0;
    Vec3 I;
    section_geometry(layer.section, area, I);
    add_material(layer.material, area, I, s);
    s.area += area;
    s.second_moments += I;
  }
  const StiffnessSpec& k = rod.stiffness;
  s.K_bt = {k.bending_x.value_or(s.K_bt.x()), k.bending_y.value_or(s.K_bt.y()),
            k.torsion.value_or(s.K_bt.z())};
  s.K_se = {k.shear_x.value_or(s.K_se.x()), k.shear_y.value_or(s.K_se.y()),
            k.axial.value_or(s.K_se.z())};
  if (rod.damping) {
    const DampingSpec& b = *rod.damping;
    s.B_bt = {b.bending, b.bending, b.torsion};
    s.B_se = {b.shear, b.shear, b.axial};
  }
  s.u_rest = rod.rest_curvature;
  const SectionSpec& outline = rod.outline();
  s.half_width = outline.shape == SectionShape::kRectangle ? 0.5 * outline.size.norm()
                                                           : outline.size.maxCoeff();
  return s;
}

}  // namespace cprsim
