// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/shooting.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "engine/robot/equations.h"
#include "engine/solve/newton.h"
#include "tests/engine/robot/sample_scenes.h"

namespace cprsim {
namespace {

const Pose kTop{Eigen::AngleAxisd(0.4, Vec3(0.6, 0.8, 0)).toRotationMatrix(), {0.1, 0.05, 0.85}};

ShootingRod& shooting(Robot& robot, std::size_t rod) {
  return dynamic_cast<ShootingRod&>(*robot.rods[rod].model);
}

TEST(ShootingRod, StartsStraightFromItsBase) {
  const Scene scene = grounded_rod(rod_end(EndJoint::kFixed, kWorld, kTop), RodEndSpec{});
  Robot robot = build_robot(scene);
  Equations equations(robot, 1e-9);
  equations.set_instant(0, true, StageRates{});
  EXPECT_LT(equations.evaluate().largest, 1e-14);  // nothing acts: round-off
  const ShootingRod& rod = shooting(robot, 0);
  for (int k = 0; k <= rod.cells(); ++k) {
    const double s = static_cast<double>(k) / rod.cells();
    EXPECT_LT((position_of(rod.node(k)) - (kTop.p + s * kTop.R.col(2))).norm(), 1e-14);
  }
}

TEST(ShootingRod, StartsInItsRestShape) {
  Scene scene = grounded_rod(rod_end(EndJoint::kFixed, kWorld, kTop), RodEndSpec{});
  const Vec3 u(1.5, -0.7, 2);
  scene.rods[0].rest_curvature = u;
  scene.solver.points = 30;
  Robot robot = build_robot(scene);
  const ShootingRod& rod = shooting(robot, 0);
  const NodeState& tip = rod.node(rod.cells());
  EXPECT_LT((rotation_of(tip) - kTop.R * exp_so3(u)).norm(), 1e-14);
  Equations equations(robot, 1e-9);
  equations.set_instant(0, true, StageRates{});
  const Vec3 start = position_of(tip);
  EXPECT_LT(equations.evaluate().largest, 1e-14);       // nothing acts: round-off
  EXPECT_LT((position_of(tip) - start).norm(), 1e-12);  // the cells agree with the closed form
}

TEST(ShootingRod, PutsNodesWherePointLoadsAct) {
  Scene scene = grounded_rod(rod_end(EndJoint::kFixed, kWorld, Pose{}), RodEndSpec{});
  LoadSpec load;
  load.rod = 0;
  load.force = {0.3, 0.1, -0.2};
  for (double s : {0.31, 0.77}) {
    load.rod_s = s;
    scene.loads.push_back(load);
  }
  Robot robot = build_robot(scene);
  Equations equations(robot, 1e-9);
  equations.set_instant(0, true, StageRates{});
  ASSERT_TRUE(newton(equations, {}).converged());
  // the internal force falls by each load it passes and vanishes at the free tip
  const RodSample sample = robot.rods[0].model->observe();
  int at_031 = 0, at_077 = 0;
  for (const auto& point : sample.points) {
    at_031 += std::abs(point.s - 0.31) < 1e-12;
    at_077 += std::abs(point.s - 0.77) < 1e-12;
    const double left = point.s < 0.31 - 1e-12 ? 2 : point.s < 0.77 - 1e-12 ? 1 : 0;
    EXPECT_LT((point.force - left * load.force).norm(), 1e-8) << point.s;  // solver's tolerance
  }
  EXPECT_EQ(at_031, 1);
  EXPECT_EQ(at_077, 1);
}

/// At rest in equilibrium; loads and gravity as the scene has them.
void settle(Equations& equations) {
  equations.set_instant(0, true, StageRates{});
  equations.mark_start();
  ASSERT_TRUE(solve_statics(equations, {}).converged());
}

// Cutting the same problem into segments changes its elimination, not its solution.
TEST(ShootingRod, SolutionDoesNotDependOnTheSegments) {
  Scene scene = chain_of_rods(EndJoint::kRevolute, EndJoint::kUniversal);
  scene.solver.points = 12;
  Robot cut = build_robot(scene), whole = build_robot(scene);
  Equations cut_equations(cut, 1e-11), whole_equations(whole, 1e-11);
  settle(cut_equations);
  Numbers numbers(3);
  const StageRates rates =
      start_step(cut, cut_equations, SchemeKind::kBackwardEuler, 1. / 1000, numbers);
  whole_equations.set_unknowns(cut_equations.unknowns());
  whole.bodies = cut.bodies;
  for (std::size_t r = 0; r < cut.rods.size(); ++r)
    *whole.rods[r].model->tracks()[0] = *cut.rods[r].model->tracks()[0];
  // segments follow from states, of which a rod never evaluated has none
  cut_equations.set_instant(0, true, rates);
  whole_equations.set_instant(0, true, rates);
  ASSERT_GE(cut.rods[1].model->segments(), 3);
  ASSERT_EQ(whole.rods[1].model->segments(), 1);
  SolveOptions options;
  options.tolerance = 1e-11;
  ASSERT_TRUE(newton(cut_equations, options).converged());
  ASSERT_TRUE(newton(whole_equations, options).converged());
  for (std::size_t r = 0; r < cut.rods.size(); ++r) {
    const RodSample a = cut.rods[r].model->observe(), b = whole.rods[r].model->observe();
    for (std::size_t k = 0; k < a.points.size(); ++k) {
      EXPECT_LT((a.points[k].position - b.points[k].position).norm(), 1e-11);  // solver's tolerance
      // forces are 1e6 positions: c_v c_w rhoA L
      EXPECT_LT((a.points[k].force - b.points[k].force).norm(), 1e-5);
    }
  }
}

/// What a rod's tracks hold: positions and strains.
VecX track_values(Robot& robot, std::size_t rod) {
  robot.rods[rod].model->fill_tracks();
  return robot.rods[rod].model->tracks().front()->x;
}

/// Velocities of a rod between bodies that move, by differences of equilibria.
VecX velocities(Robot& robot, Equations& equations, const std::vector<Vec6>& motions) {
  constexpr double kTime = 1e-5;
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
    return track_values(robot, 1);
  };
  const VecX after = at(kTime), before = at(-kTime);
  return (after - before) / (2 * kTime);
}

TEST(ShootingRod, StartsMovingAsItsBodiesDo) {
  for (bool extensible : {false, true}) {
    Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kUniversal);
    scene.effects.set(Effect::kDamping, true);
    scene.effects.set(Effect::kExtension, extensible);
    scene.effects.set(Effect::kShear, extensible);
    LoadSpec load;
    load.rod = 1;
    load.rod_s = 0.4;
    load.follower = true;
    load.force = {0.6, -0.3, 0.5};
    scene.loads.push_back(load);
    Robot robot = build_robot(scene);
    Equations equations(robot, 1e-12);
    settle(equations);
    equations.hold_bodies(true);
    Numbers numbers(8);
    const std::vector<Vec6> motions{numbers.vec6(), numbers.vec6()};
    ASSERT_TRUE(equations.follow_bodies(motions));
    robot.rods[1].model->start_tracks_moving();
    const VecX v = robot.rods[1].model->tracks().front()->v;
    // differences in steps of 1e-5: the solver's 1e-12 becomes 1e-7, curvatures change by 1e2
    const VecX expected = velocities(robot, equations, motions);
    EXPECT_LT((v - expected).cwiseAbs().maxCoeff(), 1e-6) << "extensible " << extensible;
  }
}

