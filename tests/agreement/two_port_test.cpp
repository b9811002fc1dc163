// SPDX-License-Identifier: BSD-3-Clause
// The condensed two-port of a rod is the derivative of its end wrenches by its end motions, block
// by block: against differences of rods solved again with their ends moved.
#include <gtest/gtest.h>

#include "engine/math/linear_solve.h"
#include "engine/math/so3.h"
#include "tests/engine/robot/sample_scenes.h"
#include "tests/support/finite_difference.h"
#include "tests/support/methods.h"
#include "tests/support/rod_ends.h"

namespace cprsim {
namespace {

/// Newton's method on the rod alone. @return wrenches on both bodies.
VecX solve(RodModel& rod, const RodEnds& ends) {
  CondensedRod c;
  for (int i = 0; i < 30; ++i) {
    const RodResidual r = rod.evaluate(ends.base, ends.tip);
    if (r.largest < 1e-13 || !rod.linearize(ends.base, ends.tip, c)) break;
    rod.keep();
    rod.set_direction(-solve_columns(c.T, c.t), Vec6::Zero());
    rod.move(1);
  }
  EXPECT_LT(rod.evaluate(ends.base, ends.tip).largest, 1e-11);
  VecX wrenches(12);
  wrenches << rod.wrench_on_base(ends.base), rod.wrench_on_tip(ends.tip);
  return wrenches;
}

MatX stiffness(RodModel& rod, const RodEnds& ends) {
  CondensedRod c;
  EXPECT_TRUE(rod.linearize(ends.base, ends.tip, c));
  const MatX z_A = -solve_columns(c.T, c.T_A), z_B = -solve_columns(c.T, c.T_B);
  MatX S(12, 12);
  S << c.WA_A + c.WA_z * z_A, c.WA_z * z_B, c.WB_A + c.WB_z * z_A, c.WB_B + c.WB_z * z_B;
  return S;
}

class TwoPort : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Methods, TwoPort, ::testing::ValuesIn(kEveryMethod), test_name);

TEST_P(TwoPort, IsTheDerivativeOfTheEndWrenches) {
  const EndJoint joints[] = {EndJoint::kFixed, EndJoint::kRevolute, EndJoint::kUniversal,
                             EndJoint::kBall};
  for (EndJoint joint : joints)
    for (bool dynamic : {false, true}) {
      Scene scene =
          grounded_rod(rod_end(EndJoint::kFixed, kWorld, Pose{}), rod_end(joint, kWorld, Pose{}));
      for (Effect e : {Effect::kGravity, Effect::kExtension, Effect::kShear, Effect::kRotaryInertia,
                       Effect::kDamping})
        scene.effects.set(e, true);
      LoadSpec load;
      load.rod = 0;
      load.rod_s = 0.4;
      load.follower = true;
      load.force = {0.6, -0.4, 0.5};
      scene.loads.push_back(load);
      scene.solver.method = GetParam();
      scene.solver.order = 4;
      Robot robot = build_robot(scene);
      RodModel& rod = *robot.rods[0].model;
      RodForcing forcing;
      forcing.length = scene.rods[0].length;
      forcing.gravity = {1, -2, -3};
      forcing.loads = {load_at(scene.loads[0], 0, false)};
      const StageRates rates = dynamic ? StageRates{4, 5, true} : StageRates{};
      RodEnds ends;
      ends.base = {exp_so3({0.1, -0.2, 0.3}), {0.02, 0.01, -0.03}, {0.1, 0.05, -0.07}, true};
      ends.tip = {exp_so3({0.5, 0.3, -0.1}), {0.25, -0.1, 0.85}, {-0.06, 0.1, 0.03}, true};
      rod.prepare(StageRates{}, forcing);
      solve(rod, ends);
      if (dynamic) rod.start_tracks();
      rod.prepare(rates, forcing);
      const auto f = [&](const RodEnds& at) { return solve(rod, at); };
      const MatX expected = difference_jacobian(f, ends, 12, moved, DifferenceSteps(2e-3));
      solve(rod, ends);
      const MatX S = stiffness(rod, ends);
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
          const MatX error = S.block(6 * i, 6 * j, 6, 6) - expected.block(6 * i, 6 * j, 6, 6);
          EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-7 * expected.cwiseAbs().maxCoeff())
              << "wrench on " << (i == 0 ? "base" : "tip") << " by motion of "
              << (j == 0 ? "base" : "tip") << ", joint " << static_cast<int>(joint)
              << (dynamic ? ", dynamic" : "");
        }
    }
}

}  // namespace
}  // namespace cprsim
