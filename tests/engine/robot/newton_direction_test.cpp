// SPDX-License-Identifier: BSD-3-Clause
// Newton directions of robots of every kind, against differences.
#include "tests/engine/robot/newton_direction.h"

#include "engine/math/so3.h"

namespace cprsim::newton_direction {
namespace {

constexpr EndJoint kHeld[] = {EndJoint::kFixed, EndJoint::kRevolute, EndJoint::kUniversal,
                              EndJoint::kBall};
constexpr ArcIntegrator kIntegrators[] = {ArcIntegrator::kEuler, ArcIntegrator::kRk4,
                                          ArcIntegrator::kGauss2, ArcIntegrator::kGauss4,
                                          ArcIntegrator::kGauss6};
const Pose kTop{Eigen::AngleAxisd(0.4, Vec3(0.6, 0.8, 0)).toRotationMatrix(), {0.1, 0.05, 0.85}};

std::string label(int a, int b, bool spin) {
  return "base " + std::to_string(a) + ", tip " + std::to_string(b) + (spin ? ", spin free" : "");
}

TEST(NewtonDirection, IsExactForEveryJointAtTheBase) {
  for (bool spin : {false, true})
    for (EndJoint joint : kHeld) {
      RodEndSpec base = rod_end(joint, kWorld, Pose{});
      base.spin_free = spin;
      const Scene scene = grounded_rod(base, rod_end(EndJoint::kFixed, kWorld, kTop));
      expect_exact(scene, {}, label(static_cast<int>(joint), 1, spin));
    }
  // a free base: what holds the rod is the tip
  expect_exact(grounded_rod(rod_end(EndJoint::kFree, kWorld, Pose{}),
                            rod_end(EndJoint::kFixed, kWorld, kTop)),
               {}, "free base");
}

TEST(NewtonDirection, IsExactForARodBentAtRest) {
  Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kRevolute);
  set_all_effects(scene);
  scene.rods[0].rest_curvature = {0.8, -1.2, 0.6};
  scene.rods[1].rest_curvature = {-0.5, 0, 1.1};
  expect_exact(scene, {}, "statics");
  Setting dynamics;
  dynamics.mode = Rates::kGeneralizedAlpha;
  expect_exact(scene, dynamics, "dynamics");
}

TEST(NewtonDirection, IsExactForEveryJointAtTheTip) {
  for (bool spin : {false, true})
    for (EndJoint joint : kHeld) {
      RodEndSpec tip = rod_end(joint, kWorld, kTop);
      tip.spin_free = spin;
      const Scene scene = grounded_rod(rod_end(EndJoint::kFixed, kWorld, Pose{}), tip);
      expect_exact(scene, {}, label(1, static_cast<int>(joint), spin));
    }
  expect_exact(grounded_rod(rod_end(EndJoint::kFixed, kWorld, Pose{}), RodEndSpec{}), {},
               "free tip");
}

TEST(NewtonDirection, IsExactForRodsBetweenMovingBodies) {
  for (EndJoint base : kHeld)
    for (EndJoint tip : {EndJoint::kFixed, EndJoint::kUniversal}) {
      const std::string what = label(static_cast<int>(base), static_cast<int>(tip), false);
      Scene scene = chain_of_rods(base, tip);
      expect_exact(scene, {}, what + ", statics");
      set_all_effects(scene);
      expect_exact(scene, {}, what + ", statics, extensible");
      expect_exact(scene, {Rates::kBackwardEuler}, what + ", dynamics");
      expect_exact(scene, {Rates::kGeneralizedAlpha}, what + ", dynamics without body rates");
    }
}

TEST(NewtonDirection, IsExactForEveryEffectAlone) {
  for (Effect e : {Effect::kGravity, Effect::kExtension, Effect::kShear, Effect::kRotaryInertia,
                   Effect::kDamping}) {
    Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kRevolute);
    scene.effects.set(Effect::kGravity, false);
    scene.effects.set(e, true);
    expect_exact(scene, {}, std::string("statics, ") + effect_name(e));
    expect_exact(scene, {Rates::kBackwardEuler}, std::string("dynamics, ") + effect_name(e));
  }
}

