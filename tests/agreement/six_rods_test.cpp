// SPDX-License-Identifier: BSD-3-Clause
// The published six-rod robot in motion, a leg growing while a force shakes the plate: every method
// of a rod, and IDA of SUNDIALS, which shares neither formulas nor step sizes with the engine's
// schemes, to a millionth of a leg.
#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/support/end_of.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLeg = 0.4;

ProfileTerm smooth_rise(double to, double end) {
  ProfileTerm rise;
  rise.shape = ShapeOfTime::kSmoothstep;
  rise.to = to;
  rise.end = end;
  return rise;
}

/// 0.05 s: leg 1 grows by 4 mm while the plate, hung off its centre, is pushed aside by up to 1 N.
Scene moving_robot() {
  Scene scene = stewart_gough_driven({0.40, 0.40, 0.41, 0.42, 0.41, 0.40});
  switch_on(scene, {Effect::kDamping, Effect::kRotaryInertia});
  for (RodSpec& leg : scene.rods)
    damp(leg, 2e-3);
  scene.drives[0].profile.terms.push_back(smooth_rise(4e-3, 0.05));
  LoadSpec push;
  push.at = {0, {Mat3::Identity(), {0.03, 0.05, 0.01}}};
  push.force = {0.6, -0.8, 0.3};
  push.has_profile = true;
  push.profile.terms.push_back(smooth_rise(1, 0.04));
  scene.loads.push_back(push);
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.05;
  scene.solver.residual_tolerance = 1e-11;
  return scene;
}

/// Cut so that less than 1e-7 of a leg is left of errors in arc length.
Scene by(Method method) {
  Scene scene = moving_robot();
  scene.solver.method = method;
  scene.solver.points = 10;
  scene.solver.order = method == Method::kStrain ? 7 : 6;
  scene.solver.elements = method == Method::kStrain ? 1 : 8;
  scene.solver.degree = 8;
  return scene;
}

/// Largest distance of the plate or of any end or middle of a leg.
double farthest(const Snapshot& a, const Snapshot& b) {
  double most = (a.bodies[0].X_WB.p - b.bodies[0].X_WB.p).norm();
  for (std::size_t i = 0; i < a.rods.size(); ++i)
    most = std::max(most,
                    (a.rods[i].points.back().position - b.rods[i].points.back().position).norm());
  return most;
}

double turn_between(const Snapshot& a, const Snapshot& b) {
  return log_so3(a.bodies[0].X_WB.R.transpose() * b.bodies[0].X_WB.R).norm();
}

/// By shooting, with the engine's third-order scheme to a local error of 1e-9.
const Snapshot& reference() {
  static const Snapshot end = [] {
    Scene scene = by(Method::kShooting);
    scene.solver.scheme = SchemeKind::kEsdirk43;
    scene.solver.tolerance = 1e-9;
    return end_of(scene);
  }();
  return end;
}

TEST(SixRods, DoMove) {
  Scene scene = by(Method::kShooting);
  scene.simulation.mode = Mode::kStatic;
  EXPECT_GT(farthest(end_of(scene), reference()), 3e-3);
}

class SixRodsMoving : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Methods, SixRodsMoving, ::testing::ValuesIn(kEveryMethod), test_name);

TEST_P(SixRodsMoving, AgreeWithEachOther) {
  Scene scene = by(GetParam());
  scene.solver.scheme = SchemeKind::kEsdirk43;
  scene.solver.step = 1e-3;
  Scene shooting = by(Method::kShooting);
  shooting.solver = scene.solver;
  shooting.solver.method = Method::kShooting;
  shooting.solver.points = 16;
  const Snapshot found = end_of(scene), expected = end_of(shooting);
  EXPECT_LT(farthest(found, expected), 2e-8 * kLeg);
  EXPECT_LT(turn_between(found, expected), 2e-7);
  EXPECT_LT(farthest(found, reference()), 1e-6 * kLeg);
}

TEST_P(SixRodsMoving, AgreeWithIda) {
  Scene scene = by(GetParam());
  scene.solver.scheme = SchemeKind::kIda;
  scene.solver.tolerance = 1e-7;
  const Snapshot found = end_of(scene);
  EXPECT_LT(farthest(found, reference()), 1e-6 * kLeg);
  EXPECT_LT(turn_between(found, reference()), 1e-5);
  EXPECT_NEAR(found.energy.total, reference().energy.total,
              1e-4 * std::abs(reference().energy.work));
}

}  // namespace
}  // namespace cprsim
