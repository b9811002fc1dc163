// SPDX-License-Identifier: BSD-3-Clause
// A robot that is turned and moved as a whole, or whose rods are told from their other end, moves
// as before, to round-off: at rest and in motion, by every method.
#include <gtest/gtest.h>

#include <numbers>

#include "engine/math/so3.h"
#include "tests/support/end_of.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4;

/// Two links joined by a precurved rod of rectangular section, the first hinged to the world: under
/// weight, with a load inside the rod and all that a moving rod can have.
Scene two_bodies(Mode mode) {
  Scene scene;
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear, Effect::kRotaryInertia,
                    Effect::kDamping});
  scene.gravity = {3, -4, -8};
  for (int i = 0; i < 2; ++i) {
    BodySpec body;
    body.name = i == 0 ? "lower" : "upper";
    body.mass = 0.05;
    body.inertia = Vec3(2e-5, 3e-5, 4e-5).asDiagonal();
    if (i == 1) body.X_WB = {exp_so3({0.5, 0.3, -0.4}), {0.12, -0.05, 0.33}};
    scene.bodies.push_back(body);
  }
  RodSpec hold = steel_rod(kLength, 1e-3);
  hold.name = "leg";
  hold.base.at = {kWorld, {Mat3::Identity(), {0, 0, -kLength}}};
  hold.tip.joint = EndJoint::kFixed;
  hold.tip.at.body = 0;
  RodSpec rod = steel_rod(kLength, 1e-3);
  rod.section.shape = SectionShape::kRectangle;
  rod.section.size = {2e-3, 1.5e-3};
  rod.rest_curvature = {1, -2, 0};
  rod.damping = DampingSpec{2e-3, 1e-3, 5, 5, {}};
  rod.base.at = {0, {exp_so3({0.2, -0.1, 0.3}), {0.01, 0.02, 0}}};
  rod.tip.joint = EndJoint::kFixed;
  rod.tip.at = {1, {exp_so3({0.1, 0.1, 0}), {0, 0.01, -0.01}}};
  scene.rods = {rod, hold};
  damp(scene.rods[1], 1e-3);
  add_load(scene, 0.3, {0.2, 0.5, -0.3});
  add_load(scene, 0.3, {-0.5, 1, 0.5}, {0.02, 0, 0.01}, true);
  scene.simulation.mode = mode;
  if (mode == Mode::kDynamic) {
    scene.simulation.initial_static = true;
    scene.simulation.duration = 0.03;
    scene.solver.scheme = SchemeKind::kEsdirk32;
    scene.solver.step = 1e-3;
  }
  scene.solver.residual_tolerance = 1e-12;
  return scene;
}

Scene coarsely(Scene scene, Method method) {
  scene.solver.method = method;
  scene.solver.points = 4;
  scene.solver.order = 3;
  scene.solver.degree = 4;
  scene.solver.elements = method == Method::kStrain ? 1 : 4;
  return scene;
}

Scene moved(Scene scene, const Pose& X) {
  scene.gravity = X.R * scene.gravity;
  for (BodySpec& body : scene.bodies)
    body.X_WB = X * body.X_WB;
  for (RodSpec& rod : scene.rods)
    for (RodEndSpec* end : {&rod.base, &rod.tip})
      if (end->at.body == kWorld) end->at.X_BF = X * end->at.X_BF;
  for (LoadSpec& load : scene.loads) {
    load.force = X.R * load.force;
    load.torque = X.R * load.torque;
  }
  return scene;
}

/// Rod 0 told from its other end: section axes turned half around x, so that z leads from base to
/// tip; derivatives by s change their sign.
Scene exchanged(Scene scene) {
  const Pose around{exp_so3({std::numbers::pi, 0, 0}), Vec3::Zero()};
  RodSpec& rod = scene.rods[0];
  std::swap(rod.base, rod.tip);
  rod.base.at.X_BF = rod.base.at.X_BF * around;
  rod.tip.at.X_BF = rod.tip.at.X_BF * around;
  rod.rest_curvature = -(around.R.transpose() * rod.rest_curvature);
  for (LoadSpec& load : scene.loads)
    load.rod_s = 1 - load.rod_s;
  return scene;
}

