// SPDX-License-Identifier: BSD-3-Clause
#include "engine/run/facts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/rod/shooting.h"
#include "engine/section/along.h"

namespace cprsim {
namespace {

constexpr double kFirstRoot = 1.8751040687119611;  // of cos x cosh x = -1: clamped-free beam

/// The largest of: force of the current and lost weight over the bending force, c_n U²L³/EI and
/// rho_f A g L³/EI; in motion drag and added mass over inertia, c_n L/(rho A) and m_a/(rho A).
double drag_number(const RodSpec& spec, const SectionProperties& s, const Scene& scene, double L) {
  const FluidProperties fluid = fluid_properties(*spec.drag, s.area);
  const double per_force = std::pow(L, 3) / std::min(s.K_bt.x(), s.K_bt.y());
  double number = fluid.normal * scene.wind.squaredNorm() * per_force;
  if (scene.effects.has(Effect::kGravity))
    number = std::max(number, fluid.displaced_mass * scene.gravity.norm() * per_force);
  if (scene.simulation.mode == Mode::kDynamic && s.rhoA > 0)
    number = std::max({number, fluid.normal * L / s.rhoA, fluid.added_mass / s.rhoA});
  return number;
}

/// Largest size of a function of time during the run.
double peak(const Profile& profile, double end) {
  constexpr int kSamples = 1000;
  std::vector<double> times = profile.breakpoints(end);
  for (int k = 0; k <= kSamples; ++k)
    times.push_back(end * k / kSamples);
  double most = 0;
  for (const double t : times)
    for (const bool before : {false, true})
      most = std::max(most, std::abs(profile.evaluate(t, before).value));
  return most;
}

/// Torque over bending moment, M B L²/EI: a uniform field, or that of a dipole at the distance of
/// the base.
double magnetic_number(const RobotRod& rod, const Vec3& base, const Scene& scene, double EI) {
  double M = 0, B = 0;
  for (const MagnetSpec& magnet : rod.spec->magnets)
    M += magnet.moment.norm() * (magnet.to - magnet.from);
  for (const MagneticFieldSpec& field : scene.magnetic_fields) {
    const double f = field.has_profile ? peak(field.profile, scene.simulation.duration) : 1;
    const double r = (field.position - base).norm();
    B += f * (field.dipole ? 2e-7 * field.moment.norm() / std::max(r * r * r, 1e-300)
                           : field.uniform.norm());
  }
  return M * B * rod.length * rod.length / EI;
}

/// The largest of: relative elongation alpha T; turn alpha g L (rad); where both ends are held, the
/// force that this takes over the bending force, alpha T EA L²/EI.
double thermal_number(const RobotRod& rod, const Scene& scene, double EI) {
  const TemperatureSpec& heat = *rod.spec->temperature;
  const double f = heat.has_profile ? peak(heat.profile, scene.simulation.duration) : 1,
               L = rod.length;
  const ThermalExpansion alpha = thermal_expansion(*rod.spec);
  const double longer = std::abs(f * alpha.axial * heat.rise),
               turn = std::abs(f * alpha.bending) * heat.gradient.norm();
  const bool held = rod.base_held && rod.tip_held;
  return std::max({longer, turn * L, held ? longer * rod.section.K_se.z() * L * L / EI : 0});
}

/// Dunkerley: 1/omega² is the sum of those of the rod alone and of each disk on a rod without mass.
double lowered_by_disks(double omega, const RodSpec& spec, double EI, double L) {
  double sum = 1 / (omega * omega);
  for (const DiskSpec& disk : spec.disks)
    sum += disk.mass * std::pow(disk.s * L, 3) / (3 * EI);
  return 1 / std::sqrt(sum);
}

/// Moments of inertia across the tangent, of sections and disks, over mass times L²: where sections
/// do not vary and nothing is carried I / (A L²).
double rotary_number(const RodSpec& spec, const SectionProperties& s, double mass, double L) {
  if (mass <= 0) return 0;
  double inertia = std::max(s.rhoJ.x(), s.rhoJ.y()) * L;
  for (const DiskSpec& disk : spec.disks)
    inertia += disk.mass * disk.radius * disk.radius / 4;
  return inertia / (mass * L * L);
}

/// Of what moves when a loose rod rolls on friction, the part that turns: 1/3 of a round solid one.
double rolling_number(const Robot& robot, const RobotRod& rod, double mass, double L) {
  const Scene& scene = *robot.scene;
  const bool rolls =
      !rod.base_held && !rod.tip_held && scene.effects.has(Effect::kFriction) &&
      (scene.effects.has(Effect::kContact) || scene.effects.has(Effect::kSelfContact)) &&
      scene.simulation.mode == Mode::kDynamic;
  if (!rolls || mass <= 0) return 0;
  const double inertia = rod.section.rhoJ.z() * L, r = rod.section.half_width;
  return inertia / (inertia + mass * r * r);
}

RodFacts rod_facts(const Robot& robot, const RobotRod& rod, const StepPlan& plan) {
  const Scene& scene = *robot.scene;
  RodFacts f;
  const SectionProperties& s = rod.section;
  const double L = rod.length, EI = std::min(s.K_bt.x(), s.K_bt.y());
  f.name = rod.spec->name;
  f.length = L;
  f.mass = s.rhoA * L;
  if (rod.spec->sections.size() > 1) {
    constexpr int kPieces = 1000;
    const SectionsAlong along(*rod.spec, false);
    f.mass = 0;
    for (int k = 0; k < kPieces; ++k)
      f.mass += along.at((k + 0.5) / kPieces, (k + 0.5) / kPieces).rhoA * L / kPieces;
  }
  for (const DiskSpec& disk : rod.spec->disks)
    f.mass += disk.mass;
  f.bending_x = s.K_bt.x();
  f.bending_y = s.K_bt.y();
  f.torsion = s.K_bt.z();
  f.axial = s.K_se.z();
  f.shear_x = s.K_se.x();
  double omega = s.rhoA > 0 ? std::pow(kFirstRoot / L, 2) * std::sqrt(EI / s.rhoA) : 0;
  if (omega > 0 && !rod.spec->disks.empty()) omega = lowered_by_disks(omega, *rod.spec, EI, L);
  f.first_frequency = omega / (2 * std::numbers::pi);
  f.buckling_load = std::pow(std::numbers::pi / (2 * L), 2) * EI;
  const bool dynamic = scene.simulation.mode == Mode::kDynamic;
  const double c0 = dynamic ? 1.5 / plan.step : 0;
  f.growth_exponent = growth_exponent(s, s.K_bt, Vec3::Zero(), L, s.rhoA * c0 * c0, 0);
  const RodResolution resolution = rod.model->resolution();
  f.method = resolution.method;
  f.method_reason = rod.choice.why;
  f.section_law = rod.model->section_law(dynamic);
  f.rule = resolution.rule;
  f.elements = resolution.elements;
  f.order = resolution.order;
  if (f.method == Method::kShooting)
    f.segments = std::clamp(static_cast<int>(std::ceil(f.growth_exponent / 6)), 1, f.elements);
  f.unknowns = rod.model->unknown_count();
  f.gravity_number = s.rhoA * 9.81 * std::pow(L, 3) / EI;
  for (const DiskSpec& disk : rod.spec->disks)
    f.gravity_number += disk.mass * 9.81 * L * L / EI;
  f.shear_number = s.K_se.x() > 0 ? EI / (s.K_se.x() * L * L) : 0;
  f.extension_number = s.K_se.z() > 0 ? EI / (s.K_se.z() * L * L) : 0;
  f.rotary_number = rotary_number(*rod.spec, s, f.mass, L);
  f.rolling_number = rolling_number(robot, rod, f.mass, L);
  f.damping_ratio = omega * std::max(s.B_bt.x(), s.B_bt.y()) / (2 * EI);
  if (rod.spec->drag) f.drag_number = drag_number(*rod.spec, s, scene, L);
  if (!rod.spec->magnets.empty())
    f.magnetic_number = magnetic_number(rod, robot.pose_of(rod.base).p, scene, EI);
  if (rod.spec->temperature && rod.spec->material)
    f.thermal_number = thermal_number(rod, scene, EI);
  return f;
}

}  // namespace

ProblemFacts problem_facts(const Robot& robot, const Equations& equations, const StepPlan& plan) {
  ProblemFacts facts;
  const Scene& scene = *robot.scene;
  facts.scheme = scene.simulation.mode == Mode::kDynamic ? to_string(plan.scheme.kind) : "statics";
  facts.planar = robot.plane.has_value();
  facts.step = plan.adaptive ? 0 : plan.step;
  facts.body_unknowns = equations.body_unknowns();
  facts.constraint_unknowns = equations.constraint_count();
  for (const RobotRod& rod : robot.rods)
    facts.rods.push_back(rod_facts(robot, rod, plan));
  return facts;
}

}  // namespace cprsim
