// SPDX-License-Identifier: BSD-3-Clause
// Runge-Kutta tables for integration along a rod.
//
// Gauss collocation is the default. Three reasons, each tested: it is of order 2S with S section
// visits per cell; it is symmetric, so that growing and decaying solutions of the arc-length
// problem stay apart on any grid (the grid need not follow the time step); and its stages are fixed
// material points, so that the rod's inertia sits at the same points at every instant. RK4 and
// Euler are there to compare with other programs. Source: Hairer, Nørsett, Wanner, "Solving
// ordinary differential equations I", tables II.1.2, II.7.3-7.4.
#pragma once

#include "engine/model/solver_spec.h"

namespace cprsim {

constexpr int kMaxStages = 4;

struct ArcTableau {
  int stages = 1;
  int order = 1;
  double a[kMaxStages][kMaxStages] = {};
  double b[kMaxStages] = {};
  double c[kMaxStages] = {};
  const char* name = "";
};

constexpr ArcIntegrator kDefaultIntegrator = ArcIntegrator::kGauss6;

/// The table of an integrator.
const ArcTableau& arc_tableau(ArcIntegrator integrator);

}  // namespace cprsim
