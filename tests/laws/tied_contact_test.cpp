// SPDX-License-Identifier: BSD-3-Clause
// Rods that are tied to others and touch something: ties and contacts stand in the same lists, but
// only contacts come and go.
#include <gtest/gtest.h>

#include "engine/model/touch.h"
#include "tests/support/end_of.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 1e-3, kWall = 0.05;

TieSpec tie(int rod, int other, const std::vector<double>& places) {
  TieSpec tie;
  tie.name = "tie";
  tie.rod = rod;
  tie.other = other;
  tie.s = tie.other_s = places;
  return tie;
}

RodSpec beside(const char* name, const Vec3& at) {
  RodSpec rod = steel_rod(kLength, kRadius);
  rod.name = name;
  rod.base.at.X_BF.p = at;
  return rod;
}

Scene prepared(Scene scene, Method method) {
  switch_on(scene, {Effect::kExtension, Effect::kContact});
  scene = finely(scene, method);
  if (method == Method::kCollocation) {
    scene.solver.degree = 6;
    scene.solver.elements = 8;
  }
  return scene;
}

/// Two wires in a row along x, tied at four places, pushed towards x.
Scene bundle(Method method) {
  Scene scene;
  scene.rods = {beside("first", Vec3::Zero()), beside("second", Vec3(0.01, 0, 0))};
  scene.ties = {tie(0, 1, {0.25, 0.5, 0.75, 1})};
  add_load(scene, 1, {8, 1, 0});
  return prepared(scene, method);
}

Snapshot run(const Scene& scene) {
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  return end;
}

class TiedRods : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, TiedRods, ::testing::ValuesIn(kEveryMethod), test_name);

// What a wall exerts, as a load on the rod that touches it does the same.
TEST_P(TiedRods, FeelAWallAsTheForceThatItExerts) {
  Scene pressed = bundle(GetParam());
  const Vec3 free = run(pressed).rods[1].points.back().position;
  add_wall(pressed, kWall);
  const Snapshot touching = run(pressed);
  ASSERT_EQ(touching.contact.count, 1);
  const ContactPoint& at = touching.contact.points[0];
  EXPECT_EQ(at.rod, 1);
  EXPECT_GT(touching.contact.force, 1);
  EXPECT_GT(free.x(), touching.rods[1].points.back().position.x() + 0.01);
  EXPECT_NEAR(touching.rods[1].points.back().position.x(), kWall - kRadius, 1e-3 * kRadius);
  Scene loaded = bundle(GetParam());
  LoadSpec push = add_load(loaded, 1, at.force);
  loaded.loads.back().rod = push.rod = 1;
  const Snapshot same = run(loaded);
  for (const std::size_t rod : {0U, 1U})
    EXPECT_LT(
        (same.rods[rod].points.back().position - touching.rods[rod].points.back().position).norm(),
        1e-8 * kLength);
}

// One in the other, of stiffnesses 0.3 and 0.7 all, tied at their tips, of which the outer touches:
// they share what the wall exerts and move like one of the sum.
TEST_P(TiedRods, ThatAreConcentricTouchLikeOneOfTheSum) {
  Scene one;
  one.rods = {steel_rod(kLength, kRadius)};
  add_load(one, 1, {2, 0.5, 0}, Vec3::Zero(), true);
  one = prepared(one, GetParam());
  add_wall(one, kWall);
  Scene two = one;
  two.rods.push_back(beside("inner", Vec3::Zero()));
  two.rods[1].without = {"contact"};
  for (const std::size_t rod : {0U, 1U}) {
    MaterialSpec& material = *two.rods[rod].material;
    for (double* value : {&material.density, &material.youngs_modulus, &material.shear_modulus})
      *value *= rod == 0 ? 0.3 : 0.7;
  }
  two.ties = {tie(0, 1, {1})};
  const Snapshot a = run(one), b = run(two);
  ASSERT_EQ(a.contact.count, 1);
  ASSERT_EQ(b.contact.count, 1);
  EXPECT_GT(a.contact.force, 0.1);
  EXPECT_NEAR(a.contact.force, b.contact.force, 1e-7 * a.contact.force);
  for (const std::size_t rod : {0U, 1U})
    EXPECT_LT((a.rods[0].points.back().position - b.rods[rod].points.back().position).norm(),
              1e-9 * kLength);
  for (Scene* scene : {&one, &two}) {
    scene->simulation.mode = Mode::kDynamic;
    scene->simulation.initial_static = true;
    scene->simulation.duration = 0.02;
    scene->solver.scheme = SchemeKind::kGeneralizedAlpha;
    scene->solver.step = 5e-4;
  }
  const Snapshot c = run(one), d = run(two);
  EXPECT_EQ(d.contact.count, 0) << "it has sprung back";
  EXPECT_GT(c.rods[0].points.back().velocity.norm(), 0.5);
  EXPECT_LT((c.rods[0].points.back().position - d.rods[1].points.back().position).norm(),
            1e-6 * kLength);
}

