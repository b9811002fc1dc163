// SPDX-License-Identifier: BSD-3-Clause
// A rod brought to its place by itself, and robots whose rods are.
#include "engine/robot/rod_between.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/engine/robot/sample_scenes.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

/// A rod longer than the way between its ends, which do not face each other.
Scene bent_between(const RodEndSpec& base, const RodEndSpec& tip) {
  Scene scene;
  RodSpec rod = steel_rod(1, 2e-3);
  rod.base = base;
  rod.tip = tip;
  scene.rods.push_back(rod);
  return scene;
}

RodEndSpec end_at(EndJoint joint, bool spins, const Pose& X) {
  RodEndSpec end = rod_end(joint, kWorld, X);
  end.spin_free = spins;
  return end;
}

const Pose kBase{exp_so3(Vec3(0.08, -0.05, 0.02)), Vec3::Zero()};
const Pose kTip{exp_so3(Vec3(-0.12, 0.1, 0.3)), {0.05, -0.03, 0.93}};

SolveReport bring(Robot& robot, double* residual = nullptr) {
  Equations equations(robot, 1e-9);
  equations.set_instant(0, true, StageRates{});
  long eliminating = 0;
  RodBetween alone(equations, eliminating, robot, robot.rods[0], equations.rates());
  const SolveReport report = solve_statics(alone, {});
  if (residual) *residual = alone.evaluate().largest;
  return report;
}

class EveryRodBetween : public testing::TestWithParam<Method> {};

TEST_P(EveryRodBetween, IsWhereTheWholeRobotHasIt) {
  for (const EndJoint joint : {EndJoint::kFixed, EndJoint::kRevolute, EndJoint::kUniversal}) {
    const Scene scene =
        finely(bent_between(end_at(EndJoint::kFixed, false, kBase), end_at(joint, false, kTip)),
               GetParam());
    Robot alone = build_robot(scene), whole = build_robot(scene);
    double residual = 1;
    ASSERT_TRUE(bring(alone, &residual).converged()) << static_cast<int>(joint);
    EXPECT_LE(residual, 1e-9);
    Equations equations(whole, 1e-9);
    equations.set_instant(0, true, StageRates{});
    ASSERT_TRUE(solve_statics(equations, {}).converged());
    const RodSample a = alone.rods[0].model->observe(), b = whole.rods[0].model->observe();
    ASSERT_EQ(a.points.size(), b.points.size());
    // the ladder is the same, and so is the branch that it finds
    for (std::size_t i = 0; i < a.points.size(); ++i)
      EXPECT_LT((a.points[i].position - b.points[i].position).norm(), 1e-7) << i;
  }
}

// Once a row of such a rod contradicted the others wherever its tangent had not yet found its
// joint, and Newton's method crept.
TEST_P(EveryRodBetween, FindsItsShapeThoughItSpinsFreelyAtBothEnds) {
  for (const auto& [base, tip] :
       {std::pair(EndJoint::kBall, EndJoint::kFixed), std::pair(EndJoint::kFixed, EndJoint::kFixed),
        std::pair(EndJoint::kFixed, EndJoint::kBall)}) {
    const Scene scene =
        finely(bent_between(end_at(base, true, kBase), end_at(tip, true, kTip)), GetParam());
    Robot robot = build_robot(scene);
    const SolveReport report = bring(robot);
    EXPECT_TRUE(report.converged())
        << static_cast<int>(base) << " " << static_cast<int>(tip) << " " << report.worst_row;
    // nothing twists it
    for (const RodPoint& point : robot.rods[0].model->observe().points) {
      const double scale = bending_stiffness(scene.rods[0]) / scene.rods[0].length;
      EXPECT_LT(std::abs(point.moment.dot(point.rotation.col(2))), 1e-6 * scale);
    }
  }
}

TEST_P(EveryRodBetween, SaysThatItIsTooShort) {
  Pose far = kTip;
  far.p.z() = 1.05;
  Robot robot = build_robot(finely(
      bent_between(end_at(EndJoint::kFixed, false, kBase), end_at(EndJoint::kFixed, false, far)),
      GetParam()));
  EXPECT_FALSE(bring(robot).converged());  // it cannot stretch
}

INSTANTIATE_TEST_SUITE_P(Every, EveryRodBetween, testing::ValuesIn(kEveryMethod), test_name);

}  // namespace
}  // namespace cprsim
