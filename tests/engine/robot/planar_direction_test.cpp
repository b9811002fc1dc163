// SPDX-License-Identifier: BSD-3-Clause
// The whole linearisation in a plane at once, as newton_direction_test.cpp does it in space: along
// the Newton direction at a state where no row vanishes, d merit / d alpha = -2 merit.
#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/engine/robot/direction_error.h"
#include "tests/engine/robot/sample_scenes.h"
#include "tests/support/methods.h"
#include "tests/support/planar_robots.h"

namespace cprsim {
namespace {

/// Every unknown moved by about `size`, bodies within the plane.
void disturb_in_plane(Robot& robot, Equations& equations, Numbers& numbers, double size) {
  const Mat3& plane = *robot.plane;
  RobotUnknowns u = equations.unknowns();
  for (RodModel::Unknowns& rod : u.rods)
    for (Eigen::Index i = 0; i < rod.values.size(); ++i)
      rod.values[i] += size * (numbers.next() + (i % 3 == 0 ? 3 : 0));
  const auto shift = [&] { return Vec3(plane * Vec3(numbers.next(), numbers.next(), 0)); };
  for (Pose& body : u.bodies) {
    body.R = exp_so3(size * numbers.next() * plane.col(2)) * body.R;
    body.p += size * shift();
  }
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    u.joint_q[j][0] += size * numbers.next();
    u.joint_lambda[j] << 3 * size * numbers.next() * plane.col(2), 3 * size * shift();
  }
  equations.set_unknowns(u);
}

struct Setting {
  bool dynamic = false;
  SchemeKind scheme = SchemeKind::kBackwardEuler;
  double h = 1. / 300;
  double fraction = 1, relaxation = 0, softness = 0;
};

StageRates moving(Robot& robot, Equations& equations, const Setting& setting, Numbers& numbers) {
  const Mat3& plane = *robot.plane;
  equations.set_instant(0, true, StageRates{});
  equations.evaluate();
  for (RigidBody& body : robot.bodies)
    body.start_tracks(0.3 * (plane * Vec3(numbers.next(), numbers.next(), 0)),
                      body.R.transpose() * (0.3 * numbers.next() * plane.col(2)));
  for (Joint& joint : robot.joints) {
    const auto n = static_cast<Eigen::Index>(joint.freedoms.size());
    joint.track.set_start(joint.q.head(n), VecX::Constant(n, 0.2));
  }
  for (RobotRod& rod : robot.rods)
    rod.model->start_tracks();
  Stepper stepper({setting.scheme, -0.4, 0.8});
  // past the starter, which every scheme but the first uses
  stepper.begin_step(setting.h, robot.tracks());
  stepper.accept(robot.tracks());
  stepper.begin_step(setting.h, robot.tracks());
  return stepper.begin_stage(0, robot.tracks());
}

/// |slope of merit / (-2 merit) - 1| at a generic state; 1 if there is no direction.
double slope_error(const Scene& scene, const Setting& setting, unsigned seed) {
  Numbers numbers(seed);
  Robot robot = build_robot(scene);
  Equations equations(robot, 1e-9);
  equations.set_instant(0, true, StageRates{});
  equations.mark_start();
  const StageRates rates =
      setting.dynamic ? moving(robot, equations, setting, numbers) : StageRates{};
  equations.set_instant(0, true, rates);
  disturb_in_plane(robot, equations, numbers, 0.05);
  equations.evaluate();
  if (setting.fraction < 1) equations.set_fraction(setting.fraction);
  if (setting.relaxation > 0) equations.set_relaxation(setting.relaxation);
  if (setting.softness > 0) equations.set_softness(setting.softness);
  equations.set_instant(0, true, rates);  // now that there are states, segments are cut
  disturb_in_plane(robot, equations, numbers, 0.05);
  return direction_error(equations);
}

// fourth-order differences reach 1e-9 and better; round-off of stiff inertia is most of that
constexpr double kTolerance = 1e-7;

/// Of rods discretised in every way, or in the scene's.
void expect_exact(Scene scene, const Setting& setting, const std::string& what) {
  std::vector<Method> methods{scene.solver.method};
  if (scene.solver.method == Method::kAuto)
    methods.assign(std::begin(kEveryMethod), std::end(kEveryMethod));
  scene.solver.order = 3;
  for (Method method : methods)
    for (unsigned seed = 1; seed <= 3; ++seed) {
      scene.solver.method = method;
      EXPECT_LT(slope_error(scene, setting, seed), kTolerance)
          << what << ", state " << seed << ", " << method_name(method);
    }
}

/// Ground - rod - body - rod - body - rod - ground, numbers near 1, ends of the middle rod as told.
Scene planar_chain(const Plane& plane, EndJoint base, EndJoint tip) {
  Scene scene;
  switch_on(scene, {Effect::kGravity});
  scene.gravity = plane * Vec3(4, -8, 0);
  for (int i = 0; i < 2; ++i) {
    BodySpec body = block(i == 0 ? "a" : "b", frame_in(plane, 0.1 + 0.1 * i, 0.8 + 0.9 * i, 1.4),
                          0.02 + 0.01 * i, 0.1);
    body.com = {0, 0.03, -0.02};
    scene.bodies.push_back(body);
  }
  // on a body: z along its own z, turned a little about the normal, which is its x
  const auto on_body = [](double y, double z, double angle) {
    return Pose{Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix(), {0, y, z}};
  };
  const auto ground = [&](EndJoint joint, double x, double y, double angle) {
    return end_at(joint, kWorld, frame_in(plane, x, y, angle), Vec3::UnitX());
  };
  for (int i = 0; i < 3; ++i) {
    RodSpec rod = sample_rod("rod" + std::to_string(i));
    rod.base = i == 0 ? ground(EndJoint::kFixed, 0, 0, 1.5)
                      : end_at(i == 1 ? base : EndJoint::kFixed, i - 1, on_body(0.06, 0.08, 0.2),
                               Vec3::UnitX());
    rod.tip = i == 2 ? ground(EndJoint::kFixed, 0.15, 2.6, 1.7)
                     : end_at(i == 1 ? tip : EndJoint::kFixed, i, on_body(-0.04, -0.06, -0.3),
                              Vec3::UnitX());
    scene.rods.push_back(rod);
  }
  scene.solver.points = 5;
  return in_plane(scene, plane);
}

void set_all_effects(Scene& scene) {
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear, Effect::kRotaryInertia,
                    Effect::kDamping});
}

