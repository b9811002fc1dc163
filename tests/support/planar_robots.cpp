// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/planar_robots.h"

#include <cmath>
#include <numbers>
#include <string>

namespace cprsim {

Plane coordinate_plane() {
  return plane_axes(Vec3::UnitY());
}

Plane oblique_plane() {
  return plane_axes(Vec3(0.48, 0.64, 0.6)) *
         Eigen::AngleAxisd(0.3, Vec3::UnitZ()).toRotationMatrix();
}

Pose frame_in(const Plane& plane, double x, double y, double angle) {
  Mat3 R;
  R.col(0) = plane.col(2);
  R.col(2) = plane * Vec3(std::cos(angle), std::sin(angle), 0);
  R.col(1) = R.col(2).cross(R.col(0));
  return {R, plane * Vec3(x, y, 0)};
}

Scene in_plane(Scene scene, const Plane& plane) {
  scene.planar_normal = plane.col(2);
  return scene;
}

BodySpec block(const std::string& name, const Pose& X_WB, double mass, double size) {
  BodySpec body;
  body.name = name;
  body.X_WB = X_WB;
  body.mass = mass;
  body.inertia = mass * size * size * Mat3::Identity();
  return body;
}

JointSpec joint_to_world(const Scene& scene, const std::string& name, JointKind kind, int child,
                         const Vec3& axis) {
  JointSpec joint;
  joint.name = name;
  joint.kind = kind;
  joint.child = child;
  joint.X_PJ = scene.bodies[static_cast<std::size_t>(child)].X_WB;
  joint.axis = joint.X_PJ.R.transpose() * axis;
  return joint;
}

RodEndSpec end_at(EndJoint joint, int body, const Pose& X_BF, const Vec3& axis) {
  RodEndSpec end;
  end.joint = joint;
  end.at = {body, X_BF};
  end.axis = axis;
  return end;
}

Profile ramp(double from, double to, double end) {
  Profile profile;
  ProfileTerm term;
  term.shape = ShapeOfTime::kSmoothstep;
  term.from = from;
  term.to = to;
  term.end = end;
  profile.terms.push_back(term);
  return profile;
}

Scene planar_cantilever(const Plane& plane) {
  Scene scene;
  switch_on(scene, {Effect::kGravity});
  RodSpec rod = steel_rod(0.4, 1e-3);
  rod.base.at = {kWorld, frame_in(plane, 0.1, -0.2, 0.4)};
  scene.rods.push_back(rod);
  scene.gravity = plane * Vec3(3, -9, 0);
  add_load(scene, 1, plane * Vec3(-1, 2, 0));
  return scene;
}

Scene slider_crank(const Plane& plane, double turn) {
  Scene scene;
  switch_on(scene, {Effect::kGravity});
  scene.gravity = plane * Vec3(0, -9.81, 0);
  const Vec3 normal = plane.col(2);
  scene.bodies.push_back(block("crank", frame_in(plane, 0, 0, 0.3), 0.2, 0.03));
  scene.bodies.push_back(block("slider", frame_in(plane, 0.45, 0, 0), 0.1, 0.02));
  scene.joints.push_back(joint_to_world(scene, "motor", JointKind::kRevolute, 0, normal));
  scene.joints.push_back(joint_to_world(scene, "rail", JointKind::kPrismatic, 1, plane.col(0)));
  scene.joints[1].damping = 0.5;
  scene.joints[1].spring_stiffness = 20;
  RodSpec rod = steel_rod(0.4, 1e-3);
  Pose at_crank;
  at_crank.p = {0, 0, 0.05};
  rod.base = end_at(EndJoint::kFixed, 0, at_crank, Vec3::UnitX());
  rod.tip = end_at(EndJoint::kRevolute, 1, Pose{}, Vec3::UnitX());
  scene.rods.push_back(rod);
  DriveSpec drive;
  drive.joint = 0;
  drive.profile = ramp(0, turn, 0.5);
  scene.drives.push_back(drive);
  return scene;
}

Scene rfrfr(const Plane& plane, double turn) {
  constexpr double kDegree = std::numbers::pi / 180;
  Scene scene;
  scene.gravity = plane * Vec3(0, -9.81, 0);
  const Vec3 normal = plane.col(2);
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? -1 : 1, angle = (i == 0 ? 120 : 60) * kDegree;
    scene.bodies.push_back(block(i == 0 ? "left crank" : "right crank",
                                 frame_in(plane, 0.2 * side, 0, angle), 0.1, 0.02));
    scene.joints.push_back(
        joint_to_world(scene, "motor" + std::to_string(i), JointKind::kRevolute, i, normal));
    DriveSpec drive;
    drive.joint = i;
    drive.profile = ramp(0, side * turn, 0.5);
    scene.drives.push_back(drive);
  }
  scene.bodies.push_back(block("hand", frame_in(plane, 0, 0.93, 75 * kDegree), 0.02, 0.01));
  for (int i = 0; i < 2; ++i) {
    RodSpec rod = steel_rod(1, 1e-3);
    rod.name = i == 0 ? "left" : "right";
    rod.base = end_at(EndJoint::kFixed, i, Pose{}, Vec3::UnitX());
    rod.tip = end_at(i == 0 ? EndJoint::kFixed : EndJoint::kRevolute, 2, Pose{}, Vec3::UnitX());
    scene.rods.push_back(rod);
  }
  return scene;
}

Scene planar_release(const Plane& plane) {
  Scene scene;
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear, Effect::kRotaryInertia,
                    Effect::kDamping});
  RodSpec rod = steel_rod(0.4, 2e-3);
  damp(rod, 1e-3);
  rod.base.at = {kWorld, frame_in(plane, 0, 0, 1.2)};
  scene.rods.push_back(rod);
  scene.gravity = plane * Vec3(0, -9.81, 0);
  add_load(scene, 1, plane * Vec3(4, -2, 0), Vec3::Zero(), true);
  add_load(scene, 0.6, Vec3(0, 2, 1)).follower = true;
  return scene;
}

void set_dynamic(Scene& scene, double duration, double step, SchemeKind scheme) {
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = duration;
  scene.solver.step = step;
  scene.solver.scheme = scheme;
  scene.solver.residual_tolerance = 1e-12;
}

}  // namespace cprsim