TEST(NewtonDirection, IsExactForSectionsAndRestShapesThatVary) {
  Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kRevolute);
  for (RodSpec& rod : scene.rods) {
    rod.stiffness = {};
    rod.material = MaterialSpec{250, 2e7, 8e6, {}};
    SectionSpec tip = rod.section;
    rod.section.s = 0;
    tip.s = 1;
    tip.size *= 0.7;
    rod.sections = {rod.section, tip};
    rod.rest_samples = {{0, {0.8, -1.2, 0.6}}, {0.3, {0.2, 0.4, 1}}, {1, {-0.5, 0, 1.1}}};
  }
  expect_exact(scene, {}, "statics");
  expect_exact(scene, {Rates::kBackwardEuler}, "dynamics");
  set_all_effects(scene);
  scene.effects.set(Effect::kDrag, true);
  expect_exact(scene, {Rates::kGeneralizedAlpha}, "dynamics, everything");
}

TEST(NewtonDirection, IsExactInAMagneticField) {
  for (bool stretches : {false, true}) {
    Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kRevolute);
    if (stretches) set_all_effects(scene);
    scene.effects.set(Effect::kMagnetic, true);
    scene.magnetic_fields.resize(2);
    scene.magnetic_fields[0].uniform = {0.4, 0.7, -0.5};
    scene.magnetic_fields[1].dipole = true;
    scene.magnetic_fields[1].position = {0.9, -0.6, 0.8};
    scene.magnetic_fields[1].moment = {3e6, -2e6, 5e6};
    scene.rods[0].magnets = {{0, 1, {0.3, -0.5, 0.8}}};
    scene.rods[1].magnets = {{0.3, 1, {-0.4, 0.2, 0.6}}, {0, 0.6, {0.1, 0.5, 0.2}}};
    const std::string what = stretches ? "extensible" : "inextensible";
    expect_exact(scene, {}, what + ", statics");
    expect_exact(scene, {Rates::kBackwardEuler}, what + ", dynamics");
    scene.effects.set(Effect::kDrag, true);
    expect_exact(scene, {Rates::kGeneralizedAlpha}, what + ", dynamics in a fluid");
  }
}

TEST(NewtonDirection, IsExactOnAFoundation) {
  for (bool stretches : {false, true}) {
    Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kRevolute);
    if (stretches) set_all_effects(scene);
    LoadSpec springs;
    springs.rod = 1;
    springs.to = 1;
    springs.law = 0;
    springs.law_values = {40, 0.1, -0.2, 0.3, 0.36, 0.48, -0.8};
    scene.loads.push_back(springs);
    expect_exact(scene, {}, "statics");
    expect_exact(scene, {Rates::kBackwardEuler}, "dynamics");
    scene.effects.set(Effect::kDrag, true);
    expect_exact(scene, {Rates::kGeneralizedAlpha}, "dynamics in a fluid");
  }
}

TEST(NewtonDirection, IsExactForAHeatedRod) {
  Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kRevolute);
  set_all_effects(scene);
  scene.effects.set(Effect::kThermal, true);
  for (RodSpec& rod : scene.rods) {
    rod.material->thermal_expansion = 1e-3;
    rod.temperature.emplace();
    rod.temperature->rise = 80;
    rod.temperature->gradient = {900, -600};
  }
  expect_exact(scene, {}, "statics");
  expect_exact(scene, {Rates::kBackwardEuler}, "dynamics");
}

TEST(NewtonDirection, IsExactInAFluid) {
  for (bool stretches : {false, true}) {
    Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kRevolute);
    if (stretches) set_all_effects(scene);
    scene.effects.set(Effect::kDrag, true);
    scene.wind = {0.8, -0.4, 0.5};
    const std::string what = stretches ? "extensible" : "inextensible";
    expect_exact(scene, {}, what + ", statics");
    expect_exact(scene, {Rates::kBackwardEuler}, what + ", dynamics");
    expect_exact(scene, {Rates::kGeneralizedAlpha}, what + ", dynamics without body rates");
  }
}

/// Turn from a segment's start to what arrives there from before, rod 0.
Vec3 turn_at(const RobotUnknowns& u, std::size_t segment, std::size_t node) {
  return log_so3(Mat3(rotation_of(u.rods[0].nodes[node])) *
                 rotation_of(u.rods[0].starts[segment]).transpose());
}