constexpr EndJoint kHeld[] = {EndJoint::kFixed, EndJoint::kRevolute};

TEST(PlanarDirection, IsExactForRodsBetweenMovingBodies) {
  for (const Plane& plane : {coordinate_plane(), oblique_plane()})
    for (EndJoint base : kHeld)
      for (EndJoint tip : {EndJoint::kFixed, EndJoint::kRevolute, EndJoint::kFree}) {
        const std::string what = "base " + std::to_string(static_cast<int>(base)) + ", tip " +
                                 std::to_string(static_cast<int>(tip));
        Scene scene = planar_chain(plane, base, tip);
        expect_exact(scene, {}, what + ", statics");
        expect_exact(scene, {true}, what + ", dynamics");
        set_all_effects(scene);
        expect_exact(scene, {}, what + ", statics, all effects");
        expect_exact(scene, {true}, what + ", dynamics, all effects");
        expect_exact(scene, {true, SchemeKind::kGeneralizedAlpha}, what + ", all, alpha");
      }
}

TEST(PlanarDirection, IsExactForAFreeBase) {
  const Plane plane = coordinate_plane();
  Scene scene = planar_chain(plane, EndJoint::kFixed, EndJoint::kFixed);
  scene.rods[0].base.joint = EndJoint::kFree;
  expect_exact(scene, {}, "free base");
  set_all_effects(scene);
  expect_exact(scene, {true}, "free base, dynamics");
}

TEST(PlanarDirection, IsExactForEveryIntegrator) {
  for (ArcIntegrator integrator :
       {ArcIntegrator::kEuler, ArcIntegrator::kRk4, ArcIntegrator::kGauss2, ArcIntegrator::kGauss4,
        ArcIntegrator::kGauss6}) {
    const std::string what = arc_tableau(integrator).name;
    Scene scene = planar_chain(coordinate_plane(), EndJoint::kRevolute, EndJoint::kFixed);
    scene.solver.integrator = integrator;
    scene.solver.points = 8;
    expect_exact(scene, {}, what);
    set_all_effects(scene);
    expect_exact(scene, {true}, what + ", dynamics");
  }
}

TEST(PlanarDirection, IsExactAcrossManySegments) {
  Scene scene = planar_chain(coordinate_plane(), EndJoint::kFixed, EndJoint::kRevolute);
  scene.solver.points = 12;
  const Setting fine{true, SchemeKind::kBackwardEuler, 1. / 4000};
  Robot robot = build_robot(scene);
  Equations equations(robot, 1e-9);
  Numbers numbers(1);
  equations.set_instant(0, true, moving(robot, equations, fine, numbers));
  ASSERT_GE(robot.rods[1].model->segments(), 4);
  expect_exact(scene, fine, "inextensible");
  set_all_effects(scene);
  expect_exact(scene, fine, "all effects");
}

TEST(PlanarDirection, IsExactWithDisks) {
  Scene scene = planar_chain(oblique_plane(), EndJoint::kFixed, EndJoint::kRevolute);
  scene.rods[1].disks = {{0.3, 0.2, 0.2}, {0.3, 0.1, 0}, {1, 0.1, 0.3}};
  expect_exact(scene, {}, "statics");
  expect_exact(scene, {true}, "dynamics");
  set_all_effects(scene);
  expect_exact(scene, {true, SchemeKind::kGeneralizedAlpha}, "dynamics, all effects");
  expect_exact(scene, {true, SchemeKind::kBackwardEuler, 1. / 4000}, "many segments");
}

