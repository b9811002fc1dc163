// SPDX-License-Identifier: BSD-3-Clause
// The released rod against an independent solution, and a thinner one at every step.
#include "tests/support/released_rod.h"

#include <gtest/gtest.h>

namespace cprsim {
namespace {

Scene released_rod(SchemeKind scheme, double step) {
  Scene scene = released_rod_scene();
  scene.solver.points = 8;
  scene.solver.scheme = scheme;
  scene.solver.step = step;
  return scene;
}

TEST(ReleasedRod, HangsWhereTheReferenceHangs) {
  Simulation simulation(released_rod(SchemeKind::kEsdirk43, 1e-3));
  simulation.start();
  EXPECT_LT((simulation.now().rods[0].points.back().position - kReleasedTipHeld).norm(), 2e-10);
}

TEST(ReleasedRod, IsWhereTheReferenceIsAfterASecond) {
  Simulation simulation(released_rod(SchemeKind::kEsdirk43, 1e-3));
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  // 1e-6 m is 2.5e-6 of the length; the step's own error here is 3e-7 m
  EXPECT_LT((end.rods[0].points.back().position - kReleasedTipAfterOneSecond).norm(), 1e-6);
}

struct StepCase {
  SchemeKind scheme;
  double order;  ///< least order through the release
};

class ReleasedRodOrder : public ::testing::TestWithParam<StepCase> {};

TEST_P(ReleasedRodOrder, SurvivesTheRelease) {
  auto error = [&](double step) {
    Simulation simulation(released_rod(GetParam().scheme, step));
    const Snapshot end = run_to_end(simulation);
    EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    return (end.rods[0].points.back().position - kReleasedTipAfterOneSecond).norm();
  };
  const double observed = std::log2(error(1e-3) / error(5e-4));
  EXPECT_GT(observed, GetParam().order);
}

INSTANTIATE_TEST_SUITE_P(Schemes, ReleasedRodOrder,
                         ::testing::Values(StepCase{SchemeKind::kBdf2, 1.8},
                                           StepCase{SchemeKind::kBdfAlpha, 1.8},
                                           StepCase{SchemeKind::kGeneralizedAlpha, 1.8},
                                           StepCase{SchemeKind::kTrBdf2, 1.8}));

// Classic shooting dies near 1e-3 on this thinner rod; here every step converges, and to one
// solution.
TEST(ThinReleasedRod, ConvergesAtEveryStepFromTenMillisecondsToAMicrosecond) {
  auto tip_at = [](SchemeKind scheme, double step, double time) {
    Scene scene;
    scene.rods.push_back(steel_rod(0.4, 0.25e-3));
    add_load(scene, 1, {-1.0 / 256, 0, 0}, Vec3::Zero(), true);
    scene.solver.points = 12;
    scene.solver.scheme = scheme;
    scene.solver.step = step;
    scene.simulation.mode = Mode::kDynamic;
    scene.simulation.initial_static = true;
    scene.simulation.duration = time;
    Simulation simulation(scene);
    const Snapshot end = run_to_end(simulation);
    EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure() << " at step " << step;
    EXPECT_EQ(simulation.statistics().retried, 0) << "at step " << step;
    return end.rods[0].points.back().position;
  };
  for (const SchemeKind scheme :
       {SchemeKind::kEsdirk32, SchemeKind::kGeneralizedAlpha, SchemeKind::kBdfAlpha}) {
    const Vec3 fine = tip_at(scheme, 1e-5, 0.01);
    double last = 1;
    for (const double step : {1e-2, 1e-3, 1e-4}) {
      const double difference = (tip_at(scheme, step, 0.01) - fine).norm();
      EXPECT_LT(difference, 0.3 * last) << to_string(scheme) << " at step " << step;
      last = difference;
    }
    EXPECT_LT(last, 1e-5);
    EXPECT_LT((tip_at(scheme, 1e-6, 1e-3) - tip_at(scheme, 1e-5, 1e-3)).norm(), 1e-7)
        << to_string(scheme);
  }
}

}  // namespace
}  // namespace cprsim
