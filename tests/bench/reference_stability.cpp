// SPDX-License-Identifier: BSD-3-Clause
// Critical loads, found on paths of equilibria, and frequencies: the second variation of what each
// method found.
#include <cmath>
#include <numbers>

#include "engine/study/modes.h"
#include "engine/study/path.h"
#include "tests/bench/reference_cases.h"
#include "tests/support/column_and_frame.h"

namespace cprsim {
namespace {

constexpr double kPi = std::numbers::pi;

Parameter force_of(int component) {
  return {Parameter::Kind::kForce, 0, component, "force", "N"};
}

/// The parameter's values at the first folds, or other events, on the way to `to`, against
/// `expected`.
CaseAnswer events_on_path(Scene scene, Method method, double length, const Parameter* parameter,
                          double to, bool folds, const std::vector<double>& expected) {
  cut(scene, method, length);
  StaticStudy study(scene);
  CaseAnswer answer;
  answer.unknowns = unknowns_of(study.robot());
  if (!study.solve().converged()) return answer;
  PathOptions options;
  options.largest_step = 0.4;
  const Parameter changed = parameter ? *parameter : study.drives()[0];
  const Path path = follow_path(
      study, along_line(study, {changed}, VecX::Constant(1, 0), VecX::Constant(1, to)), options);
  std::size_t n = 0;
  for (const PathEvent& event : path.events)
    if ((event.kind == PathEventKind::kFold) == folds && n < expected.size())
      answer.error = std::max(answer.error, std::abs(to * event.point.lambda / expected[n++] - 1));
  answer.found = n == expected.size();
  return answer;
}

// P (1 - P/EA + P/GA) = EI (pi / 2L)²
ReferenceCase shearing_column() {
  return {"B01", "clamped-free column that shears and shortens", "critical load", kClosedForm,
          [](Method m) {
            Scene scene;
            switch_on(scene, {Effect::kExtension, Effect::kShear});
            scene.rods.push_back(rod_of(1, 10, 40, 20, 1000, 300));
            add_load(scene, 1, Vec3::Zero());
            const double a = 1 / 300. - 1 / 1000., k = 10 * kPi * kPi / 4;
            const double critical = (std::sqrt(1 + 4 * a * k) - 1) / (2 * a);
            const Parameter force = force_of(2);
            return events_on_path(scene, m, 1, &force, -40, false, {-critical});
          }};
}

ReferenceCase twisted_shaft() {
  return {"B03",
          "shaft clamped at both ends, one free to slide, twisted (Greenhill)",
          "critical angle",
          kClosedForm,
          [](Method m) {
            Scene scene = column(1, 1e-2, EndJoint::kFixed, EndJoint::kFixed, 0);
            scene.loads.clear();
            const RodSpec given = rod_of(1, 1, 1, 0.8);
            scene.rods[0].stiffness = given.stiffness;
            turn_base(scene).profile.terms.push_back({});
            return events_on_path(scene, m, 1, nullptr, 15, false, {8.98681891582 / 0.8});
          },
          2e-5};
}

ReferenceCase strip() {
  return {"B04", "strip that a force at its tip turns over", "critical load", kShootingRk8,
          [](Method m) {
            Scene scene;
            scene.rods.push_back(rod_of(1, 1, 100, 1));
            add_load(scene, 1, Vec3::Zero());
            const Parameter force = force_of(0);
            return events_on_path(scene, m, 1, &force, 6, false, {4.05962740575});
          }};
}

ReferenceCase frame_folds() {
  return {"B05",
          "Lee's frame: where it snaps through, and back",
          "load",
          kShootingRk8,
          [](Method m) {
            const Parameter force = force_of(2);
            return events_on_path(lees_frame(), m, 120, &force, -20000, true,
                                  {-18546.5587408, 9396.14236998});
          },
          1e-5,
          true};
}

ReferenceCase right_angle_frame() {
  return {"B10", "right-angle frame that buckles sideways (Argyris)", "critical load", kShootingRk8,
          [](Method m) {
            Scene scene;
            BodySpec corner;
            corner.name = "corner";
            corner.X_WB.p = {0, 0, 240};
            scene.bodies.push_back(corner);
            // 30 wide in the plane x-z: bending about y is strong
            RodSpec leg = rod_of(240, 38469.6, 96174000, 58732.2137405);
            leg.tip.joint = EndJoint::kFixed;
            leg.tip.at.body = 0;
            scene.rods.push_back(leg);
            leg.name = "arm";
            leg.tip = {};
            leg.base.at = {
                0, {Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()).toRotationMatrix(), Vec3::Zero()}};
            scene.rods.push_back(leg);
            add_load(scene, 1, Vec3::Zero()).rod = 1;
            const Parameter force = force_of(2);
            return events_on_path(scene, m, 240, &force, 1.6, false, {1.08751823734});
          }};
}

ReferenceCase localised_buckle() {
  return {"B07",
          "long rod turned 27 times, its ends 3 % nearer: its buckle is local",
          "moment and tension of the clamps",
          "closed form of an infinitely long rod",
          [](Method m) {
            Scene scene = gallery_scene("rods/localised_buckle", m, 12);
            scene.solver.order = 6;
            scene.solver.degree = 6;
            if (m == Method::kCollocation) scene.solver.elements = 60;
            return run_scene(scene, [](const Snapshot& s) {
              const RodPoint& clamp = s.rods[0].points.front();
              return std::max(std::abs(clamp.moment.z() / -1.3253831235 - 1),
                              std::abs(clamp.force.z() / 0.390183586179 - 1));
            });
          },
          1e-4};
}

CaseAnswer frequencies(Scene scene, Method method, double length, int every,
                       const std::vector<double>& expected) {
  cut(scene, method, length);
  StaticStudy study(scene);
  CaseAnswer answer;
  answer.unknowns = unknowns_of(study.robot());
  answer.found = study.solve().converged();
  if (!answer.found) return answer;
  const std::vector<VibrationMode> modes =
      natural_modes(study, every * static_cast<int>(expected.size()));
  for (std::size_t k = 0; k < expected.size(); ++k)
    answer.error = std::max(
        answer.error,
        std::abs(std::sqrt(modes[static_cast<std::size_t>(every) * k].omega_squared) / expected[k] -
                 1));
  return answer;
}

ReferenceCase timoshenko_modes() {
  return {"D01", "cantilever: first five frequencies in bending (Timoshenko)", "frequency",
          kClosedForm, [](Method m) {
            Scene scene;
            switch_on(scene, {Effect::kShear, Effect::kRotaryInertia});
            scene.rods.push_back(steel_rod(0.5, 1e-3));
            scene.solver.accuracy = 1e-12;
            if (m == Method::kStrain) scene.solver.elements = 4;
            return frequencies(
                scene, m, 0.5, 2,
                {35.1598667102, 220.332416528, 616.888704223, 1208.71694611, 1997.79797149});
          }};
}

ReferenceCase tip_mass_modes() {
  return {"D02", "cantilever with its own mass at the tip: three frequencies", "frequency",
          kClosedForm, [](Method m) {
            Scene scene;
            RodSpec rod = rod_of(1, 1, 1, 1);
            give_mass(rod, 1, 1e-4);
            rod.disks = {{1, 1, 0}};
            scene.rods.push_back(rod);
            scene.solver.accuracy = 1e-12;
            if (m == Method::kStrain) scene.solver.elements = 4;
            std::vector<double> expected;
            for (const double root : {1.24791740961, 4.03113943671, 7.13413224094})
              expected.push_back(root * root);
            return frequencies(scene, m, 1, 2, expected);
          }};
}

}  // namespace

std::vector<ReferenceCase> stability_cases() {
  return {shearing_column(),  twisted_shaft(),    strip(),
          frame_folds(),      localised_buckle(), right_angle_frame(),
          timoshenko_modes(), tip_mass_modes()};
}

}  // namespace cprsim
