// SPDX-License-Identifier: BSD-3-Clause
// What an equilibrium looks like at a rod's quadrature points: all that the second variation of its
// energy needs, whatever the method that found it.
#pragma once

#include <vector>

#include "engine/math/types.h"
#include "engine/rod/cell.h"
#include "engine/section/section.h"

namespace cprsim {

/// One quadrature point; world axes.
struct FieldPoint {
  Mat3 R;     ///< section axes
  Vec3 tau;   ///< centreline's derivative by arc length
  Vec3 n, m;  ///< internal force, moment
};

/// A rigid disk where two cells meet, or at the tip.
struct FieldDisk {
  std::size_t cells = 0;  ///< before it
  double mass = 0;        ///< kg
  Vec3 J = Vec3::Zero();  ///< about section axes, kg m²; whether or not rotary inertia is listed
  Mat3 R = Mat3::Identity();  ///< of the section
};

/// Points are those of a Runge-Kutta collocation: cell by cell, table->stages each.
struct RodField {
  const ArcTableau* table = nullptr;
  std::vector<double> cells;       ///< lengths, m
  std::vector<FieldPoint> points;  ///< cells × stages
  NodeState base{}, tip{};         ///< ends, before a load on the base and after one on the tip
  Vec3 K_bt = Vec3::Zero();        ///< bending, bending, torsion, N m²
  Vec3 K_se = Vec3::Zero();        ///< shear, shear, extension, N; 0 where the strain is not free
  std::vector<Mat6> tendons;       ///< stiffness (u, v) of tendons at the points, section axes
  std::vector<Mat6> magnetic;      ///< stiffness (phi, d) of a magnetic field, world axes, N
  std::vector<MatX> locked;        ///< 6 × n there: stretch of tendons of given length by (u, v)
  double rhoA = 0;
  double added_mass = 0;     ///< of a fluid, across the tangent, kg/m
  Vec3 rhoJ = Vec3::Zero();  ///< whether or not the scene lists rotary inertia

  std::vector<SectionProperties> sections;  ///< of the points, where they vary
  std::vector<FieldDisk> disks;

  /// At the next point.
  void add_tendons(const Mat6& stiffness, const MatX& held) {
    tendons.push_back(stiffness);
    locked.push_back(held);
  }
};

/// The part that a cross-section decides; a strain that is not free has no stiffness here.
void describe_section(RodField& field, const SectionProperties& section, bool shear,
                      bool extension);

}  // namespace cprsim
