// SPDX-License-Identifier: BSD-3-Clause
// Scenes built in code, for tests of the mechanics.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "engine/robot/equations.h"
#include "engine/run/simulation.h"
#include "engine/solve/newton.h"

namespace cprsim {

/// A round steel rod (E 200 GPa, G 80 GPa, 8000 kg/m³), clamped at the world's origin along z.
RodSpec steel_rod(double length, double radius);

double bending_stiffness(const RodSpec& rod);

/// Kelvin-Voigt damping with one time constant for every strain.
void damp(RodSpec& rod, double tau);

void switch_on(Scene& scene, std::initializer_list<Effect> effects);

/// The load ends at once.
void let_go(LoadSpec& load, double at = 0);

/// Adds a load on rod 0; `until_zero` lets it go at t = 0.
LoadSpec& add_load(Scene& scene, double s, const Vec3& force, const Vec3& torque = Vec3::Zero(),
                   bool until_zero = false);

/// A plane across x at this distance, which may be touched from the side of the origin. Friction is
/// that with rod 0.
void add_wall(Scene& scene, double distance, double friction = 0);

/// The continuum Stewart-Gough robot of Till et al. (hole circles of 87 mm), legs clamped in the
/// base and aligned with the plate's normal; `clamped` ties their spin too.
Scene stewart_gough(const std::vector<double>& lengths, bool clamped, double plate_mass = 0.1);

/// The published robot, legs free to spin, with a length drive on each.
Scene stewart_gough_driven(const std::vector<double>& lengths);

/// A steel rod along z whose tip is held by a body that slides on z, pressed down by a force.
Scene column(double length, double radius, EndJoint base, EndJoint tip, double force);

/// The static equilibrium from the scene alone.
struct Equilibrium {
  Robot robot;
  Equations equations;
  SolveReport report;

  explicit Equilibrium(const Scene& scene, double tolerance = 1e-11);
  ~Equilibrium();

  RodSample rod(std::size_t i = 0) const;
};

/// Runs to the end; the last snapshot.
Snapshot run_to_end(Simulation& simulation);

}  // namespace cprsim