// Tied rods on one side, another rod across on the other: its forces stand in the lists of rods
// that have ties in them, too, and all three methods find them.
TEST_P(TiedRods, LeanOnARodAcross) {
  const auto leaning = [](Method method) {
    Scene scene = bundle(method);
    scene.loads[0].force = {4, 0.5, 0};
    RodSpec across = beside("across", Vec3(0.02, -0.2, 0.3));
    across.base.at.X_BF.R.col(0) = Vec3::UnitZ();
    across.base.at.X_BF.R.col(1) = Vec3::UnitX();
    across.base.at.X_BF.R.col(2) = Vec3::UnitY();
    scene.rods.push_back(across);
    return run(scene);
  };
  const Snapshot found = leaning(GetParam());
  ASSERT_EQ(found.contact.count, 1);
  EXPECT_EQ(found.contact.points[0].rod, 1);
  EXPECT_GT(found.contact.force, 0.1);
  const Snapshot reference = leaning(Method::kShooting);
  EXPECT_NEAR(found.contact.force, reference.contact.force, 3e-3 * reference.contact.force);
  for (const std::size_t rod : {0U, 1U, 2U})
    EXPECT_LT((found.rods[rod].points.back().position - reference.rods[rod].points.back().position)
                  .norm(),
              2e-4 * kLength);
}

TEST(TiedRodsPairs, DoNotTouchEachOther) {
  const Scene scene = bundle(Method::kShooting);
  EXPECT_EQ(why_never_touching(scene, {ContactParty{true, 0}, ContactParty{true, 1}}),
            "tie 'tie' holds them together");
  Scene loose = scene;
  loose.ties.clear();
  EXPECT_EQ(why_never_touching(loose, {ContactParty{true, 0}, ContactParty{true, 1}}), "");
}

// A swing into the wall and back: points come and go, the ties stay, and the books close.
TEST_P(TiedRods, StrikeAWallAndSpringBack) {
  Scene scene = bundle(GetParam());
  scene.loads.clear();
  add_load(scene, 1, {-12, 0, 0}, Vec3::Zero(), true);
  for (RodSpec& rod : scene.rods)
    damp(rod, 1e-4);
  switch_on(scene, {Effect::kDamping});
  scene = prepared(scene, GetParam());
  add_wall(scene, 0.02);
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.06;
  scene.solver.scheme = SchemeKind::kGeneralizedAlpha;
  scene.solver.step = 5e-4;
  Simulation simulation(scene);
  int touched = 0;
  double apart = 0;
  simulation.start();
  const Snapshot first = simulation.now();
  const double begun = first.energy.kinetic + first.energy.elastic;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    const Snapshot now = simulation.now();
    touched += now.contact.count > 0;
    EXPECT_LT(now.energy.kinetic + now.energy.elastic, begun * (1 + 1e-6));
    apart = std::max(
        apart,
        std::abs((now.rods[1].points.back().position - now.rods[0].points.back().position).norm() -
                 0.01));
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_GT(touched, 3);
  EXPECT_EQ(simulation.now().contact.count, 0);
  EXPECT_LT(apart, 1e-9);
}

}  // namespace
}  // namespace cprsim
