// SPDX-License-Identifier: BSD-3-Clause
// Motion by every method: an independent solution, closed loops in a plane, energy, thin rods.
#include <gtest/gtest.h>

#include "tests/support/end_of.h"
#include "tests/support/methods.h"
#include "tests/support/planar_robots.h"
#include "tests/support/released_rod.h"

namespace cprsim {
namespace {

class EveryMethodMoving : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethodMoving, ::testing::ValuesIn(kEveryMethod), test_name);

Vec3 tip_of(const Snapshot& snapshot) {
  return snapshot.rods[0].points.back().position;
}

// Methods differ by their errors in arc length alone: the steps in time are the same.
TEST_P(EveryMethodMoving, ReleasesARod) {
  Scene scene = released_rod_scene();
  scene.solver.scheme = SchemeKind::kEsdirk43;
  scene.solver.step = 1e-3;
  scene.simulation.duration = 0.1;
  Scene shooting = scene;
  shooting.solver.points = 16;
  scene.solver.method = GetParam();
  scene.solver.order = 10;
  scene.solver.degree = 8;
  const Snapshot found = end_of(scene), expected = end_of(shooting);
  EXPECT_LT((tip_of(found) - tip_of(expected)).norm(), 4e-7);  // 1e-6 L
  EXPECT_NEAR(found.energy.kinetic + found.energy.elastic,
              expected.energy.kinetic + expected.energy.elastic, 1e-7 * expected.energy.elastic);
  EXPECT_LT(std::abs(found.energy.balance), 1e-3 * found.energy.dissipated);
}

TEST_P(EveryMethodMoving, SwingsTwoRodsBetweenCranks) {
  const Plane plane = oblique_plane();
  Scene scene = rfrfr(plane, 0.4);
  switch_on(scene, {Effect::kGravity, Effect::kDamping});
  for (RodSpec& rod : scene.rods)
    damp(rod, 3e-3);
  set_dynamic(scene, 0.3, 0.01, SchemeKind::kEsdirk32);
  scene.solver.residual_tolerance = 1e-11;
  const Snapshot expected = end_of(finely(scene, Method::kShooting)),
                 found = end_of(finely(in_plane(scene, plane), GetParam()));
  for (std::size_t i = 0; i < expected.bodies.size(); ++i)
    EXPECT_LT((found.bodies[i].X_WB.p - expected.bodies[i].X_WB.p).norm(), 1e-8) << "body " << i;
}

// A step in time makes the arc-length problem grow like exp(gamma), gamma up to 438 here.
TEST_P(EveryMethodMoving, ReleasesAThinRodAtEveryStep) {
  const auto tip_after = [&](double step, double time) {
    Scene scene;
    scene.rods.push_back(steel_rod(0.4, 0.25e-3));
    add_load(scene, 1, {-1.0 / 256, 0, 0}, Vec3::Zero(), true);
    scene.solver.method = GetParam();
    scene.solver.order = 12;
    scene.solver.points = 12;
    scene.solver.step = step;
    scene.simulation.mode = Mode::kDynamic;
    scene.simulation.initial_static = true;
    scene.simulation.duration = time;
    return tip_of(end_of(scene));
  };
  EXPECT_LT((tip_after(1e-3, 0.01) - tip_after(1e-4, 0.01)).norm(), 2e-4);
  EXPECT_LT((tip_after(1e-6, 1e-4) - tip_after(1e-5, 1e-4)).norm(), 1e-7);
}

}  // namespace
}  // namespace cprsim
