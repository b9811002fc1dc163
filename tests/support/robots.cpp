// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/robots.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace cprsim {

RodSpec steel_rod(double length, double radius) {
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

double bending_stiffness(const RodSpec& rod) {
  return rod.material->youngs_modulus * std::numbers::pi / 4 * std::pow(rod.section.size.x(), 4);
}

void damp(RodSpec& rod, double tau) {
  const double r = rod.section.size.x(), A = std::numbers::pi * r * r, I = A * r * r / 4;
  const double E = rod.material->youngs_modulus, G = rod.material->shear_modulus;
  rod.damping = DampingSpec{tau * E * I, tau * G * 2 * I, tau * E * A, tau * G * A, {}};
}

void switch_on(Scene& scene, std::initializer_list<Effect> effects) {
  for (Effect e : effects)
    scene.effects.set(e, true);
}

void let_go(LoadSpec& load, double at) {
  ProfileTerm step;
  step.shape = ShapeOfTime::kStep;
  step.from = 1;
  step.start = at;
  load.has_profile = true;
  load.profile.terms.push_back(step);
}

LoadSpec& add_load(Scene& scene, double s, const Vec3& force, const Vec3& torque, bool until_zero) {
  LoadSpec load;
  load.rod = 0;
  load.rod_s = s;
  load.force = force;
  load.torque = torque;
  if (until_zero) let_go(load);
  scene.loads.push_back(load);
  return scene.loads.back();
}

void add_wall(Scene& scene, double distance, double friction) {
  switch_on(scene, {Effect::kContact});
  if (friction > 0) {
    switch_on(scene, {Effect::kFriction});
    scene.rods[0].surface.friction = friction;
  }
  BodySpec wall;
  wall.name = "wall";
  wall.is_static = true;
  wall.X_WB.p = {distance, 0, 0};
  wall.X_WB.R.col(0) = Vec3::UnitZ();
  wall.X_WB.R.col(1) = Vec3::UnitY();
  wall.X_WB.R.col(2) = -Vec3::UnitX();
  ColliderSpec collider;
  collider.name = "plane";
  collider.shape.kind = ShapeKind::kPlane;
  if (friction > 0) collider.surface.friction = friction;
  wall.colliders.push_back(collider);
  scene.bodies.push_back(wall);
}

Scene stewart_gough(const std::vector<double>& lengths, bool clamped, double plate_mass) {
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

Scene stewart_gough_driven(const std::vector<double>& lengths) {
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

Scene column(double length, double radius, EndJoint base, EndJoint tip, double force) {
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

Equilibrium::Equilibrium(const Scene& scene, double tolerance)
    : robot(build_robot(scene)), equations(robot, tolerance) {
  equations.set_instant(0, true, StageRates{});
  equations.mark_start();
  SolveOptions options;
  options.tolerance = tolerance;
  options.max_iterations = 60;
  report = solve_statics(equations, options);
}

Equilibrium::~Equilibrium() = default;

RodSample Equilibrium::rod(std::size_t i) const {
  return robot.rods[i].model->observe();
}

Snapshot run_to_end(Simulation& simulation) {
  simulation.start();
  while (simulation.status() == RunStatus::kRunning)
    simulation.advance();
  return simulation.now();
}

}  // namespace cprsim
