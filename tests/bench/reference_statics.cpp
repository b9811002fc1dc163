// SPDX-License-Identifier: BSD-3-Clause
// One rod at rest. Numbers in SI units or in those of the source; shear factor 1 unless said.
#include <cmath>
#include <numbers>

#include "engine/math/so3.h"
#include "tests/bench/reference_cases.h"
#include "tests/support/elastica.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kPi = std::numbers::pi;

Scene with(const RodSpec& rod, std::initializer_list<Effect> effects = {}) {
  Scene scene;
  scene.rods.push_back(rod);
  switch_on(scene, effects);
  return scene;
}

/// The equilibrium that one is led to from the scene's own, in steps that `set` makes.
CaseAnswer led_to(Scene scene, Method m, double length, int steps,
                  const std::function<void(StaticStudy&, int)>& set,
                  const std::function<double(const Snapshot&)>& measure) {
  cut(scene, m, length);
  scene.solver.residual_tolerance = 1e-11;
  StaticStudy study(scene);
  CaseAnswer answer;
  answer.unknowns = unknowns_of(study.robot());
  answer.found = study.solve().converged();
  for (int i = 1; answer.found && i <= steps; ++i) {
    set(study, i);
    answer.found = study.follow().converged();
  }
  answer.error = measure(study.snapshot());
  return answer;
}

/// Of the scene's first load.
void set_force(StaticStudy& study, int axis, double value) {
  study.set({Parameter::Kind::kForce, 0, axis, "", "N"}, value);
}

ReferenceCase rolled_up() {
  return {"S01", "cantilever rolled up twice by a moment", "tip / L", kClosedForm, [](Method m) {
            Scene scene = with(rod_of(1, 1, 1, 1));
            add_load(scene, 1, Vec3::Zero(), {0, 4 * kPi, 0});
            return loaded_in_steps(scene, m, 1, 4,
                                   [](const Snapshot& s) { return tip_of(s).norm(); });
          }};
}

ReferenceCase elastica() {
  return {"S02", "elastica, P L²/EI = 10", "tip / L", kClosedForm, [](Method m) {
            Scene scene = with(rod_of(1, 1, 1, 1));
            add_load(scene, 1, {10, 0, 0});
            const Elastica exact = solve_elastica(10);
            return at_rest(scene, m, 1, [&](const Snapshot& s) {
              return (tip_of(s) - Vec3(exact.x, 0, exact.z)).norm();
            });
          }};
}

// With the tip at the angle a and k = sin(a/2): P L²/EI = K², x = 2 E / K - 1, y = 2 k / K.
ReferenceCase buckled_column() {
  return {
      "S04", "column buckled until its tip stands at 120°", "tip / L", kClosedForm, [](Method m) {
        const double k = std::sin(kPi / 3), c = std::cos(kPi / 3);
        const double K = elliptic_F(1, 0, c * c), E = elliptic_E(1, 0, c * c);
        Scene scene = with(rod_of(1, 1, 1, 1));
        add_load(scene, 1, {2, 0, -K * K});
        return led_to(
            scene, m, 1, 4, [](StaticStudy& study, int i) { set_force(study, 0, 0.5 * (4 - i)); },
            [&](const Snapshot& s) {
              return (tip_of(s) - Vec3(2 * k / K, 0, 2 * E / K - 1)).norm();
            });
      }};
}

ReferenceCase thick_cantilever() {
  return {"S05", "thick cantilever with shear and extension (Nachbagauer)", "tip / L", kShootingRk8,
          [](Method m) {
            const double E = 207e9, nu = 0.3, A = 0.05, EI = E * 0.1 * std::pow(0.5, 3) / 12;
            const double factor = 10 * (1 + nu) / (12 + 11 * nu);
            Scene scene = with(rod_of(2, EI, EI, EI, E * A, factor * E / (2 + 2 * nu) * A),
                               {Effect::kShear, Effect::kExtension});
            add_load(scene, 1, {62.5e6, 0, 0});
            return at_rest(scene, m, 2, [](const Snapshot& s) {
              return (tip_of(s) - Vec3(0.710568597854, 0, 2 - 0.150971144239)).norm() / 2;
            });
          }};
}

