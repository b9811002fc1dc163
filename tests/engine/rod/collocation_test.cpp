// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/collocation.h"

#include <gtest/gtest.h>

#include "engine/math/linear_solve.h"
#include "engine/math/so3.h"
#include "engine/robot/equations.h"
#include "engine/solve/newton.h"
#include "tests/engine/robot/direction_error.h"
#include "tests/engine/robot/sample_scenes.h"

namespace cprsim {
namespace {

constexpr EndJoint kHeld[] = {EndJoint::kFixed, EndJoint::kRevolute, EndJoint::kUniversal,
                              EndJoint::kBall};
const Pose kTop{Eigen::AngleAxisd(0.4, Vec3(0.6, 0.8, 0)).toRotationMatrix(), {0.1, 0.05, 0.85}};

Scene with_splines(Scene scene, int degree = 4, int elements = 3) {
  scene.solver.method = Method::kCollocation;
  scene.solver.degree = degree;
  scene.solver.elements = elements;
  return scene;
}

void set_all_effects(Scene& scene) {
  for (Effect e : {Effect::kGravity, Effect::kExtension, Effect::kShear, Effect::kRotaryInertia,
                   Effect::kDamping})
    scene.effects.set(e, true);
}

enum class Rates { kStatic, kBackwardEuler, kGeneralizedAlpha };

struct Setting {
  Rates rates = Rates::kStatic;
  double relaxation = 0, softness = 0, fraction = 1;
};

/// As in tests/engine/robot/newton_direction_test.cpp: 0 if every derivative is right.
void expect_exact(const Scene& scene, const Setting& setting, const std::string& what) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    Numbers numbers(seed);
    Robot robot = build_robot(scene);
    Equations equations(robot, 1e-9);
    equations.set_instant(0, true, StageRates{});
    equations.mark_start();
    StageRates rates;
    if (setting.rates == Rates::kBackwardEuler)
      rates = start_step(robot, equations, SchemeKind::kBackwardEuler, 1. / 300, numbers);
    if (setting.rates == Rates::kGeneralizedAlpha)
      rates = start_step(robot, equations, SchemeKind::kGeneralizedAlpha, 1. / 300, numbers);
    equations.set_instant(0, true, rates);
    disturb(robot, equations, numbers, 0.05);
    equations.evaluate();
    if (setting.fraction < 1) equations.set_fraction(setting.fraction);
    if (setting.relaxation > 0) equations.set_relaxation(setting.relaxation);
    if (setting.softness > 0) equations.set_softness(setting.softness);
    disturb(robot, equations, numbers, 0.05);
    EXPECT_LT(direction_error(equations), 1e-7) << what << ", state " << seed;
  }
}

TEST(CollocationDirection, IsExactForEveryJointAtBothEnds) {
  for (bool spin : {false, true})
    for (EndJoint joint : kHeld) {
      const std::string what =
          std::to_string(static_cast<int>(joint)) + (spin ? ", spin free" : "");
      RodEndSpec base = rod_end(joint, kWorld, Pose{}), tip = rod_end(joint, kWorld, kTop);
      base.spin_free = tip.spin_free = spin;
      expect_exact(with_splines(grounded_rod(base, rod_end(EndJoint::kFixed, kWorld, kTop))), {},
                   "base " + what);
      expect_exact(with_splines(grounded_rod(rod_end(EndJoint::kFixed, kWorld, Pose{}), tip)), {},
                   "tip " + what);
    }
  expect_exact(with_splines(grounded_rod(rod_end(EndJoint::kFree, kWorld, Pose{}),
                                         rod_end(EndJoint::kFixed, kWorld, kTop))),
               {}, "free base");
  expect_exact(with_splines(grounded_rod(rod_end(EndJoint::kFixed, kWorld, Pose{}), RodEndSpec{})),
               {}, "free tip");
}

TEST(CollocationDirection, IsExactForRodsBetweenMovingBodies) {
  for (EndJoint base : kHeld) {
    const std::string what = "base " + std::to_string(static_cast<int>(base));
    Scene scene = with_splines(chain_of_rods(base, EndJoint::kUniversal));
    expect_exact(scene, {}, what + ", statics");
    scene.rods[0].rest_curvature = {0.8, -1.2, 0.6};
    set_all_effects(scene);
    expect_exact(scene, {}, what + ", statics with all effects");
    expect_exact(scene, {Rates::kBackwardEuler}, what + ", dynamics");
    expect_exact(scene, {Rates::kGeneralizedAlpha}, what + ", dynamics without body rates");
  }
}

TEST(CollocationDirection, IsExactForEveryDegreeAndEveryWayOfSolving) {
  for (int degree = kLeastDegree; degree <= kMaxDegree; ++degree) {
    const std::string what = "degree " + std::to_string(degree);
    const Scene scene = with_splines(chain_of_rods(EndJoint::kFixed, EndJoint::kBall), degree, 2);
    expect_exact(scene, {}, what);
    expect_exact(scene, {Rates::kBackwardEuler}, what + ", dynamics");
    expect_exact(scene, {Rates::kStatic, 0, 0.7}, what + ", soft");
    expect_exact(scene, {Rates::kStatic, 3, 0, 0.4}, what + ", with drag and gaps");
  }
}

