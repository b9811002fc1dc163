// SPDX-License-Identifier: BSD-3-Clause
#include "tests/effects/paired_effects.h"

#include "tests/support/tendons.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 0.02;
constexpr double kSoft = 25;  // N: what extension and shear give way by at their full amplitude

void add_gravity(Scene& scene, double share) {
  switch_on(scene, {Effect::kGravity});
  scene.gravity = share * Vec3(0.6, 0, -1);
}

void add_extension(Scene& scene, double share) {
  switch_on(scene, {Effect::kExtension});
  scene.rods[0].stiffness.axial = kSoft / share;
}

void add_shear(Scene& scene, double share) {
  switch_on(scene, {Effect::kShear});
  scene.rods[0].stiffness.shear_x = scene.rods[0].stiffness.shear_y = kSoft / share;
}

void add_rotary_inertia(Scene& scene, double) {
  switch_on(scene, {Effect::kRotaryInertia});
}

void add_damping(Scene& scene, double share) {
  switch_on(scene, {Effect::kDamping});
  const double tau = 2e-3 * share;  // s, of 0.1 N m² in bending
  scene.rods[0].damping = DampingSpec{0.1 * tau, 0.1 * tau, kSoft * tau, kSoft * tau, {}};
}

void add_fluid(Scene& scene, double share) {
  switch_on(scene, {Effect::kDrag});
  scene.wind = {4, 0, 1.5};
  DragSpec air;
  air.normal = 0.02 * share;
  air.tangential = 0.002 * share;
  air.fluid_density = 8 * share;
  air.added_mass = 1;
  scene.rods[0].drag = air;
}

void add_line_load(Scene& scene, double share) {
  LoadSpec& load = add_load(scene, 0, share * Vec3(-0.3, 0, 0.1), share * Vec3(0, 0.02, 0));
  load.to = 1;
  load.follower = true;
}

void add_follower(Scene& scene, double share) {
  add_load(scene, 0.6, share * Vec3(-0.08, 0, 0.04)).follower = true;
}

void add_wound_tendon(Scene& scene, double share) {
  add_tendon(scene, 0.03, 0.4, 0.4 * share, 0.3);
}

// holds the first millimetres of the side that is pulled apart; pulled in a little, so that it is
// taut
void add_displaced_tendon(Scene& scene, double) {
  add_tendon(scene, 0.03, std::numbers::pi, 0).termination = 0.05;
  displace(scene, 2e-4);
}

void add_rubbing_tendon(Scene& scene, double share) {
  switch_on(scene, {Effect::kTendonFriction});
  add_tendon(scene, 0.03, 0, 0.4 * share).friction = 0.4;
}

void add_taper(Scene& scene, double share) {
  SectionSpec thick = scene.rods[0].section, thin = thick;
  thin.s = 1;
  thin.size *= 1 - 0.1 * share;
  scene.rods[0].sections = {thick, thin};
}

void add_magnet(Scene& scene, double share) {
  switch_on(scene, {Effect::kMagnetic});
  scene.rods[0].magnets.push_back({0, 1, {0, 0, 1}});
  MagneticFieldSpec even, dipole;
  even.uniform = {-0.04 * share, 0, 0};
  dipole.dipole = true;
  dipole.position = {0.4, 0, 0.6};
  dipole.moment = {0, 0, 4000 * share};
  scene.magnetic_fields = {even, dipole};
}

void add_heat(Scene& scene, double share) {
  switch_on(scene, {Effect::kThermal});
  scene.rods[0].material->thermal_expansion = 1e-4;
  scene.rods[0].temperature.emplace();
  scene.rods[0].temperature->gradient = share * Vec2(1500, 0);
}

void add_disks(Scene& scene, double share) {
  scene.rods[0].disks = {{0.5, 0.004 * share, 0.03}, {1, 0.002 * share, 0.03}};
}

void add_rest_curvature(Scene& scene, double share) {
  scene.rods[0].rest_curvature = share * Vec3(0, 0.15, 0);
}

// fed from its first instant on, or longer than the rod from the start, where nothing moves
void add_feed(Scene& scene, double share) {
  DriveSpec drive;
  drive.quantity = DriveQuantity::kLength;
  drive.rod = 0;
  ProfileTerm ramp;
  ramp.shape = ShapeOfTime::kSmoothstep;
  ramp.from = scene.simulation.mode == Mode::kDynamic ? kLength : (1 + 0.04 * share) * kLength;
  ramp.to = (1 + 0.04 * share) * kLength;
  ramp.start = 0;
  ramp.end = 0.06;
  drive.profile.terms.push_back(ramp);
  scene.drives.push_back(drive);
}

// the base turns on a spring instead of being clamped
void add_sprung_base(Scene& scene, double share) {
  BodySpec holder;
  holder.name = "holder";
  holder.mass = 1e-3;
  holder.inertia = 1e-6 * Mat3::Identity();
  const int index = static_cast<int>(scene.bodies.size());
  scene.bodies.push_back(holder);
  JointSpec hinge;
  hinge.name = "hinge";
  hinge.kind = JointKind::kRevolute;
  hinge.axis = Vec3::UnitY();
  hinge.child = index;
  hinge.spring_stiffness = 10 / share;
  hinge.damping = 0.05 / share;
  scene.joints.push_back(hinge);
  scene.rods[0].base.at.body = index;
}

void add_rubbing_base(Scene& scene, double share) {
  add_sprung_base(scene, share);
  scene.joints.back().friction = 0.03;
}

}  // namespace

std::vector<PairedEffect> paired_effects() {
  return {{.name = "gravity", .add = add_gravity},
          {.name = "extension", .add = add_extension},
          {.name = "shear", .add = add_shear},
          {.name = "rotary inertia", .add = add_rotary_inertia, .moving = true, .whole = true},
          {.name = "damping", .add = add_damping, .moving = true},
          {.name = "fluid", .add = add_fluid},
          {.name = "load along it", .add = add_line_load},
          {.name = "follower", .add = add_follower},
          {.name = "tendon", .add = add_wound_tendon, .in_plane = false},
          {.name = "tendon of given length", .add = add_displaced_tendon, .constrains = true},
          {.name = "tendon that rubs", .add = add_rubbing_tendon},
          {.name = "taper", .add = add_taper},
          {.name = "magnetic", .add = add_magnet},
          {.name = "thermal", .add = add_heat},
          {.name = "disks", .add = add_disks},
          {.name = "rest curvature", .add = add_rest_curvature},
          {.name = "feed", .add = add_feed},
          {.name = "sprung base", .add = add_sprung_base, .at_base = true},
          {.name = "sprung base that rubs", .add = add_rubbing_base, .at_base = true}};
}

Scene rod_for_pairs(bool moves) {
  Scene scene;
  RodSpec rod = steel_rod(kLength, kRadius);
  rod.material->density = 80;
  rod.material->youngs_modulus = 8e5;  // EI 0.1 N m²
  rod.material->shear_modulus = 3e5;
  scene.rods.push_back(rod);
  // the motion is slow: a rod that stretches a little would otherwise ring, the faster the less
  LoadSpec& load = add_load(scene, 1, {0.5, 0, -0.2});
  ProfileTerm rise;
  rise.shape = ShapeOfTime::kSmoothstep;
  rise.from = moves ? 0 : 1;
  rise.to = 1;
  rise.end = 0.1;
  load.has_profile = true;
  load.profile.terms.push_back(rise);
  if (!moves) return scene;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.12;
  return scene;
}

bool may_be_combined(const PairedEffect& a, const PairedEffect& b) {
  return !(a.at_base && b.at_base);
}

}  // namespace cprsim
