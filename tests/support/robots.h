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
inline RodSpec steel_rod(double length, double radius) {
  RodSpec rod;
  rod.name = "rod";
  rod.length = length;
  rod.section.size = {radius, 0};
  MaterialSpec steel;
  steel.density = 8000;
  steel.youngs_modulus = 200e9;
  steel.shear_modulus = 80e9;
  rod.material = steel;
  rod.base.joint = EndJoint::kFixed;
  return rod;
}

inline double bending_stiffness(const RodSpec& rod) {
  return rod.material->youngs_modulus * std::numbers::pi / 4 * std::pow(rod.section.size.x(), 4);
}

/// Kelvin-Voigt damping with one time constant for every strain.
inline void damp(RodSpec& rod, double tau) {
  const double r = rod.section.size.x(), A = std::numbers::pi * r * r, I = A * r * r / 4;
  const double E = rod.material->youngs_modulus, G = rod.material->shear_modulus;
  rod.damping = DampingSpec{tau * E * I, tau * G * 2 * I, tau * E * A, tau * G * A, {}};
}

inline void switch_on(Scene& scene, std::initializer_list<Effect> effects) {
  for (Effect e : effects)
    scene.effects.set(e, true);
}

/// The load ends at once.
inline void let_go(LoadSpec& load, double at = 0) {
  ProfileTerm step;
  step.shape = ShapeOfTime::kStep;
  step.from = 1;
  step.start = at;
  load.has_profile = true;
  load.profile.terms.push_back(step);
}

/// Adds a load on rod 0; `until_zero` lets it go at t = 0.
inline LoadSpec& add_load(Scene& scene, double s, const Vec3& force,
                          const Vec3& torque = Vec3::Zero(), bool until_zero = false) {
  LoadSpec load;
  load.rod = 0;
  load.rod_s = s;
  load.force = force;
  load.torque = torque;
  if (until_zero) let_go(load);
  scene.loads.push_back(load);
  return scene.loads.back();
}

/// The continuum Stewart-Gough robot of Till et al. (hole circles of 87 mm), legs clamped in the
/// base and aligned with the plate's normal; `clamped` ties their spin too.
inline Scene stewart_gough(const std::vector<double>& lengths, bool clamped,
                           double plate_mass = 0.1) {
  constexpr double kDegree = std::numbers::pi / 180, kRadius = 0.087;
  constexpr double kBase[] = {-10, 10, 110, 130, 230, 250}, kPlate[] = {-50, 50, 70, 170, 190, 290};
  Scene scene;
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear});
  BodySpec plate;
  plate.name = "plate";
  plate.mass = plate_mass;
  plate.inertia = plate_mass * Vec3(2.25625e-3, 2.25625e-3, 4.5125e-3).asDiagonal();
  plate.X_WB.p = {0, 0, 0.4};
  scene.bodies.push_back(plate);
  for (std::size_t i = 0; i < 6; ++i) {
    RodSpec leg = steel_rod(lengths[i], 1e-3);
    leg.name = "leg_" + std::to_string(i + 1);
    leg.base.at.X_BF.p =
        kRadius * Vec3(std::cos(kBase[i] * kDegree), std::sin(kBase[i] * kDegree), 0);
    leg.tip.joint = EndJoint::kFixed;
    leg.tip.spin_free = !clamped;
    leg.tip.at.body = 0;
    leg.tip.at.X_BF.p =
        kRadius * Vec3(std::cos(kPlate[i] * kDegree), std::sin(kPlate[i] * kDegree), 0);
    scene.rods.push_back(leg);
  }
  return scene;
}

/// The published robot, legs free to spin, with a length drive on each.
inline Scene stewart_gough_driven(const std::vector<double>& lengths) {
  Scene scene = stewart_gough(lengths, false);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    DriveSpec drive;
    drive.quantity = DriveQuantity::kLength;
    drive.rod = static_cast<int>(i);
    ProfileTerm term;
    term.value = lengths[i];
    drive.profile.terms.push_back(term);
    scene.drives.push_back(drive);
  }
  return scene;
}

/// A steel rod along z whose tip is held by a body that slides on z, pressed down by a force.
inline Scene column(double length, double radius, EndJoint base, EndJoint tip, double force) {
  Scene scene;
  RodSpec rod = steel_rod(length, radius);
  rod.base.joint = base;
  rod.tip.joint = tip;
  rod.tip.at = {0, Pose{}};
  scene.rods.push_back(rod);
  BodySpec slider;
  slider.name = "slider";
  slider.X_WB.p = {0, 0, length};
  scene.bodies.push_back(slider);
  JointSpec rail;
  rail.name = "rail";
  rail.kind = JointKind::kPrismatic;
  rail.child = 0;
  rail.X_PJ.p = {0, 0, length};
  scene.joints.push_back(rail);
  LoadSpec load;
  load.at.body = 0;
  load.force = {0, 0, -force};
  scene.loads.push_back(load);
  return scene;
}

/// The static equilibrium from the scene alone.
struct Equilibrium {
  Robot robot;
  Equations equations;
  SolveReport report;

  explicit Equilibrium(const Scene& scene, double tolerance = 1e-11)
      : robot(build_robot(scene)), equations(robot, tolerance) {
    equations.set_instant(0, true, StageRates{});
    equations.mark_start();
    SolveOptions options;
    options.tolerance = tolerance;
    options.max_iterations = 60;
    report = solve_statics(equations, options);
  }

  RodSample rod(std::size_t i = 0) const { return robot.rods[i].model->observe(); }
};

/// Runs to the end; the last snapshot.
inline Snapshot run_to_end(Simulation& simulation) {
  simulation.start();
  while (simulation.status() == RunStatus::kRunning)
    simulation.advance();
  return simulation.now();
}

}  // namespace cprsim