/// How far the bodies of `b` are from those of `a` moved by X; radians count as rod lengths.
double difference(const Snapshot& a, const Snapshot& b, const Pose& X) {
  double most = 0;
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    const Pose expected = X * a.bodies[i].X_WB, found = b.bodies[i].X_WB;
    most = std::max({most, (found.p - expected.p).norm() / kLength, (found.R - expected.R).norm()});
  }
  return most;
}

using Kind = std::tuple<Method, Mode>;

class Symmetry : public ::testing::TestWithParam<Kind> {
 protected:
  Scene scene() const {
    return coarsely(two_bodies(std::get<1>(GetParam())), std::get<0>(GetParam()));
  }
};

std::string name_of(const ::testing::TestParamInfo<Kind>& of) {
  return std::string(method_name(std::get<0>(of.param))) +
         (std::get<1>(of.param) == Mode::kStatic ? "_at_rest" : "_in_motion");
}

INSTANTIATE_TEST_SUITE_P(Every, Symmetry,
                         ::testing::Combine(::testing::ValuesIn(kEveryMethod),
                                            ::testing::Values(Mode::kStatic, Mode::kDynamic)),
                         name_of);

// These rods are a million times stiffer along than across: so much more of
// 1e-16 is seen, in each of 30 steps.
constexpr double kRoundOff = 2e-10;

TEST_P(Symmetry, OfTheWorld) {
  const Pose turned{exp_so3({0.7, -1.1, 0.4}), Vec3::Zero()}, shifted{Mat3::Identity(), {3, -2, 5}},
      both{turned.R, shifted.p};
  const Snapshot here = end_of(scene());
  for (const Pose& X : {turned, shifted, both}) {
    EXPECT_LT(difference(here, end_of(moved(scene(), X)), X), kRoundOff);
  }
}

// Strains and splines treat both ends alike. The cells of shooting measure rotations from where
// they begin, which is the other end of them in the exchanged rod: what their integrator errs by
// differs, and falls with its order, so that enough of them are needed.
TEST_P(Symmetry, OfBaseAndTip) {
  Scene one = scene();
  if (one.solver.method == Method::kShooting) one.solver.points = 24;
  const Snapshot forth = end_of(one), back = end_of(exchanged(one));
  EXPECT_LT(difference(forth, back, Pose{}), kRoundOff);
  const auto &a = forth.rods[0].points, &b = back.rods[0].points;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    EXPECT_LT((a[k].position - b[a.size() - 1 - k].position).norm(), kRoundOff * kLength);
}

TEST(ShootingSymmetry, OfBaseAndTipIsReachedWithTheOrderOfTheIntegrator) {
  const auto asymmetry = [](int cells) {
    Scene scene = coarsely(two_bodies(Mode::kStatic), Method::kShooting);
    scene.solver.points = cells;
    return difference(end_of(scene), end_of(exchanged(scene)), Pose{});
  };
  const double coarse = asymmetry(4), fine = asymmetry(8);
  EXPECT_LT(coarse, 1e-7);
  EXPECT_GT(std::log2(coarse / fine), 5.5) << coarse << " " << fine;  // gauss6
}

// The comparisons above are not of a robot that stands still.
TEST(SymmetryScene, Moves) {
  const Snapshot rest = end_of(coarsely(two_bodies(Mode::kStatic), Method::kShooting)),
                 moved = end_of(coarsely(two_bodies(Mode::kDynamic), Method::kShooting));
  EXPECT_GT(difference(rest, moved, Pose{}), 1e-3);
}

}  // namespace
}  // namespace cprsim