// At both ends and in between, dead and following.
TEST(CollocationDirection, IsExactForPointLoads) {
  Scene scene = with_splines(chain_of_rods(EndJoint::kRevolute, EndJoint::kFixed));
  Numbers numbers(7);
  for (double s : {0., 0.35, 0.35, 0.8, 1.})
    for (bool follower : {false, true}) {
      LoadSpec load;
      load.rod = 1;
      load.rod_s = s;
      load.force = numbers.vec3();
      load.torque = numbers.vec3();
      load.follower = follower;
      scene.loads.push_back(load);
    }
  expect_exact(scene, {}, "loads, statics");
  set_all_effects(scene);
  expect_exact(scene, {Rates::kBackwardEuler}, "loads, dynamics");
}

TEST(CollocationRod, StartsStraightFromItsBaseInEquilibrium) {
  const Scene scene =
      with_splines(grounded_rod(rod_end(EndJoint::kFixed, kWorld, kTop), RodEndSpec{}));
  Robot robot = build_robot(scene);
  Equations equations(robot, 1e-9);
  equations.set_instant(0, true, StageRates{});
  EXPECT_LT(equations.evaluate().largest, 1e-13);  // nothing acts: round-off
  for (const RodPoint& point : robot.rods[0].model->observe().points)
    EXPECT_LT((point.position - (kTop.p + point.s * kTop.R.col(2))).norm(), 1e-14);
}

TEST(CollocationRod, StartsInItsRestShape) {
  Scene scene =
      with_splines(grounded_rod(rod_end(EndJoint::kFixed, kWorld, kTop), RodEndSpec{}), 7, 12);
  const Vec3 u(1.5, -0.7, 2);
  scene.rods[0].rest_curvature = u;
  Robot robot = build_robot(scene);
  Equations equations(robot, 1e-9);
  equations.set_instant(0, true, StageRates{});
  EXPECT_LT(equations.evaluate().largest, 1e-9);  // the interpolation's error
  for (const RodPoint& point : robot.rods[0].model->observe().points)
    EXPECT_LT((point.rotation - kTop.R * exp_so3(point.s * u)).norm(), 1e-10) << point.s;
}

// The internal force falls by each load it passes; knots of full multiplicity let it jump.
TEST(CollocationRod, ForcesJumpWherePointLoadsAct) {
  Scene scene = with_splines(grounded_rod(rod_end(EndJoint::kFixed, kWorld, Pose{}), RodEndSpec{}));
  LoadSpec load;
  load.rod = 0;
  load.force = {0.3, 0.1, -0.2};
  for (double s : {0.31, 0.77}) {
    load.rod_s = s;
    scene.loads.push_back(load);
  }
  Robot robot = build_robot(scene);
  Equations equations(robot, 1e-11);
  equations.set_instant(0, true, StageRates{});
  SolveOptions options;
  options.tolerance = 1e-11;
  ASSERT_TRUE(newton(equations, options).converged());
  int at_loads = 0;
  for (const auto& point : robot.rods[0].model->observe().points) {
    at_loads += std::abs(point.s - 0.31) < 1e-12 || std::abs(point.s - 0.77) < 1e-12;
    const double left = point.s < 0.31 - 1e-12 ? 2 : point.s < 0.77 - 1e-12 ? 1 : 0;
    EXPECT_LT((point.force - left * load.force).norm(), 1e-10) << point.s;
  }
  EXPECT_EQ(at_loads, 2);
}

// A turn of the whole rod by any angle: increments of control points turn all quaternions in one
// step, positions follow in the next.
TEST(CollocationRod, FollowsATurnOfItsBaseInTwoSteps) {
  Scene scene = with_splines(grounded_rod(rod_end(EndJoint::kFixed, kWorld, Pose{}), RodEndSpec{}));
  const RodSpec& spec = scene.rods[0];
  CollocationRod rod("rod", EndCondition(spec.base), EndCondition(spec.tip), {}, Pose{},
                     section_properties(spec), spec.length, CollocationOptions{});
  RodForcing forcing;
  forcing.length = spec.length;
  rod.prepare({}, forcing);
  Port base;
  base.R = exp_so3({0.3, 2.6, -1.1});
  base.p = {0.2, -0.4, 0.1};
  rod.evaluate(base, {});
  for (int step = 0; step < 2; ++step) {
    CondensedRod out;
    ASSERT_TRUE(rod.linearize(base, {}, out));
    rod.set_direction(-solve_columns(out.T, out.t), Vec6::Zero());
    rod.keep();
    rod.move(1);
    rod.evaluate(base, {});
    EXPECT_LT((rod.observe().points.back().rotation - base.R).norm(), 1e-12);
  }
  EXPECT_LT(rod.evaluate(base, {}).largest, 1e-12);
  const RodPoint tip = rod.observe().points.back();
  EXPECT_LT((tip.position - base.p - spec.length * base.R.col(2)).norm(), 1e-12);
}

}  // namespace
}  // namespace cprsim