// The sum that expect_exact() looks at does not see how columns are turned about the gap of a join:
// here each segment begins half a radian off, and every gap must fall as itself.
TEST(NewtonDirection, JoinsSegmentsThatAreTurned) {
  Scene scene = grounded_rod(rod_end(EndJoint::kFixed, kWorld, Pose{}), RodEndSpec{});
  scene.solver.method = Method::kShooting;
  Numbers numbers(1);
  Robot robot = build_robot(scene);
  Equations equations(robot, 1e-9);
  equations.set_instant(0, true, StageRates{});
  const StageRates rates =
      start_step(robot, equations, SchemeKind::kGeneralizedAlpha, 1. / 4000, numbers);
  equations.set_instant(0, true, rates);
  equations.evaluate();
  equations.set_instant(0, true, rates);  // now that there are states, segments are cut
  RobotUnknowns u = equations.unknowns();
  std::vector<NodeState>& starts = u.rods[0].starts;
  ASSERT_GT(starts.size(), 2u);
  std::vector<std::size_t> node_of(starts.size());
  for (std::size_t g = 1; g < starts.size(); ++g) {
    // to round-off: at rest, where segments were cut, another kernel had found the nodes
    while (!position_of(u.rods[0].nodes[node_of[g]]).isApprox(position_of(starts[g]), 1e-14))
      ASSERT_LT(++node_of[g], u.rods[0].nodes.size());
    const Mat3 R = exp_so3(0.5 * numbers.vec3().normalized()) * Mat3(rotation_of(starts[g]));
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(starts[g].R) = R;
  }
  equations.set_unknowns(u);
  equations.evaluate();
  ASSERT_TRUE(equations.find_direction(0));
  equations.keep();
  const auto at = [&](double alpha) {
    equations.move(alpha);
    equations.evaluate();
    return equations.unknowns();
  };
  const RobotUnknowns now = at(0);
  for (std::size_t g = 1; g < starts.size(); ++g) {
    const Vec3 gap = turn_at(now, g, node_of[g]);
    EXPECT_GT(gap.norm(), 0.3);
    double error = 1;
    for (double a = 1e-2; a > 1e-10; a *= 0.1) {
      const Vec3 slope = (turn_at(at(a), g, node_of[g]) - turn_at(at(-a), g, node_of[g])) / (2 * a);
      error = std::min(error, (slope + gap).norm());
    }
    EXPECT_LT(error, kTolerance) << "segment " << g + 1;
  }
}

TEST(NewtonDirection, IsExactForEveryIntegrator) {
  for (ArcIntegrator integrator : kIntegrators) {
    const std::string what = "integrator " + std::to_string(static_cast<int>(integrator));
    Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kBall);
    scene.solver.integrator = integrator;
    scene.solver.points = 8;
    expect_exact(scene, {}, what + ", inextensible");
    expect_exact(scene, {Rates::kBackwardEuler}, what + ", inextensible, dynamics");
    set_all_effects(scene);
    expect_exact(scene, {}, what + ", extensible");
    expect_exact(scene, {Rates::kBackwardEuler}, what + ", extensible, dynamics");
  }
}

TEST(NewtonDirection, IsExactAcrossManySegments) {
  Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kRevolute);
  scene.solver.points = 12;
  const auto segments = [&](double h) {
    Robot robot = build_robot(scene);
    Equations equations(robot, 1e-9);
    Numbers numbers(1);
    const StageRates rates = start_step(robot, equations, SchemeKind::kBackwardEuler, h, numbers);
    equations.set_instant(0, true, rates);
    return robot.rods[1].model->segments();
  };
  ASSERT_GE(segments(1. / 300), 2);
  ASSERT_GE(segments(1. / 4000), 4);
  for (double h : {1. / 300, 1. / 4000}) {
    expect_exact(scene, {Rates::kBackwardEuler, h}, "h = " + std::to_string(h));
    expect_exact(scene, {Rates::kGeneralizedAlpha, h}, "h = " + std::to_string(h));
  }
  set_all_effects(scene);
  expect_exact(scene, {Rates::kBackwardEuler, 1. / 4000}, "extensible");
}

TEST(NewtonDirection, IsExactUnderDeadAndFollowerLoads) {
  for (bool follower : {false, true}) {
    for (double s : {0., 0.5, 1.}) {
      Scene scene = chain_of_rods(EndJoint::kRevolute, EndJoint::kUniversal);
      LoadSpec load = sample_load(follower);
      load.rod = 1;
      load.rod_s = s;
      scene.loads.push_back(load);
      const std::string what = "s = " + std::to_string(s) + (follower ? ", follower" : ", dead");
      expect_exact(scene, {}, what);
      expect_exact(scene, {Rates::kBackwardEuler, 1. / 2000}, what + ", dynamics");
    }
    Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kFixed);
    LoadSpec load = sample_load(follower);
    load.at = {1, {kTop.R, {0.1, 0.2, -0.1}}};
    scene.loads.push_back(load);
    expect_exact(scene, {}, follower ? "follower on a body" : "dead load on a body");
  }
}