ReferenceCase bend_of_45_degrees() {
  return {"S06", "bend of 45° loaded out of its plane (Bathe & Bolourchi), 600", "tip / R",
          kShootingRk8, [](Method m) {
            Scene scene = with(rod_of(25 * kPi, 1e7 / 12, 1e7 / 12, 5e6 / 6, 1e7, 5e6),
                               {Effect::kShear, Effect::kExtension});
            scene.rods[0].rest_curvature = {-0.01, 0, 0};
            scene.rods[0].base.at.X_BF = frame(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ());
            add_load(scene, 1, {0, 0, 600});
            return at_rest(scene, m, 100, [](const Snapshot& s) {
              return (tip_of(s) - Vec3(47.1504385736, -15.684800534, 53.4748587918)).norm() / 100;
            });
          }};
}

ReferenceCase princeton_beam() {
  return {"S07", "Princeton beam, 8.896 N at 45°", "tip / L", kShootingRk8, [](Method m) {
            const double E = 71.7e9, G = E / 2.62, A = 0.0123777 * 0.0032024, L = 0.508;
            // y is the stiff axis' direction, z the soft one's; section x = world y
            Scene scene =
                with(rod_of(L, 2.4288718041122013, 36.285519395400414, 2.925744068, E * A, G * A),
                     {Effect::kShear, Effect::kExtension});
            scene.rods[0].base.at.X_BF = frame(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY());
            const double F = 8.896 * std::sqrt(0.5);
            add_load(scene, 1, {0, -F, F});
            return at_rest(scene, m, L, [&](const Snapshot& s) {
              const Vec3 moved(-0.0144118248335, -0.0089791967227, 0.109113115255);
              return (tip_of(s) - Vec3(L, 0, 0) - moved).norm() / L;
            });
          }};
}

// Helices of curvature k, torsion t and twist w (Love, Mathematical Theory of Elasticity, art. 270)
// bear, in their axes b and t, n = c (b + t/k t), m = EI k b + GJ w t with c = k (GJ w - EI t); led
// to from the straight rod by its own kind.
ReferenceCase love_helix() {
  return {"S09", "Kirchhoff rod bent to a helix by a wrench (Love)", "tip / L", kClosedForm,
          [](Method m) {
            constexpr double kGJ = 0.7, L = 4;
            Scene scene;
            scene.rods.push_back(rod_of(L, 1, 1, kGJ));
            add_load(scene, 1, Vec3::Zero());
            constexpr int kSteps = 20;
            Vec3 tip;
            const auto wind = [&](StaticStudy& study, int i) {
              const double part = static_cast<double>(i) / kSteps;
              const double k = part, t = 2 * part, w = 2.5 * part, turn = std::hypot(k, t) * L;
              const Vec3 axis = Vec3(0, k, t).normalized(), along = axis.z() * axis;
              const Vec3 n = k * (kGJ * w - t) * Vec3(0, 1, t / k), moment(0, k, kGJ * w);
              const Vec3 across = Vec3::UnitZ() - along;
              tip =
                  L * along +
                  L / turn * (std::sin(turn) * across + (1 - std::cos(turn)) * axis.cross(across));
              const Vec3 torque = moment - tip.cross(n);
              for (int j = 0; j < 3; ++j) {
                set_force(study, j, n[j]);
                study.set({Parameter::Kind::kTorque, 0, j, "", "N m"}, torque[j]);
              }
            };
            return led_to(scene, m, L, kSteps, wind,
                          [&](const Snapshot& s) { return (tip_of(s) - tip).norm() / L; });
          }};
}