TEST(ShootingRod, StartsMovingRigidlyWithItsBodies) {
  Scene scene = chain_of_rods(EndJoint::kFixed, EndJoint::kFixed);
  scene.effects.set(Effect::kGravity, false);
  scene.effects.set(Effect::kRotaryInertia, true);
  Robot robot = build_robot(scene);
  Equations equations(robot, 1e-12);
  settle(equations);
  equations.hold_bodies(true);
  const Vec3 w(0.4, -0.7, 0.5), v(0.2, 0.1, -0.3);
  std::vector<Vec6> motions;
  for (const RigidBody& body : robot.bodies) {
    motions.emplace_back();
    motions.back() << w, v + w.cross(body.p);
  }
  ASSERT_TRUE(equations.follow_bodies(motions));
  RodModel& rod = *robot.rods[1].model;
  rod.start_tracks_moving();
  const Track &positions = *rod.tracks()[0], &rotations = *rod.tracks()[1];
  constexpr double kSolver = 1e-9;  // its tolerance of 1e-12 over the rod's condition
  for (Eigen::Index i = 0; i < positions.x.size(); i += 3) {
    const Vec3 x = positions.x.segment<3>(i);
    EXPECT_LT((positions.v.segment<3>(i) - (v + w.cross(x))).norm(), kSolver);
  }
  for (Eigen::Index i = 0; i < rotations.v.size(); i += 3)
    EXPECT_NEAR(rotations.v.segment<3>(i).norm(), w.norm(), kSolver);
}

}  // namespace
}  // namespace cprsim