TEST(NewtonDirection, IsExactUnderLoadsAlongRods) {
  Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kRevolute);
  for (bool follower : {false, true}) {
    scene.loads.push_back(sample_load(follower));
    scene.loads.back().rod = 1;
    scene.loads.back().rod_s = follower ? 0.2 : 0;
    scene.loads.back().to = follower ? 1 : 0.6;
  }
  expect_exact(scene, {}, "inextensible, statics");
  set_all_effects(scene);
  expect_exact(scene, {Rates::kBackwardEuler}, "extensible, dynamics");
}

DriveSpec joint_drive(int joint, DriveQuantity quantity, int freedom = 0) {
  DriveSpec drive;
  drive.joint = joint;
  drive.freedom = freedom;
  drive.quantity = quantity;
  drive.profile = constant_profile(0.3);
  return drive;
}

TEST(NewtonDirection, IsExactForFreeJointsWithSpringsAndDampers) {
  for (JointKind first : {JointKind::kRevolute, JointKind::kPrismatic, JointKind::kBall,
                          JointKind::kUniversal, JointKind::kPlanar})
    for (JointKind second : {JointKind::kContinuous, JointKind::kPrismatic, JointKind::kBall,
                             JointKind::kScrew, JointKind::kCylindrical}) {
      const Scene scene = jointed_arms(first, second);
      const std::string what = "joints " + std::to_string(static_cast<int>(first)) + " and " +
                               std::to_string(static_cast<int>(second));
      expect_exact(scene, {}, what);
      expect_exact(scene, {Rates::kBackwardEuler}, what + ", dynamics");
      expect_exact(scene, {Rates::kGeneralizedAlpha}, what + ", dynamics without body rates");
    }
}

TEST(NewtonDirection, IsExactForDrivenJoints) {
  for (JointKind kind : {JointKind::kRevolute, JointKind::kPrismatic})
    for (DriveQuantity quantity :
         {DriveQuantity::kPosition, DriveQuantity::kEffort, DriveQuantity::kVelocity}) {
      Scene scene = jointed_arms(kind, JointKind::kRevolute);
      scene.drives.push_back(joint_drive(0, quantity));
      const std::string what = "joint " + std::to_string(static_cast<int>(kind)) + ", drive " +
                               std::to_string(static_cast<int>(quantity));
      expect_exact(scene, {}, what);
      expect_exact(scene, {Rates::kBackwardEuler}, what + ", dynamics");
    }
}

TEST(NewtonDirection, IsExactForOneDrivenAxisOfSeveral) {
  for (JointKind kind : {JointKind::kUniversal, JointKind::kCylindrical, JointKind::kPlanar})
    for (int freedom = 0; freedom < freedom_count(kind); ++freedom)
      for (DriveQuantity quantity :
           {DriveQuantity::kPosition, DriveQuantity::kEffort, DriveQuantity::kVelocity}) {
        Scene scene = jointed_arms(kind, JointKind::kRevolute);
        scene.drives.push_back(joint_drive(0, quantity, freedom));
        const std::string what = "joint " + std::to_string(static_cast<int>(kind)) + ", axis " +
                                 std::to_string(freedom) + ", drive " +
                                 std::to_string(static_cast<int>(quantity));
        expect_exact(scene, {}, what);
        expect_exact(scene, {Rates::kBackwardEuler}, what + ", dynamics");
      }
}

TEST(NewtonDirection, IsExactForStopsAndFriction) {
  for (JointKind kind : {JointKind::kRevolute, JointKind::kScrew, JointKind::kPlanar}) {
    Scene scene = jointed_arms(kind, JointKind::kPrismatic);
    for (JointSpec& joint : scene.joints) {
      joint.upper = -0.3;  // q is about 0: well inside the stop
      joint.stop_stiffness = 4;
      joint.friction = 0.1;
    }
    expect_exact(scene, {}, "stops, statics");
    expect_exact(scene, {Rates::kBackwardEuler}, "stops, dynamics");
  }
}

TEST(NewtonDirection, IsExactOnEveryRungOfTheLadder) {
  for (EndJoint base : {EndJoint::kFixed, EndJoint::kRevolute}) {
    Scene scene = chain_of_rods(base, EndJoint::kUniversal);
    Setting setting;
    setting.fraction = 0.4;
    expect_exact(scene, setting, "part of the loads, gaps held open");
    setting.relaxation = 2;
    expect_exact(scene, setting, "drag");
    setting = {};
    setting.softness = 2e-2;
    expect_exact(scene, setting, "soft rods");
    setting = {};
    setting.bodies_held = true;
    expect_exact(scene, setting, "bodies held");
  }
  Setting setting;
  setting.fraction = 0.4;
  expect_exact(jointed_arms(JointKind::kRevolute, JointKind::kPrismatic), setting, "joint gaps");
}

}  // namespace
}  // namespace cprsim::newton_direction
