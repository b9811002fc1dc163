// SPDX-License-Identifier: BSD-3-Clause
// Tendons whose tensions are found, or that rub, along rods that touch something or are tied: the
// unknowns of tendons and the forces of contacts stand in the same equations.
#include <gtest/gtest.h>

#include "tests/support/end_of.h"
#include "tests/support/methods.h"
#include "tests/support/tendons.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4, kRadius = 1e-3, kOffset = 0.012;

/// Pulled towards x by a tendon that rubs or whose displacement is given.
Scene pulled_rod(Method method, bool displaced) {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, kRadius));
  switch_on(scene, {Effect::kGravity, Effect::kExtension});
  scene.gravity = {0, 2, -5};
  scene = finely(scene, method);
  if (method == Method::kCollocation) {
    scene.solver.degree = 6;
    scene.solver.elements = 8;
  }
  add_tendon(scene, kOffset, 0, 14);
  if (displaced) {
    displace(scene, 6e-3);
  } else {
    switch_on(scene, {Effect::kTendonFriction});
    scene.tendons[0].friction = 0.3;
  }
  return scene;
}

Scene moving(Scene scene) {
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.04;
  ProfileTerm& pull = scene.drives[0].profile.terms[0];
  pull.shape = ShapeOfTime::kSmoothstep;
  pull.from = pull.value;
  pull.to = 1.2 * pull.value;
  pull.end = 0.04;
  scene.solver.scheme = SchemeKind::kGeneralizedAlpha;
  scene.solver.step = 1e-3;
  return scene;
}

struct Found {
  Vec3 tip;
  TendonSample tendon;
  ContactSample contact;
};

Found run(const Scene& scene) {
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  return {end.rods[0].points.back().position, end.tendons[0], end.contact};
}

class TendonsAndContact : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, TendonsAndContact, ::testing::ValuesIn(kEveryMethod), test_name);

// A wall out of reach changes nothing.
TEST_P(TendonsAndContact, AreAloneWhereNothingTouches) {
  for (const bool displaced : {false, true})
    for (const bool moves : {false, true}) {
      Scene free = pulled_rod(GetParam(), displaced);
      // collocation cuts rods that may touch in other places
      free.solver.step = 1e-3;
      if (moves) free = moving(free);
      Scene beside = free;
      add_wall(beside, 2 * kLength);
      const Found a = run(free), b = run(beside);
      EXPECT_EQ(b.contact.count, 0);
      const double unlike = GetParam() == Method::kCollocation ? 2e-5 : 1e-9;
      EXPECT_LT((a.tip - b.tip).norm(), unlike * kLength);
      EXPECT_NEAR(a.tendon.tension, b.tendon.tension, unlike * 14);
      EXPECT_NEAR(a.tendon.end_tension, b.tendon.end_tension, unlike * 14);
    }
}

// What a wall exerts, as a load at the tip does the same: the equilibrium without the wall.
TEST_P(TendonsAndContact, FeelTheWallAsTheForceThatItExerts) {
  for (const bool displaced : {false, true}) {
    Scene pressed = pulled_rod(GetParam(), displaced);
    add_wall(pressed, 0.05);
    const Found wall = run(pressed);
    ASSERT_EQ(wall.contact.count, 1);
    EXPECT_GT(wall.contact.force, 0.1);
    EXPECT_LT(wall.contact.penetration, 1e-9);
    Scene loaded = pulled_rod(GetParam(), displaced);
    const Vec3 force = wall.contact.points[0].force;
    // the force acts on the surface, beside the centreline
    const Vec3 arm = wall.contact.points[0].position - wall.tip;
    add_load(loaded, 1, force, arm.cross(force));
    const Found load = run(loaded);
    EXPECT_LT((wall.tip - load.tip).norm(), 1e-6 * kLength);
    EXPECT_NEAR(wall.tendon.tension, load.tendon.tension, 1e-4);
    EXPECT_NEAR(wall.tendon.end_tension, load.tendon.end_tension, 1e-4);
  }
}

/// Two rods that lie in each other, tied at so many places, the first of them pulled.
Scene tied(const Scene& one, int ties) {
  Scene two = one;
  two.rods.clear();
  for (const double share : {0.3, 0.7}) {
    RodSpec part = one.rods[0];
    part.material->youngs_modulus *= share;
    part.material->shear_modulus *= share;
    part.material->density *= share;
    if (share > 0.5) part.name = "other";
    two.rods.push_back(part);
  }
  TieSpec tie;
  tie.name = "tie";
  tie.rod = 0;
  tie.other = 1;
  for (int k = 1; k <= ties; ++k)
    tie.s.push_back(static_cast<double>(k) / ties);
  tie.other_s = tie.s;
  two.ties = {tie};
  return two;
}

// Between its ties the pulled rod bends alone; the more there are, the more do both bend like one
// of the sum of their stiffnesses: with the first power of the distance, since its end always is
// free.
TEST_P(TendonsAndContact, PullTiedRodsAsOneOfTheSum) {
  for (const bool displaced : {false, true}) {
    Scene one = pulled_rod(GetParam(), displaced);
    one.gravity.setZero();
    one.solver.points = 16;
    one.solver.order = 5;
    one.solver.elements = 4;
    one.solver.degree = 5;
    const Found whole = run(one), few = run(tied(one, 2)), many = run(tied(one, 16));
    const double coarse = (few.tip - whole.tip).norm(), fine = (many.tip - whole.tip).norm();
    std::printf("2 ties %.1e m, 16 ties %.1e m\n", coarse, fine);
    EXPECT_GT(whole.tip.x(), 0.05);
    EXPECT_LT(fine, 0.5 * coarse);
    EXPECT_LT(fine, 1e-2 * kLength);
    EXPECT_NEAR(many.tendon.end_tension / whole.tendon.end_tension, 1, 0.06);
  }
}

/// A tip that is pressed against a wall by a tendon.
Found pressed(Method method, bool displaced, bool moves) {
  Scene scene = pulled_rod(method, displaced);
  if (moves) scene = moving(scene);
  add_wall(scene, 0.05);
  return run(scene);
}

// By every method the same, at rest and in motion.
TEST(TendonsOnAWall, AreTheSameByEveryMethod) {
  for (const bool displaced : {false, true})
    for (const bool moves : {false, true}) {
      const Found x = pressed(Method::kShooting, displaced, moves);
      EXPECT_GT(x.contact.force, 0.05);
      for (const Method method : {Method::kStrain, Method::kCollocation}) {
        const Found y = pressed(method, displaced, moves);
        const double unlike = displaced ? 1e-6 : 2e-4;
        EXPECT_LT((x.tip - y.tip).norm(), unlike * kLength) << method_name(method) << moves;
        EXPECT_NEAR(x.contact.force / y.contact.force, 1, 10 * unlike) << method_name(method);
        EXPECT_NEAR(x.tendon.end_tension / y.tendon.end_tension, 1, 10 * unlike);
      }
    }
}

}  // namespace
}  // namespace cprsim
