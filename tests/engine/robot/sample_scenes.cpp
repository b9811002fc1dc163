// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/robot/sample_scenes.h"

#include "engine/math/so3.h"

namespace cprsim {

Pose Numbers::pose(double angle, double shift) {
  const Vec3 turn = vec3();
  const Vec3 p = vec3();
  return {exp_so3(angle * turn), shift * p};
}

Profile constant_profile(double value) {
  Profile profile;
  ProfileTerm term;
  term.value = value;
  profile.terms.push_back(term);
  return profile;
}

RodSpec sample_rod(const std::string& name) {
  RodSpec rod;
  rod.name = name;
  rod.length = 1;
  rod.section.shape = SectionShape::kRectangle;
  rod.section.size = {0.04, 0.03};
  rod.material = MaterialSpec{250, 1e8, 4e7, {}};  // rhoA = 0.3 kg/m
  rod.stiffness.bending_x = 1.0;
  rod.stiffness.bending_y = 1.4;
  rod.stiffness.torsion = 0.8;
  rod.stiffness.axial = 60;
  rod.stiffness.shear_x = 35;
  rod.stiffness.shear_y = 45;
  rod.damping = DampingSpec{0.003, 0.002, 0.2, 0.1, {}};
  rod.drag = DragSpec{0.3, 0.1, 80, 1.5, {}};
  return rod;
}

RodEndSpec rod_end(EndJoint joint, int body, const Pose& X_BF) {
  RodEndSpec end;
  end.joint = joint;
  end.at = {body, X_BF};
  end.axis = Vec3(0.48, 0.6, 0.64);
  return end;
}

BodySpec sample_body(const std::string& name, const Pose& X_WB, double mass) {
  BodySpec body;
  body.name = name;
  body.X_WB = X_WB;
  body.mass = mass;
  body.com = {0.03, -0.02, 0.05};
  const Mat3 R = exp_so3({0.3, -0.5, 0.2});
  body.inertia = mass * 1e-2 * (R * Vec3(1, 2, 2.5).asDiagonal() * R.transpose());
  return body;
}

Scene grounded_rod(const RodEndSpec& base, const RodEndSpec& tip) {
  Scene scene;
  scene.rods.push_back(sample_rod("rod"));
  scene.rods[0].base = base;
  scene.rods[0].tip = tip;
  scene.solver.points = 5;
  return scene;
}

Scene chain_of_rods(EndJoint base, EndJoint tip) {
  Scene scene;
  scene.effects.set(Effect::kGravity, true);
  scene.bodies.push_back(sample_body("a", {exp_so3({0.2, 0.1, -0.3}), {0.1, 0.0, 0.8}}, 0.02));
  scene.bodies.push_back(sample_body("b", {exp_so3({-0.1, 0.3, 0.2}), {0.2, 0.1, 1.7}}, 0.03));
  const Pose low{exp_so3({0.1, -0.2, 0.3}), {0.05, -0.04, -0.06}},
      high{exp_so3({-0.2, 0.1, 0.2}), {-0.03, 0.06, 0.08}},
      top{exp_so3({0.2, 0.3, -0.1}), {0.15, -0.1, 2.6}};
  for (int i = 0; i < 3; ++i) {
    scene.rods.push_back(sample_rod("rod" + std::to_string(i)));
    RodSpec& rod = scene.rods.back();
    rod.base =
        i == 0 ? rod_end(EndJoint::kFixed, kWorld, Pose{}) : rod_end(EndJoint::kFixed, i - 1, high);
    rod.tip = i < 2 ? rod_end(EndJoint::kFixed, i, low) : rod_end(EndJoint::kFixed, kWorld, top);
  }
  scene.rods[1].base.joint = base;
  scene.rods[1].tip.joint = tip;
  scene.solver.points = 5;
  return scene;
}

void tie_chain(Scene& scene) {
  TieSpec one, two;
  one.rod = 0;
  one.other = two.other = 1;
  two.rod = 2;
  one.s = {0.4, 1};
  one.other_s = {0.3, 0.7};
  one.offset = Vec3(0.2, -0.1, 0.3);
  two.s = two.other_s = {0.7};
  scene.ties = {one, two};
  scene.effects.set(Effect::kExtension, true);
}

Scene jointed_arms(JointKind first, JointKind second) {
  Scene scene;
  scene.effects.set(Effect::kGravity, true);
  const Pose A{exp_so3({0.2, 0.1, -0.3}), {0.1, 0.0, 0.1}},
      B{exp_so3({-0.1, 0.3, 0.2}), {0.5, 0.1, 0.2}};
  scene.bodies.push_back(sample_body("upper_arm", A, 0.02));
  scene.bodies.push_back(sample_body("forearm", B, 0.03));
  const Pose at_A{exp_so3({0.3, 0.2, 0.1}), {0.02, 0.05, 0.03}},
      at_B{exp_so3({-0.3, 0.2, 0.4}), {-0.05, 0.03, 0.02}};
  JointSpec joint;
  joint.axis = Vec3(0.6, 0.48, 0.64);
  joint.spring_stiffness = 3;
  joint.spring_reference = 0.2;
  joint.damping = 0.01;
  joint.second.axis = Vec3(0.8, -0.36, -0.48);
  joint.second.spring_stiffness = 2;
  joint.third.spring_stiffness = 1.5;
  joint.screw_pitch = 0.4;
  joint.name = "shoulder";
  joint.kind = first;
  joint.child = 0;
  joint.X_PJ = A * at_A;
  joint.X_CJ = at_A;
  scene.joints.push_back(joint);
  joint.name = "elbow";
  joint.kind = second;
  joint.parent = 0;
  joint.child = 1;
  joint.X_PJ = A.inverse() * B * at_B;
  joint.X_CJ = at_B;
  scene.joints.push_back(joint);
  const Pose top{exp_so3({0.2, 0.3, -0.1}), {0.45, -0.1, 1.1}};
  for (int i = 0; i < 2; ++i) {
    scene.rods.push_back(sample_rod("rod" + std::to_string(i)));
    scene.rods.back().base = rod_end(EndJoint::kFixed, i, Pose{});
    scene.rods.back().tip = rod_end(EndJoint::kFixed, kWorld, top);
  }
  scene.rods[0].tip.joint = EndJoint::kBall;
  scene.solver.points = 4;
  return scene;
}

StageRates start_step(Robot& robot, Equations& equations, SchemeKind scheme, double h,
                      Numbers& numbers) {
  equations.set_instant(0, true, StageRates{});
  equations.evaluate();
  for (RigidBody& body : robot.bodies)
    body.start_tracks(0.3 * numbers.vec3(), 0.3 * numbers.vec3());
  for (Joint& joint : robot.joints)
    joint.start_tracks(robot.body_pose(joint.parent), robot.body_pose(joint.child),
                       0.2 * numbers.vec6());
  for (RobotRod& rod : robot.rods)
    rod.model->start_tracks();
  Stepper stepper({scheme, -0.4, 0.8});
  // past the starter, which every scheme but the first uses
  stepper.begin_step(h, robot.tracks());
  stepper.accept(robot.tracks());
  stepper.begin_step(h, robot.tracks());
  return stepper.begin_stage(0, robot.tracks());
}

void disturb(Robot& robot, Equations& equations, Numbers& numbers, double size) {
  RobotUnknowns u = equations.unknowns();
  Vec6 bend;
  bend << 8, 5, -3, 0, 0, 0;
  for (RodModel::Unknowns& rod : u.rods) {
    // bent besides: a straight rod that cannot stretch has no Newton direction
    for (Eigen::Index i = 0; i < rod.values.size(); ++i)
      rod.values[i] += size * (numbers.next() + bend[i % 6]);
    for (NodeState& start : rod.starts) {
      const Mat3 R = exp_so3(size * numbers.vec3()) * Mat3(rotation_of(start));
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(start.R) = R;
      for (double* part : {start.p, start.n, start.m})
        Eigen::Map<Vec3>(part) += size * numbers.vec3();
    }
  }
  for (RodModel::Unknowns& rod : u.rods)
    for (RodContact& tie : rod.contacts) {
      if (tie.grip != Grip::kTie || tie.role != ContactRole::kShared) continue;
      tie.force += 20 * size * numbers.vec3();
      u.rods[static_cast<std::size_t>(tie.other_rod)]
          .contacts[static_cast<std::size_t>(tie.partner)]
          .force = -tie.force;
    }
  for (Pose& body : u.bodies) {
    body.R = exp_so3(size * numbers.vec3()) * body.R;
    body.p += size * numbers.vec3();
  }
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    u.joint_q[j] += size * numbers.vec3();
    u.joint_lambda[j] += 3 * size * numbers.vec6();
  }
  equations.set_unknowns(u);
}

void cut_for_contact(Scene& scene, Method method) {
  scene.effects.set(Effect::kContact, true);
  scene.solver.method = method;
  scene.solver.elements = 6;
  scene.solver.order = 3;
  scene.solver.degree = 4;
}

}  // namespace cprsim
