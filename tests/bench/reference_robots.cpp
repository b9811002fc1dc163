// SPDX-License-Identifier: BSD-3-Clause
// Parallel robots at rest.
#include <cmath>
#include <numbers>

#include "engine/math/so3.h"
#include "engine/study/stability.h"
#include "tests/bench/reference_cases.h"
#include "tests/support/jointed_bodies.h"

namespace cprsim {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double plate_error(const Snapshot& s, const Vec3& p, const Vec3& turn, double length) {
  return ((s.bodies[0].X_WB.p - p).norm() + 0.1 * (log_so3(s.bodies[0].X_WB.R) - turn).norm()) /
         length;
}

ReferenceCase published(bool clamped) {
  return {"P01", clamped ? "the same with legs that cannot spin" : "published Stewart-Gough robot",
          "pose of the plate / L", kShootingRk8, [clamped](Method m) {
            const std::vector<double> free{0.397326387393, 0.397326387393, 0.399720102352,
                                           0.421624011251, 0.421624011251, 0.399720102352},
                held{0.397321457603, 0.397321457603, 0.399720087631,
                     0.421619887529, 0.421619887529, 0.399720087631};
            return at_rest(stewart_gough(clamped ? held : free, clamped), m, 0.4,
                           [](const Snapshot& s) {
                             return plate_error(s, {0, 0, 0.4}, {0, 10 * kDegree, 0}, 0.4);
                           });
          }};
}

ReferenceCase end_of_published_path() {
  return {"P02", "the end of its published path: massless, thinner legs", "pose of the plate / L",
          kShootingRk8, [](Method m) {
            Scene scene = stewart_gough({0.585461668009, 0.61594367829, 0.598361692871,
                                         0.585461668009, 0.61594367829, 0.598361692871},
                                        false);
            for (RodSpec& leg : scene.rods) {
              leg.section.size = {0.65e-3, 0};
              leg.material->youngs_modulus = 207e9;
              leg.material->shear_modulus = 207e9 / 2.61;
            }
            scene.effects.set(Effect::kGravity, false);
            scene.bodies[0].X_WB.p = {0, 0.1, 0.57};
            return at_rest(scene, m, 0.6, [](const Snapshot& s) {
              return plate_error(s, {0, 0.12, 0.58}, Vec3::Zero(), 0.6);
            });
          }};
}

ReferenceCase pushed() {
  return {
      "P03", "clamped legs, plate pushed by 4 N", "pose of the plate / L", kShootingRk8,
      [](Method m) {
        Scene scene = stewart_gough({0.407718055774, 0.407718055774, 0.39532696447, 0.431598378093,
                                     0.431598378093, 0.39532696447},
                                    true, 0.0921);
        for (RodSpec& leg : scene.rods) {
          leg.material->youngs_modulus = 207e9;
          leg.material->shear_modulus = 207e9 / 2.6;
        }
        scene.bodies[0].X_WB = {exp_so3({0, 10 * kDegree, 0}), {-0.05, 0, 0.4}};
        LoadSpec load;
        load.at.body = 0;
        load.force = {4, 0, 0};
        scene.loads.push_back(load);
        return at_rest(scene, m, 0.4, [](const Snapshot& s) {
          return plate_error(s, {-0.0454817370897, 0, 0.40018055553}, {0, 0.184220094812, 0}, 0.4);
        });
      }};
}

/// In the plane x-z; x, the axis of hinges, along -y.
Pose in_plane_frame(double x, double z, double angle) {
  return frame({x, 0, z}, {std::cos(angle), 0, std::sin(angle)}, -Vec3::UnitY());
}

RodSpec planar_leg(double length, double radius) {
  RodSpec rod = steel_rod(length, radius);
  rod.material->youngs_modulus = 2.1e11;
  rod.material->shear_modulus = 2.1e11 / 2.6;
  rod.material->density = 7800;
  return rod;
}

ReferenceCase two_rods() {
  return {"P04", "two rods on motors, joined by a hinge, 2 N", "hinge / L", kShootingRk8,
          [](Method m) {
            Scene scene;
            switch_on(scene, {Effect::kExtension, Effect::kShear});
            scene.bodies.push_back(
                lump("hinge", in_plane_frame(-0.05, 0.65, 80 * kDegree), 0.01, {1e-6, 1e-6, 1e-6}));
            for (int i = 0; i < 2; ++i) {
              RodSpec rod = planar_leg(0.7, 1e-3);
              rod.name = i == 0 ? "left" : "right";
              rod.base.at.X_BF =
                  in_plane_frame(i == 0 ? -0.15 : 0.15, 0, (i == 0 ? 120 : 80) * kDegree);
              rod.tip.joint = i == 0 ? EndJoint::kFixed : EndJoint::kRevolute;
              rod.tip.at.body = 0;
              scene.rods.push_back(rod);
            }
            LoadSpec load;
            load.at.body = 0;
            load.force = {0, 0, -2};
            scene.loads.push_back(load);
            return at_rest(scene, m, 0.7, [](const Snapshot& s) {
              return (s.bodies[0].X_WB.p - Vec3(-0.0522074392882, 0, 0.652478225332)).norm() / 0.7;
            });
          }};
}

ReferenceCase slider_crank() {
  return {"P05", "rod on a motor at 60°, hinged to a slider", "slider / L", kShootingRk8,
          [](Method m) {
            Scene scene;
            switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear});
            scene.gravity = {0, 0, -9.81};
            scene.bodies.push_back(
                lump("slider", in_plane_frame(0.45, 0, -0.5), 0.05, {1e-5, 1e-5, 1e-5}));
            scene.joints.push_back(
                joint_at(scene, JointKind::kPrismatic, {0.45, 0, 0}, kWorld, 0, Vec3::UnitX()));
            RodSpec rod = planar_leg(0.5, 0.8e-3);
            rod.base.at.X_BF = in_plane_frame(0, 0, 60 * kDegree);
            rod.tip.joint = EndJoint::kRevolute;
            rod.tip.at.body = 0;
            scene.rods.push_back(rod);
            return at_rest(scene, m, 0.5, [](const Snapshot& s) {
              return std::abs(s.bodies[0].X_WB.p.x() - 0.44880842354) / 0.5;
            });
          }};
}