ReferenceCase heavy_elastica() {
  return {"S10", "heavy elastica, w L³/EI = 10", "tip / L", kShootingRk8, [](Method m) {
            RodSpec rod = rod_of(1, 1, 1, 1);
            give_mass(rod, 1, 1e-4);
            Scene scene = with(rod, {Effect::kGravity});
            scene.gravity = {10, 0, 0};
            return at_rest(scene, m, 1, [](const Snapshot& s) {
              return (tip_of(s) - Vec3(0.700199715514, 0, 0.656353761239)).norm();
            });
          }};
}

// Without bending stiffness in the reference, with 1e-5 w L³ here. The rod starts along its chord,
// a fifth too long, and finds its way down or does not.
ReferenceCase catenary() {
  return {"S11",
          "elastic catenary, EI = 1e-5 w L³",
          "sag / L, EI's share included",
          kClosedForm,
          [](Method m) {
            RodSpec rod = rod_of(1.2, 0.864e-5, 0.864e-5, 0.864e-5, 500);
            give_mass(rod, 0.5, 1e-5);
            const Mat3 R = exp_so3({0, 0.5 * kPi, 0});  // z along x, y across
            rod.base.joint = rod.tip.joint = EndJoint::kRevolute;
            rod.base.axis = rod.tip.axis = Vec3::UnitY();
            rod.base.at.X_BF = {R, Vec3::Zero()};
            rod.tip.at.X_BF = {R, Vec3::UnitX()};
            Scene scene = with(rod, {Effect::kGravity, Effect::kExtension});
            scene.gravity = {0, 0, -1};
            return at_rest(scene, m, 1, [](const Snapshot& s) {
              return std::abs(point_at(s.rods[0], 0.5).position.z() + 0.292912402998);
            });
          },
          kNoLimit};
}

ReferenceCase till_rod() {
  return {"S14", "rod of the Cosserat tutorial with a given base wrench", "tip / L", kShootingRk8,
          [](Method m) {
            Scene scene =
                with(steel_rod(0.5, 1e-3), {Effect::kGravity, Effect::kShear, Effect::kExtension});
            scene.gravity = {9.81, 0, 0};
            add_load(scene, 1, {-0.123276095727, 1, 0},
                     {0.469889666291, 0.0277383761065, 0.00761417419751});
            return at_rest(scene, m, 0.5, [](const Snapshot& s) {
              return (tip_of(s) - Vec3(0.0039118628267, -0.125783998183, 0.469889666291)).norm() /
                     0.5;
            });
          }};
}

ReferenceCase till_rod_clamped() {
  return {"S14", "the same between two clamps: its stable shape", "middle / L", kShootingRk8,
          [](Method m) {
            RodSpec rod = steel_rod(0.5, 1e-3);
            rod.tip.joint = EndJoint::kFixed;
            rod.tip.at.X_BF.p = {0, -0.05, 0.4};
            Scene scene = with(rod, {Effect::kGravity, Effect::kShear, Effect::kExtension});
            scene.gravity = {9.81, 0, 0};
            // pushed to the side of the lowest energy, and left there
            add_load(scene, 0.5, {5, 0, 0});
            return led_to(
                scene, m, 0.5, 5, [](StaticStudy& study, int i) { set_force(study, 0, 5 - i); },
                [](const Snapshot& s) {
                  const Vec3 middle = point_at(s.rods[0], 0.5).position;
                  return (middle - Vec3(0.129366265803, -0.025, 0.2)).norm() / 0.5;
                });
          }};
}

ReferenceCase tapered() {
  return {"S16", "tapered cantilever, 6 N", "tip / L", kShootingRk8, [](Method m) {
            RodSpec rod = steel_rod(0.5, 2e-3);
            rod.material->youngs_modulus = 70e9;
            rod.material->shear_modulus = 70e9 / 2.6;
            rod.sections = {rod.section, rod.section};
            rod.sections[1].s = 1;
            rod.sections[1].size = {1e-3, 0};
            Scene scene = with(rod, {Effect::kShear, Effect::kExtension});
            add_load(scene, 1, {6, 0, 0});
            return at_rest(scene, m, 0.5, [](const Snapshot& s) {
              return (tip_of(s) - Vec3(0.288973653971, 0, 0.364208427976)).norm() / 0.5;
            });
          }};
}

