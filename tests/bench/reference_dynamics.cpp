// SPDX-License-Identifier: BSD-3-Clause
// Rods in motion. Numbers in SI units or in those of the source.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/math/so3.h"
#include "tests/bench/reference_cases.h"
#include "tests/support/jointed_bodies.h"

namespace cprsim {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTolerance = 1e-8;

ProfileTerm formula(const std::string& text) {
  auto parsed = Expression::parse(text);
  if (!std::holds_alternative<Expression>(parsed)) throw std::logic_error("no formula: " + text);
  ProfileTerm term;
  term.shape = ShapeOfTime::kExpression;
  term.expression = std::get<Expression>(parsed);
  return term;
}

/// A circle of this radius with shear factor 1.
RodSpec round_rod(double length, double radius, double E, double nu, double rho) {
  RodSpec rod = steel_rod(length, radius);
  rod.material->density = rho;
  rod.material->youngs_modulus = E;
  rod.material->shear_modulus = E / (2 + 2 * nu);
  return rod;
}

Scene all_strains(const RodSpec& rod) {
  Scene scene;
  switch_on(scene, {Effect::kExtension, Effect::kShear, Effect::kRotaryInertia});
  scene.rods.push_back(rod);
  return scene;
}

/// 0.1 s in which a force that holds the rod goes, smoothly.
Scene soft_cantilever() {
  Scene scene = all_strains(round_rod(0.4, 4e-3, 2e8, 0.4, 1200));
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {-9.81, 0, 0};
  LoadSpec& load = add_load(scene, 1, {-0.1, 0, 0});
  load.has_profile = true;
  load.profile.terms = {
      formula("1 - min(10*t,1)^4 * (35 - 84*min(10*t,1) + 70*min(10*t,1)^2 - 20*min(10*t,1)^3)")};
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.1;
  return scene;
}

ReferenceCase smooth_release() {
  return {"D06", "soft cantilever let go smoothly, 0.1 s", "tip / L", kSpectral, [](Method m) {
            return in_motion(soft_cantilever(), m, 0.4, kTolerance, [](const Snapshot& s) {
              return (tip_of(s) - Vec3(-0.07454747637, 0, 0.3919103682)).norm() / 0.4;
            });
          }};
}

ReferenceCase damped_release() {
  return {"D07, I04", "the same with damping of bending and torsion, 1 ms", "tip / L", kSpectral,
          [](Method m) {
            Scene scene = soft_cantilever();
            switch_on(scene, {Effect::kDamping});
            const double EI = bending_stiffness(scene.rods[0]), GJ = EI / 1.4;
            scene.rods[0].damping = DampingSpec{1e-3 * EI, 1e-3 * GJ, 0, 0, {}};
            return in_motion(scene, m, 0.4, kTolerance, [](const Snapshot& s) {
              return (tip_of(s) - Vec3(-0.07461443916, 0, 0.391902311)).norm() / 0.4;
            });
          }};
}

// the reference's two meshes differ by 2e-5 L
ReferenceCase sudden_release() {
  return {"D08",
          "steel rod whose weight falls off, 0.1 s",
          "tip / L; reference: 2e-5",
          kSpectral,
          [](Method m) {
            Scene scene = all_strains(round_rod(0.4, 1.2e-3, 207e9, 0.3, 8000));
            switch_on(scene, {Effect::kGravity});
            scene.gravity = {-9.81, 0, 0};
            add_load(scene, 1, {-0.2 * 9.81, 0, 0}, Vec3::Zero(), true);
            scene.simulation.initial_static = true;
            scene.simulation.duration = 0.1;
            return in_motion(scene, m, 0.4, 1e-6, [](const Snapshot& s) {
              return (tip_of(s) - Vec3(-0.1018636106, 0, 0.3848382682)).norm() / 0.4;
            });
          },
          1e-4};
}

// the reference's two meshes differ by 2e-6 L
ReferenceCase rubber_pendulum() {
  return {"D09",
          "rubber rod that falls about a hinge, 0.5 s (Lang, Linn & Arnold)",
          "tip / L; reference: 3e-6",
          kSpectral,
          [](Method m) {
            RodSpec rod = round_rod(1, 5e-3, 5e6, 0.5, 1100);
            rod.base.joint = EndJoint::kRevolute;
            rod.base.axis = Vec3::UnitY();
            rod.base.at.X_BF.R = exp_so3({0, 0.5 * kPi, 0});
            Scene scene = all_strains(rod);
            switch_on(scene, {Effect::kGravity});
            scene.gravity = {0, 0, -9.81};
            scene.simulation.duration = 0.5;
            if (m == Method::kStrain) scene.solver.elements = 2;
            scene.solver.accuracy = 1e-11;
            return in_motion(scene, m, 1, kTolerance, [](const Snapshot& s) {
              return (tip_of(s) - Vec3(-0.2331180238, 0, -0.9194423017)).norm();
            });
          },
          1e-4,
          true};
}

ReferenceCase right_angle() {
  return {"D10", "right-angle cantilever kicked out of its plane, 2 s (Simo & Vu-Quoc)",
          "height of corner and tip / L", kSpectral, [](Method m) {
            RodSpec leg = rod_of(10, 1000, 1000, 1000, 1e6, 1e6);
            give_mass(leg, 1, 10);
            leg.base.at.X_BF = frame(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY());
            leg.tip.joint = EndJoint::kFixed;
            leg.tip.at = {0, {leg.base.at.X_BF.R, Vec3::Zero()}};
            Scene scene = all_strains(leg);
            // of no weight beside legs of 10
            scene.bodies.push_back(
                lump("corner", Pose{Mat3::Identity(), {10, 0, 0}}, 1e-6, {1e-6, 1e-6, 1e-6}));
            leg.name = "arm";
            leg.tip = {};
            leg.base.at = {0, frame(Vec3::Zero(), Vec3::UnitY(), Vec3::UnitZ())};
            scene.rods.push_back(leg);
            LoadSpec load;
            load.at.body = 0;
            load.force = {0, 0, 1};
            load.has_profile = true;
            ProfileTerm triangle;
            triangle.shape = ShapeOfTime::kKeyframes;
            triangle.times = {0, 1, 2};
            triangle.values = {0, 50, 0};
            load.profile.terms = {triangle};
            scene.loads.push_back(load);
            scene.solver.accuracy = 1e-10;
            scene.solver.residual_tolerance = 1e-9;  // the corner is light
            scene.simulation.duration = 2;
            return in_motion(scene, m, 10, kTolerance, [](const Snapshot& s) {
              return std::hypot(tip_of(s, 0).z() - 4.115245209, tip_of(s, 1).z() - 0.06926355884) /
                     10;
            });
          }};
}

// the reference's two meshes differ by 1e-5 L
ReferenceCase flying_spaghetti() {
  return {"D11",
          "flying spaghetti, 2.5 s (Simo & Vu-Quoc)",
          "both ends / L; reference: 1e-5",
          kSpectral,
          [](Method m) {
            RodSpec rod = rod_of(10, 100, 100, 100, 1e4, 1e4);
            give_mass(rod, 1, 10);
            rod.base.joint = EndJoint::kFree;
            rod.base.at.X_BF = frame({0, 8, 0}, {0.6, -0.8, 0}, Vec3::UnitZ());
            Scene scene = all_strains(rod);
            add_load(scene, 1, {8, 0, 0}, {0, 0, -80});
            scene.planar_normal = Vec3::UnitZ();
            scene.solver.accuracy = 1e-13;
            if (m == Method::kStrain) scene.solver.elements = 2;
            scene.solver.step = 2e-2;
            scene.simulation.duration = 2.5;
            return in_motion(scene, m, 10, kTolerance, [](const Snapshot& s) {
              const Vec3 low(4.963121145, 4.475999097, 0), up(3.583172457, 6.111872697, 0);
              return std::hypot((tip_of(s) - low).norm(),
                                (s.rods[0].points.front().position - up).norm()) /
                     10;
            });
          },
          1e-4};
}

ReferenceCase spin_up() {
  return {
      "D13", "arm that is spun up, 6 s (Simo & Vu-Quoc)", "tip in the turning frame / L", kSpectral,
      [](Method m) {
        RodSpec rod = rod_of(10, 14000, 14000, 14000, 2.8e7, 1e7);
        give_mass(rod, 1.2, 6e-4);
        Scene scene = all_strains(rod);
        scene.bodies.push_back(lump("hub", Pose{}, 1, {1, 1, 1}));
        scene.joints.push_back(joint_at(scene, JointKind::kContinuous, Vec3::Zero(), kWorld, 0));
        scene.rods[0].base.at = {0, frame(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY())};
        drive(scene, 0, DriveQuantity::kPosition, 0).profile.terms = {
            formula("0.4 * (t^2/2 + (15/(2*pi))^2 * (cos(2*pi*t/15) - 1))")};
        scene.simulation.duration = 6;
        return in_motion(scene, m, 10, kTolerance, [](const Snapshot& s) {
          const double psi = 0.4 * (18 + std::pow(7.5 / kPi, 2) * (std::cos(0.8 * kPi) - 1));
          const Vec3 tip = exp_so3({0, 0, -psi}) * tip_of(s);
          return (tip - Vec3(10 - 0.0169712495, -0.5435964003, 0)).norm() / 10;
        });
      }};
}

/// sin(pi (t - start) / length)^4 from start on, once.
std::vector<ProfileTerm> pulse(double start, double length) {
  std::vector<ProfileTerm> terms(3);
  const double amplitudes[] = {0.375, -0.5, 0.125};
  for (int k = 0; k < 3; ++k) {
    ProfileTerm& term = terms[static_cast<std::size_t>(k)];
    term.shape = ShapeOfTime::kSine;
    term.amplitude = amplitudes[k];
    term.frequency = k / length;
    term.phase = 0.5 * kPi;
    term.start = start;
    term.end = start + length;
  }
  return terms;
}

ReferenceCase hanging_body() {
  return {"D15",
          "body that hangs on a soft rod, pushed and turned, 0.5 s",
          "its centre / L",
          kSpectral,
          [](Method m) {
            RodSpec rod = round_rod(0.3, 3e-3, 5e7, 0.4, 1200);
            rod.base.at.X_BF = frame(Vec3::Zero(), -Vec3::UnitZ(), Vec3::UnitX());
            rod.tip.joint = EndJoint::kFixed;
            rod.tip.at = {0, {rod.base.at.X_BF.R, Vec3::Zero()}};
            Scene scene = all_strains(rod);
            switch_on(scene, {Effect::kGravity});
            scene.gravity = {0, 0, -9.81};
            scene.bodies.push_back(
                lump("bob", Pose{Mat3::Identity(), {0, 0, -0.3}}, 0.05, {2e-5, 2.5e-5, 1e-5}));
            scene.bodies[0].com = {0.01, 0, -0.03};
            const auto push = [&](const Vec3& force, const Vec3& torque, double start) {
              LoadSpec load;
              load.at = {0, {Mat3::Identity(), scene.bodies[0].com}};
              load.force = force;
              load.torque = torque;
              load.follower = !torque.isZero();
              load.has_profile = true;
              load.profile.terms = pulse(start, 0.2);
              scene.loads.push_back(load);
            };
            push({0.4, 0, 0}, Vec3::Zero(), 0);
            push({0, 0.3, 0}, Vec3::Zero(), 0.1);
            push(Vec3::Zero(), {0, 0, 2e-3}, 0.05);
            scene.simulation.duration = 0.5;
            scene.solver.accuracy = 1e-10;
            return in_motion(scene, m, 0.3, kTolerance, [&](const Snapshot& s) {
              const Vec3 centre = s.bodies[0].X_WB * Vec3(0.01, 0, -0.03);
              return (centre - Vec3(0.04312591427, 0.06487308051, -0.3206171753)).norm() / 0.3;
            });
          },
          2e-6,
          true};
}

ReferenceCase slider_crank() {
  return {
      "D16", "slider-crank with an elastic rod, 0.2 s", "slider / L", kSpectral, [](Method m) {
        RodSpec rod = round_rod(0.4, 1e-3, 200e9, 0.3, 7850);
        const Pose along = frame(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ());
        rod.base.joint = rod.tip.joint = EndJoint::kRevolute;  // about x, the world's z
        rod.base.at = {0, {along.R, Vec3(0.1, 0, 0)}};
        rod.tip.at = {1, along};
        Scene scene = all_strains(rod);
        switch_on(scene, {Effect::kGravity});
        scene.gravity = {0, -9.81, 0};
        scene.bodies.push_back(lump("crank", Pose{}, 1, {1, 1, 1}));
        scene.bodies.push_back(
            lump("slider", Pose{Mat3::Identity(), {0.5, 0, 0}}, 0.05, {1e-4, 1e-4, 1e-4}));
        scene.joints.push_back(joint_at(scene, JointKind::kContinuous, Vec3::Zero(), kWorld, 0));
        scene.joints.push_back(
            joint_at(scene, JointKind::kPrismatic, {0.5, 0, 0}, kWorld, 1, Vec3::UnitX()));
        drive(scene, 0, DriveQuantity::kPosition, 0).profile.terms = {
            formula("6 * (2.5*(5*t)^4 - 3*(5*t)^5 + (5*t)^6)")};
        scene.simulation.duration = 0.2;
        return in_motion(scene, m, 0.4, kTolerance, [](const Snapshot& s) {
          return std::abs(s.bodies[1].X_WB.p.x() - 0.3007490992) / 0.4;
        });
      }};
}

// A quarter of the period 4 K(sin 45°) sqrt(2 L / 3 g) after its release from level.
ReferenceCase stiff_pendulum() {
  return {"D20", "rod too stiff to bend, as a pendulum", "tip / L after a quarter period",
          kClosedForm, [](Method m) {
            RodSpec rod = rod_of(1, 1e6, 1e6, 1e6);
            give_mass(rod, 1, 1e-7);
            rod.base.joint = EndJoint::kRevolute;
            rod.base.axis = Vec3::UnitY();
            rod.base.at.X_BF.R = exp_so3({0, 0.5 * kPi, 0});
            Scene scene;
            switch_on(scene, {Effect::kGravity});
            scene.gravity = {0, 0, -9.81};
            scene.rods.push_back(rod);
            scene.simulation.duration = 0.483333713593;
            return in_motion(scene, m, 1, kTolerance,
                             [](const Snapshot& s) { return (tip_of(s) + Vec3::UnitZ()).norm(); });
          }};
}

// The stop is what a slide that the tip carries meets: no side thrust, no friction.
ReferenceCase one_sided_stop() {
  return {
      "C13",
      "soft cantilever let go against a stop that gives, 0.3 s",
      "tip / L",
      kSpectral,
      [](Method m) {
        Scene scene = soft_cantilever();
        scene.rods[0].tip.joint = EndJoint::kBall;
        scene.rods[0].tip.at.body = 1;
        const Pose tip{Mat3::Identity(), {-0.095, 0, 0.3865}};
        scene.bodies.push_back(lump("across", tip, 1e-7, {1e-9, 1e-9, 1e-9}));
        scene.bodies.push_back(lump("up", tip, 1e-7, {1e-9, 1e-9, 1e-9}));
        JointSpec across = joint_at(scene, JointKind::kPrismatic, tip.p, kWorld, 0, Vec3::UnitX());
        across.upper = -0.03 - tip.p.x();
        across.stop_stiffness = 200;
        across.stop_dissipation = 0;
        scene.joints.push_back(across);
        scene.joints.push_back(joint_at(scene, JointKind::kPrismatic, tip.p, 0, 1, Vec3::UnitZ()));
        scene.simulation.duration = 0.3;
        scene.solver.residual_tolerance = 1e-9;  // the slides are light
        return in_motion(scene, m, 0.4, 1e-6, [](const Snapshot& s) {
          return (tip_of(s) - Vec3(-0.08852507094, 0, 0.3884328616)).norm() / 0.4;
        });
      },
      2e-4};
}

}  // namespace

std::vector<ReferenceCase> dynamic_cases() {
  return {smooth_release(), damped_release(),   sudden_release(), rubber_pendulum(),
          right_angle(),    flying_spaghetti(), spin_up(),        hanging_body(),
          slider_crank(),   stiff_pendulum(),   one_sided_stop()};
}

}  // namespace cprsim
