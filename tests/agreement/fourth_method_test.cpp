// SPDX-License-Identifier: BSD-3-Clause
// A discretisation that the program does not know, plugged in from outside, shows that statics,
// time schemes and robots know no more of a rod than engine/rod/rod_model.h says.
#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/agreement/rigid_link.h"
#include "tests/support/finite_difference.h"
#include "tests/support/jointed_bodies.h"
#include "tests/support/rod_ends.h"

namespace cprsim {
namespace {

/// Rods called "link" are rigid; the others are made as ever.
std::unique_ptr<RodModel> make(Method method, const RodPlan& plan) {
  if (plan.spec->name == "link") return std::make_unique<RigidLink>(plan);
  return make_rod(method, plan);
}

constexpr double kLink = 0.06;

RodSpec elastic(const char* name, Method method, int base, const Pose& X_Base, int tip,
                const Pose& X_Tip) {
  RodSpec rod = steel_rod(0.3, 1e-3);
  rod.name = name;
  rod.method = method;
  damp(rod, 2e-3);
  rod.base.at = {base, X_Base};
  rod.tip.joint = EndJoint::kFixed;
  rod.tip.at = {tip, X_Tip};
  return rod;
}

/// Where the link leaves body 0 and where it arrives on body 1.
const Pose kLeaves{exp_so3({0.3, 0.5, -0.2}), {0.01, -0.02, 0.01}},
    kArrives{exp_so3({-0.4, 0.1, 0.6}), {0.02, 0.01, -0.01}};

/// Body 0 on a rod of shooting, body 1 on one of strains and one of splines, and nothing between
/// them yet.
Scene two_bodies() {
  Scene scene;
  switch_on(scene, {Effect::kGravity, Effect::kDamping});
  scene.gravity = {2, -3, -9};
  const Pose X_W0{exp_so3({0.1, 0.2, 0}), {0.02, 0.01, 0.29}};
  scene.bodies.push_back(lump("lower", X_W0, 0.1, {3e-5, 4e-5, 5e-5}));
  const Pose X_W1 = X_W0 * kLeaves * Pose{Mat3::Identity(), {0, 0, kLink}} * kArrives.inverse();
  scene.bodies.push_back(lump("upper", X_W1, 0.05, {2e-5, 1e-5, 2e-5}));
  const auto above = [&](double angle) {
    return Pose{exp_so3({angle, 0.3, 0}), X_W1.p + Vec3(0.05, -0.1 * angle, 0.25)};
  };
  scene.rods.push_back(elastic("lower rod", Method::kShooting, kWorld, Pose{}, 0, Pose{}));
  scene.rods.push_back(elastic("upper rod", Method::kStrain, 1,
                               Pose{X_W1.R.transpose(), Vec3::Zero()}, kWorld, above(0.4)));
  scene.rods.push_back(elastic("third rod", Method::kCollocation, 1,
                               Pose{X_W1.R.transpose(), Vec3(0, 0.01, 0)}, kWorld, above(-0.4)));
  LoadSpec load;
  load.at = {1, Pose{Mat3::Identity(), {0.01, 0.02, 0.03}}};
  load.force = {0.5, 0.3, -0.4};
  let_go(load);
  scene.loads.push_back(load);
  return scene;
}

Scene linked() {
  Scene scene = two_bodies();
  RodSpec link = elastic("link", Method::kAuto, 0, kLeaves, 1, kArrives);
  link.length = kLink;
  link.damping.reset();
  scene.rods.insert(scene.rods.begin() + 1, link);
  return scene;
}

/// The same with a rigid joint of SDF, which makes one body of the two.
Scene welded() {
  Scene scene = two_bodies();
  JointSpec weld;
  weld.name = "weld";
  weld.parent = 0;
  weld.child = 1;
  weld.X_PJ = kLeaves * Pose{Mat3::Identity(), {0, 0, kLink}};
  weld.X_CJ = kArrives;
  scene.joints.push_back(weld);
  return scene;
}

Snapshot made_end_of(const Scene& scene) {
  Simulation simulation(scene, nullptr, make);
  const Snapshot end = run_to_end(simulation);
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  return end;
}

double difference(const Snapshot& a, const Snapshot& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.bodies.size(); ++i)
    most = std::max({most, (a.bodies[i].X_WB.p - b.bodies[i].X_WB.p).norm(),
                     0.1 * (a.bodies[i].X_WB.R - b.bodies[i].X_WB.R).norm()});
  return most;
}

// Equations (1), (2) against differences, closed or not.
TEST(FourthMethod, IsLinearisedExactly) {
  const Scene scene = linked();
  Robot robot = build_robot(scene, make);
  RodModel& link = *robot.rods[1].model;
  RodEnds ends;
  ends.base = {exp_so3({0.1, -0.2, 0.3}), {0.02, 0.01, -0.03}, {0.1, 0.05, -0.07}, true};
  ends.tip = {exp_so3({0.5, 0.3, -0.1}), {0.05, -0.02, 0.04}, {-0.06, 0.1, 0.03}, true};
  RodForcing forcing;
  forcing.length = kLink;
  link.prepare(StageRates{}, forcing);
  Vec6 z;
  z << 0.3, -0.5, 0.2, 0.7, -0.4, 0.9;
  link.keep();
  link.set_direction(z, Vec6::Zero());
  link.move(1);
  const auto rows = [&](const RodEnds& at) -> VecX {
    link.evaluate(at.base, at.tip);
    CondensedRod c;
    link.linearize(at.base, at.tip, c);
    VecX all(18);
    all << c.t, link.wrench_on_base(at.base), link.wrench_on_tip(at.tip);
    return all;
  };
  const MatX by_ends = difference_jacobian(rows, ends, 12, moved, DifferenceSteps(1e-3));
  const auto by_wrench = [&](const VecX& dz) -> VecX {
    link.keep();
    link.set_direction(dz, Vec6::Zero());
    link.move(1);
    const VecX all = rows(ends);
    link.move(0);
    return all;
  };
  const MatX by_z = difference_jacobian(by_wrench, VecX(VecX::Zero(6)), DifferenceSteps(1e-2));
  link.evaluate(ends.base, ends.tip);
  CondensedRod c;
  ASSERT_TRUE(link.linearize(ends.base, ends.tip, c));
  MatX analytic = MatX::Zero(18, 18);
  analytic << c.T_A, c.T_B, c.T, c.WA_A, MatX::Zero(6, 6), c.WA_z, c.WB_A, c.WB_B, c.WB_z;
  MatX numeric(18, 18);
  numeric << by_ends, by_z;
  EXPECT_TRUE(jacobians_agree(analytic, numeric, 1e-9, 1e-10));
}

TEST(FourthMethod, StandsAsTheSameRobotWithAWeld) {
  Simulation one(linked(), nullptr, make), other(welded(), nullptr, make);
  const Snapshot found = run_to_end(one), expected = run_to_end(other);
  ASSERT_EQ(one.status(), RunStatus::kDone) << one.failure();
  ASSERT_EQ(other.status(), RunStatus::kDone) << other.failure();
  EXPECT_LT(difference(found, expected), 1e-10);
  EXPECT_EQ(one.facts().rods[1].rule, "rigid");
  EXPECT_LE(one.statistics().start_iterations, other.statistics().start_iterations + 3);
}

// As drawn, the bodies need not be where the link wants them.
TEST(FourthMethod, ClosesAGap) {
  Scene apart = linked();
  apart.bodies[1].X_WB.p += Vec3(0.02, -0.03, 0.01);
  apart.bodies[1].X_WB.R = exp_so3({0.2, 0, -0.3}) * apart.bodies[1].X_WB.R;
  EXPECT_LT(difference(made_end_of(apart), made_end_of(welded())), 1e-10);
}

// m g at the end of a link that sticks out sideways.
TEST(FourthMethod, BearsAWeight) {
  Scene scene;
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {0, 0, -9.81};
  const Pose out{exp_so3({0, 0.5 * std::numbers::pi, 0}), Vec3::Zero()};  // z along x
  scene.bodies.push_back(lump("weight", Pose{Mat3::Identity(), {kLink, 0, 0}}, 0.2, {1, 1, 1}));
  RodSpec link = elastic("link", Method::kAuto, kWorld, out, 0, Pose{out.R, Vec3::Zero()});
  link.length = kLink;
  scene.rods.push_back(link);
  const Snapshot end = made_end_of(scene);
  const RodPoint &base = end.rods[0].points.front(), &tip = end.rods[0].points.back();
  EXPECT_LT((base.force - Vec3(0, 0, -0.2 * 9.81)).norm(), 1e-10);
  EXPECT_LT((base.moment - Vec3(0, kLink * 0.2 * 9.81, 0)).norm(), 1e-10);
  EXPECT_LT(tip.moment.norm(), 1e-10);
}

// Time schemes see two bodies that a constraint holds together, or one: what they err by differs,
// and vanishes with the step.
TEST(FourthMethod, MovesAsTheSameRobotWithAWeld) {
  const auto apart = [](double step) {
    Scene one = linked(), other = welded();
    for (Scene* scene : {&one, &other}) {
      scene->simulation.mode = Mode::kDynamic;
      scene->simulation.initial_static = true;
      scene->simulation.duration = 0.04;
      scene->solver.scheme = SchemeKind::kEsdirk32;
      scene->solver.step = step;
      scene->solver.residual_tolerance = 1e-11;
    }
    const Snapshot found = made_end_of(one), expected = made_end_of(other);
    EXPECT_LT(std::abs(found.energy.balance), 1e-2 * found.energy.dissipated);
    return difference(found, expected);
  };
  Scene rest = welded(), moves = welded();
  moves.loads.clear();
  EXPECT_GT(difference(made_end_of(rest), made_end_of(moves)),
            1e-3);  // what the release moves it by
  const double coarse = apart(1e-3), fine = apart(5e-4);
  EXPECT_LT(fine, 1e-9);
  EXPECT_GT(std::log2(coarse / fine), 1.8);
}

TEST(FourthMethod, IsAskedForByNobodyElse) {
  const Scene scene = two_bodies();
  const Robot robot = build_robot(scene);
  EXPECT_EQ(robot.rods[0].model->resolution().method, Method::kShooting);
  EXPECT_EQ(robot.rods[1].model->resolution().method, Method::kStrain);
  EXPECT_EQ(robot.rods[2].model->resolution().method, Method::kCollocation);
}

}  // namespace
}  // namespace cprsim