ReferenceCase upright_legs() {
  return {"P06", "three upright legs: stiffness against swaying", "stiffness", kShootingRk8,
          [](Method m) {
            Scene scene;
            switch_on(scene, {Effect::kExtension, Effect::kShear});
            scene.bodies.push_back(
                lump("plate", Pose{Mat3::Identity(), {0, 0, 0.5}}, 0.1, {1e-3, 1e-3, 1e-3}));
            for (int i = 0; i < 3; ++i) {
              RodSpec leg = steel_rod(0.5, 1e-3);
              leg.name = "leg_" + std::to_string(i);
              leg.material->youngs_modulus = 207e9;
              leg.material->shear_modulus = 207e9 / 2.6;
              const double angle = 120 * i * kDegree;
              leg.base.at.X_BF.p =
                  leg.tip.at.X_BF.p = {0.1 * std::cos(angle), 0.1 * std::sin(angle), 0};
              leg.tip.joint = EndJoint::kFixed;
              leg.tip.at.body = 0;
              scene.rods.push_back(leg);
            }
            cut(scene, m, 0.5);
            StaticStudy study(scene);
            CaseAnswer answer;
            answer.unknowns = unknowns_of(study.robot());
            answer.found = study.solve().converged();
            const MatX compliance = judge(study).body_stiffness.inverse();
            answer.error = std::abs(1 / compliance(3, 3) / 46.8138082047 - 1);
            return answer;
          }};
}

}  // namespace

std::vector<ReferenceCase> robot_cases() {
  return {published(false), published(true), end_of_published_path(), pushed(),
          two_rods(),       slider_crank(),  upright_legs()};
}

}  // namespace cprsim