TEST(PlanarDirection, IsExactUnderDeadAndFollowerLoads) {
  const Plane plane = oblique_plane();
  for (bool follower : {false, true})
    for (double s : {0., 0.5, 1.}) {
      Scene scene = planar_chain(plane, EndJoint::kRevolute, EndJoint::kFixed);
      LoadSpec load;
      load.rod = 1;
      load.rod_s = s;
      load.follower = follower;
      load.force = follower ? Vec3(0, 0.8, -0.5) : Vec3(plane * Vec3(0.8, -0.5, 0));
      load.torque = follower ? Vec3(0.4, 0, 0) : Vec3(0.4 * plane.col(2));
      scene.loads.push_back(load);
      load.rod = -1;
      load.at = {1, {Mat3::Identity(), {0, 0.1, 0.2}}};
      scene.loads.push_back(load);
      const std::string what = "s = " + std::to_string(s) + (follower ? ", follower" : ", dead");
      expect_exact(scene, {}, what);
      expect_exact(scene, {true, SchemeKind::kBackwardEuler, 1. / 2000}, what + ", dynamics");
    }
}

TEST(PlanarDirection, IsExactForJointsAndDrives) {
  for (const Plane& plane : {coordinate_plane(), oblique_plane()}) {
    Scene scene = slider_crank(plane, 0.4);
    scene.rods[0].length = 1;
    scene.rods[0].stiffness = sample_rod("").stiffness;
    scene.rods[0].material = sample_rod("").material;
    scene.solver.points = 5;
    scene = in_plane(scene, plane);
    for (DriveQuantity quantity :
         {DriveQuantity::kPosition, DriveQuantity::kVelocity, DriveQuantity::kEffort}) {
      scene.drives[0].quantity = quantity;
      const std::string what = "drive " + std::to_string(static_cast<int>(quantity));
      expect_exact(scene, {}, what);
      expect_exact(scene, {true}, what + ", dynamics");
    }
  }
}

TEST(PlanarDirection, IsExactOnEveryRungOfTheLadder) {
  for (EndJoint base : kHeld) {
    const Scene scene = planar_chain(coordinate_plane(), base, EndJoint::kRevolute);
    Setting setting;
    setting.fraction = 0.4;
    expect_exact(scene, setting, "part of the loads, gaps held open");
    setting.relaxation = 2;
    expect_exact(scene, setting, "drag");
    setting = {};
    setting.softness = 2e-2;
    expect_exact(scene, setting, "soft rods");
  }
}

/// What a rod's track holds: positions and strains.
VecX track_values(Robot& robot) {
  robot.rods[1].model->fill_tracks();
  return robot.rods[1].model->tracks().front()->x;
}

TEST(PlanarRod, StartsMovingAsItsBodiesDo) {
  const Plane plane = oblique_plane();
  for (bool extensible : {false, true}) {
    Scene scene = planar_chain(plane, EndJoint::kFixed, EndJoint::kRevolute);
    switch_on(scene, {Effect::kDamping, Effect::kRotaryInertia});
    scene.effects.set(Effect::kExtension, extensible);
    scene.effects.set(Effect::kShear, extensible);
    LoadSpec load;
    load.rod = 1;
    load.rod_s = 0.4;
    load.follower = true;
    load.force = {0, -0.3, 0.5};
    scene.loads.push_back(load);
    Robot robot = build_robot(scene);
    Equations equations(robot, 1e-12);
    equations.set_instant(0, true, StageRates{});
    equations.mark_start();
    ASSERT_TRUE(solve_statics(equations, {}).converged());
    equations.hold_bodies(true);
    Numbers numbers(8);
    std::vector<Vec6> motions(2);
    for (Vec6& motion : motions)
      motion << numbers.next() * plane.col(2), plane * Vec3(numbers.next(), numbers.next(), 0);
    ASSERT_TRUE(equations.follow_bodies(motions));
    robot.rods[1].model->start_tracks_moving();
    const VecX v = robot.rods[1].model->tracks().front()->v;
    const RobotUnknowns start = equations.unknowns();
    const auto at = [&](double time) {
      RobotUnknowns u = start;
      for (std::size_t b = 0; b < motions.size(); ++b) {
        u.bodies[b].R = exp_so3(time * motions[b].head<3>()) * u.bodies[b].R;
        u.bodies[b].p += time * motions[b].tail<3>();
      }
      equations.set_unknowns(u);
      SolveOptions options;
      options.tolerance = 1e-12;
      EXPECT_TRUE(newton(equations, options).converged());
      return track_values(robot);
    };
    // of fourth order in steps of 1e-4: the solver's 1e-12 becomes 1e-8, curvatures change by 1e2
    constexpr double kTime = 1e-4;
    const VecX expected =
        (8 * (at(kTime) - at(-kTime)) - (at(2 * kTime) - at(-2 * kTime))) / (12 * kTime);
    EXPECT_LT((v - expected).cwiseAbs().maxCoeff(), 1e-6 * v.cwiseAbs().maxCoeff())
        << "extensible " << extensible << ", fastest " << v.cwiseAbs().maxCoeff();
  }
}

}  // namespace
}  // namespace cprsim