ReferenceCase follower() {
  return {"S17", "follower force of 130 kN (Simo & Vu-Quoc)", "tip / L", kShootingRk8,
          [](Method m) {
            Scene scene = with(rod_of(100, 3.5e7, 3.5e7, 3.5e7, 4.2e8, 1.61538e8),
                               {Effect::kShear, Effect::kExtension});
            add_load(scene, 1, {130e3, 0, 0}).follower = true;
            scene.solver.accuracy = 1e-9;  // it winds up
            if (m == Method::kStrain) scene.solver.elements = 4;
            return loaded_in_steps(scene, m, 100, 26, [](const Snapshot& s) {
              return (tip_of(s) - Vec3(-47.8277169898, 0, 24.0717623985)).norm() / 100;
            });
          }};
}

ReferenceCase thick_with_shear() {
  return {"S18", "thick beam that shears (Timoshenko beam of PyElastica)", "tip / L", kShootingRk8,
          [](Method m) {
            const double A = kPi / 16, EI = 1e6 * kPi / 4 * std::pow(0.25, 4);
            Scene scene =
                with(rod_of(3, EI, EI, EI, 1e6 * A, 1e4 * A), {Effect::kShear, Effect::kExtension});
            add_load(scene, 1, {-15, 0, 0});
            return at_rest(scene, m, 3, [](const Snapshot& s) {
              return (tip_of(s) - Vec3(-0.0669000322222, 0, 2.99928036664)).norm() / 3;
            });
          }};
}

ReferenceCase pretwisted() {
  return {"S20", "beam twisted by 90° at rest", "tip / L", kShootingRk8, [](Method m) {
            Scene scene =
                with(rod_of(10, 5.20833e8, 1.30208333e8, 1.41872656e8, 2.5e10, 8.2604167e9),
                     {Effect::kShear, Effect::kExtension});
            scene.rods[0].rest_curvature = {0, 0, kPi / 20};
            scene.rods[0].base.at.X_BF = frame(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY());
            add_load(scene, 1, {0, 0, -4e6});
            return at_rest(scene, m, 10, [](const Snapshot& s) {
              const Vec3 moved(-1.14152599954, -1.71805334646, -3.59321324027);
              return (tip_of(s) - Vec3(10, 0, 0) - moved).norm() / 10;
            });
          }};
}

ReferenceCase strip_with_mass() {
  return {"I01", "strip with 30 g at its tip: what EI is fitted to", "tip / L", kShootingRk8,
          [](Method m) {
            RodSpec rod = rod_of(0.4, 0.8 / 30, 0.8 / 30, 1);
            give_mass(rod, 0.758313 / 9.81, 1e-9);
            Scene scene = with(rod, {Effect::kGravity});
            scene.gravity = {-9.81, 0, 0};
            add_load(scene, 1, {-0.03 * 9.81, 0, 0});
            return at_rest(scene, m, 0.4, [](const Snapshot& s) {
              return (tip_of(s) - Vec3(-0.224014903999, 0, 0.316132053062)).norm() / 0.4;
            });
          }};
}

}  // namespace

std::vector<ReferenceCase> static_cases() {
  return {rolled_up(),          elastica(),         buckled_column(),   thick_cantilever(),
          bend_of_45_degrees(), princeton_beam(),   love_helix(),       heavy_elastica(),
          catenary(),           till_rod(),         till_rod_clamped(), tapered(),
          follower(),           thick_with_shear(), pretwisted(),       strip_with_mass()};
}

}  // namespace cprsim
