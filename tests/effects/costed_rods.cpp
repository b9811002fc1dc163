// SPDX-License-Identifier: BSD-3-Clause
#include "tests/effects/costed_rods.h"

#include "tests/support/tendons.h"

namespace cprsim {
namespace {

Scene bent_rod(const RodCase& of, Method method, int fineness) {
  Scene scene;
  scene.solver.method = method;
  scene.solver.points = 10 * fineness;
  scene.solver.order = 6;
  scene.solver.elements = (method == Method::kCollocation ? 4 : 1) * fineness;
  scene.solver.degree = 7;
  scene.rods.push_back(steel_rod(0.4, 1e-3));
  add_load(scene, 1, {0.5, 0, 0});
  of.add(scene);
  return scene;
}

void taper(Scene& scene) {
  SectionSpec thick = scene.rods[0].section, thin = thick;
  thin.s = 1;
  thin.size *= 0.9;
  scene.rods[0].sections = {thick, thin};
}

void immerse(Scene& scene) {
  switch_on(scene, {Effect::kDrag});
  DragSpec water;
  water.normal = 1;
  water.tangential = 0.01;
  water.fluid_density = 1000;
  water.added_mass = 1;
  scene.rods[0].drag = water;
}

void magnetize(Scene& scene, const MagneticFieldSpec& field) {
  switch_on(scene, {Effect::kMagnetic});
  scene.rods[0].magnets.push_back({0, 1, {0, 0, 1}});
  scene.magnetic_fields.push_back(field);
}

void magnetize_uniformly(Scene& scene) {
  MagneticFieldSpec field;
  field.uniform = {0.1, 0, 0};
  magnetize(scene, field);
}

void magnetize_by_dipole(Scene& scene) {
  MagneticFieldSpec field;
  field.dipole = true;
  field.position = {0.3, 0, 0.4};
  field.moment = {0, 0, 500};
  magnetize(scene, field);
}

void heat(Scene& scene) {
  switch_on(scene, {Effect::kExtension, Effect::kThermal});
  scene.rods[0].material->thermal_expansion = 1.2e-5;
  scene.rods[0].temperature.emplace();
  scene.rods[0].temperature->rise = 50;
  scene.rods[0].temperature->gradient = {1000, 0};
}

void carry_disks(Scene& scene) {
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {0, 0, -9.81};
  scene.rods[0].disks = {{0.5, 0.002, 0.01}, {1, 0.002, 0.01}};
}

}  // namespace

std::vector<RodCase> costed_cases() {
  const auto listed = [](Effect effect) {
    return [effect](Scene& scene) { switch_on(scene, {effect}); };
  };
  return {{"none, at rest"},
          {"none, moving", true},
          {"gravity", false,
           [](Scene& scene) {
             switch_on(scene, {Effect::kGravity});
             scene.gravity = {0, 0, -9.81};
           }},
          {"extension, at rest", false, listed(Effect::kExtension)},
          {"extension, moving", true, listed(Effect::kExtension)},
          {"shear, at rest", false, listed(Effect::kShear)},
          {"shear, moving", true, listed(Effect::kShear)},
          {"rotary_inertia", true, listed(Effect::kRotaryInertia)},
          {"damping", true,
           [](Scene& scene) {
             switch_on(scene, {Effect::kDamping});
             damp(scene.rods[0], 1e-3);
           }},
          {"drag", true, immerse},
          {"load along it", false,
           [](Scene& scene) {
             LoadSpec& load = add_load(scene, 0, {1, 0, 0});
             load.to = 1;
             load.follower = true;
           }},
          {"tendon", false, [](Scene& scene) { add_tendon(scene, 8e-3, 0, 1); }},
          {"tendon friction", false,
           [](Scene& scene) {
             switch_on(scene, {Effect::kTendonFriction});
             add_tendon(scene, 8e-3, 0, 1).friction = 0.2;
           }},
          {"varying sections", false, taper},
          {"magnetic, uniform field", false, magnetize_uniformly},
          {"magnetic, dipole", false, magnetize_by_dipole},
          {"thermal", false, heat},
          {"disks", false, carry_disks},
          {"planar, at rest", false, [](Scene& scene) { scene.planar_normal = Vec3::UnitY(); }},
          {"planar, moving", true, [](Scene& scene) { scene.planar_normal = Vec3::UnitY(); }}};
}

CostedRod::CostedRod(const RodCase& of, Method method, int fineness)
    : scene_(bent_rod(of, method, fineness)), equilibrium_(scene_, 1e-9) {
  if (!of.moving) return;
  Robot& robot = equilibrium_.robot;
  for (RobotRod& rod : robot.rods)
    rod.model->start_tracks();
  const std::vector<Track*> tracks = robot.tracks();
  stepper_.begin_step(1e-3, tracks);
  equilibrium_.equations.set_instant(0, true, stepper_.begin_stage(0, tracks));
}

}  // namespace cprsim
