// SPDX-License-Identifier: BSD-3-Clause
// Equilibria by every method: closed forms, a solution that shares no code, symmetries, each other.
#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/support/elastica.h"
#include "tests/support/methods.h"
#include "tests/support/reference_arc.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4;

Scene cantilever(double radius = 1e-3) {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, radius));
  return scene;
}

/// Force that bends a rod like P L² / EI = `load`.
double force_of_load(const RodSpec& rod, double load) {
  return load * bending_stiffness(rod) / (rod.length * rod.length);
}

class EveryMethod : public ::testing::TestWithParam<Method> {
 protected:
  Scene fine(const Scene& scene) const { return finely(scene, GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod, ::testing::ValuesIn(kEveryMethod), test_name);

TEST_P(EveryMethod, RollsACantileverUpToACircle) {
  Scene scene = fine(cantilever());
  const double M = 2 * std::numbers::pi * bending_stiffness(scene.rods[0]) / kLength;
  add_load(scene, 1, Vec3::Zero(), {0, M, 0});
  const Equilibrium equilibrium(scene);
  ASSERT_TRUE(equilibrium.report.converged());
  const RodSample rod = equilibrium.rod();
  EXPECT_LT((rod.points.back().rotation - Mat3::Identity()).norm(), 1e-11);
  const double r = kLength / (2 * std::numbers::pi);
  for (const RodPoint& point : rod.points) {
    const double phi = 2 * std::numbers::pi * point.s;
    const Vec3 expected(r * (1 - std::cos(phi)), 0, r * std::sin(phi));
    EXPECT_LT((point.position - expected).norm(), 1e-10 * kLength) << "at s = " << point.s;
    EXPECT_LT((point.curvature - Vec3(0, 1 / r, 0)).norm() * r, 1e-11);
  }
}

TEST_P(EveryMethod, MeetsTheElastica) {
  for (double load : {0.1, 1., 5., 10.}) {
    Scene scene = fine(cantilever());
    add_load(scene, 1, {force_of_load(scene.rods[0], load), 0, 0});
    const Equilibrium equilibrium(scene);
    ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
    const Elastica exact = solve_elastica(load);
    const RodSample rod = equilibrium.rod();
    EXPECT_LT((rod.points.back().position / kLength - Vec3(exact.x, 0, exact.z)).norm(), 1e-9)
        << "load " << load;
    EXPECT_NEAR(rod.points.front().moment.y() * kLength / bending_stiffness(scene.rods[0]),
                exact.clamp_moment, 1e-8)
        << "load " << load;
  }
}

// Everything at once, out of plane, with the base wrench found here handed to CVODE.
TEST_P(EveryMethod, AgreesWithCvode) {
  Scene scene = fine(cantilever());
  RodSpec& spec = scene.rods[0];
  spec.section.shape = SectionShape::kRectangle;
  spec.section.size = {2e-3, 1e-3};
  spec.rest_curvature = {1.5, -2, 3};
  switch_on(scene, {Effect::kGravity, Effect::kShear, Effect::kExtension});
  scene.gravity = {3, -4, -9};
  add_load(scene, 1, {0.4, 0.3, -0.2}, {0.02, -0.03, 0.01});
  const Equilibrium equilibrium(scene);
  ASSERT_TRUE(equilibrium.report.converged());
  const SectionProperties section = section_properties(spec);
  ReferenceRod reference;
  reference.length = kLength;
  reference.C_bt = section.K_bt.cwiseInverse().asDiagonal();
  reference.C_se = section.K_se.cwiseInverse().asDiagonal();
  reference.u_ref = spec.rest_curvature;
  reference.f = section.rhoA * scene.gravity;
  const RodSample rod = equilibrium.rod();
  ReferenceSection base;
  base.n = rod.points.front().force;
  base.m = rod.points.front().moment;
  const ReferenceSection end = integrate_reference_arc(reference, base);
  EXPECT_LT((end.X_WS.p - rod.points.back().position).norm(), 1e-9 * kLength);
  EXPECT_LT((end.X_WS.R - rod.points.back().rotation).norm(), 1e-8);
  EXPECT_LT((end.n - rod.points.back().force - scene.loads[0].force).norm(), 1e-9);
}

TEST_P(EveryMethod, FindsThePublishedStewartGoughRobot) {
  const Scene scene = fine(stewart_gough(
      {0.3973263874, 0.3973263874, 0.3997201023, 0.4216240113, 0.4216240113, 0.3997201023}, false));
  const Equilibrium equilibrium(scene, 1e-10);
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  const RigidBody& plate = equilibrium.robot.bodies[0];
  EXPECT_LT((plate.p - Vec3(0, 0, 0.4)).norm(), 1e-8);  // lengths are given to 1e-10 m
  EXPECT_LT((log_so3(plate.R) - Vec3(0, 10 * std::numbers::pi / 180, 0)).norm(), 1e-7);
  EXPECT_LT((equilibrium.rod().points.front().force - Vec3(-1.502392, -0.879075, -4.495003))
                .cwiseAbs()
                .maxCoeff(),
            1e-4);
}

TEST_P(EveryMethod, DoesNotCareWhereTheWorldIs) {
  Scene scene = fine(stewart_gough({0.40, 0.41, 0.42, 0.40, 0.39, 0.41}, true));
  const Pose X{exp_so3({0.7, -1.1, 0.4}), {3, -2, 5}};
  Scene moved = scene;
  moved.gravity = X.R * scene.gravity;
  for (BodySpec& body : moved.bodies)
    body.X_WB = X * body.X_WB;
  for (RodSpec& rod : moved.rods)
    rod.base.at.X_BF = X * rod.base.at.X_BF;
  const Equilibrium here(scene), there(moved);
  ASSERT_TRUE(here.report.converged());
  ASSERT_TRUE(there.report.converged());
  EXPECT_LT((X * here.robot.bodies[0].p - there.robot.bodies[0].p).norm(), 1e-11);
  EXPECT_LT((X.R * here.robot.bodies[0].R - there.robot.bodies[0].R).norm(), 1e-10);
  const RodSample a = here.rod(3), b = there.rod(3);
  EXPECT_LT((X.R * a.points.front().moment - b.points.front().moment).norm(), 1e-9);
}

// A rod and the same rod told from the other end, turned half around x: what was s is 1 - s.
TEST_P(EveryMethod, DoesNotCareWhichEndIsTheBase) {
  const Pose bottom{exp_so3({0.2, -0.1, 0.3}), {0.01, 0.02, 0}},
      top{exp_so3({0.5, 0.3, -0.4}), {0.12, -0.05, 0.33}};
  const Pose around{exp_so3({std::numbers::pi, 0, 0}), Vec3::Zero()};
  Scene scene = fine(cantilever());
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear});
  scene.gravity = {4, -5, -3};
  scene.rods[0].base.at = {kWorld, bottom};
  scene.rods[0].tip = scene.rods[0].base;
  scene.rods[0].tip.at = {kWorld, top};
  add_load(scene, 0.3, {0.2, 0.5, -0.3});
  Scene exchanged = scene;
  exchanged.rods[0].base.at = {kWorld, top * around};
  exchanged.rods[0].tip.at = {kWorld, bottom * around};
  exchanged.loads[0].rod_s = 0.7;
  const Equilibrium forth(scene), back(exchanged);
  ASSERT_TRUE(forth.report.converged());
  ASSERT_TRUE(back.report.converged());
  const RodSample a = forth.rod(), b = back.rod();
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t k = 0; k < a.points.size(); ++k) {
    const RodPoint &p = a.points[k], &q = b.points[a.points.size() - 1 - k];
    EXPECT_NEAR(p.s, 1 - q.s, 1e-12);
    EXPECT_LT((p.position - q.position).norm(), 1e-9 * kLength) << "s = " << p.s;
    EXPECT_LT((p.rotation - q.rotation * around.R).norm(), 1e-8) << "s = " << p.s;
  }
}

// Thick to hair-thin: the same number of unknowns serves all, whatever extension and shear weigh.
TEST_P(EveryMethod, DoesNotLock) {
  for (double slenderness : {20., 200., 2000., 20000.}) {
    Scene scene = cantilever(kLength / slenderness);
    switch_on(scene, {Effect::kExtension, Effect::kShear});
    add_load(scene, 1, {force_of_load(scene.rods[0], 5), 0, 0});
    const Equilibrium reference(finely(scene, Method::kShooting)), found(fine(scene));
    ASSERT_TRUE(found.report.converged()) << slenderness << ": " << found.report.worst_row;
    const Vec3 tip = found.rod().points.back().position;
    EXPECT_LT((tip - reference.rod().points.back().position).norm(), 2e-9 * kLength) << slenderness;
    const Elastica thin = solve_elastica(5);
    if (slenderness >= 20000) {
      EXPECT_LT((tip / kLength - Vec3(thin.x, 0, thin.z)).norm(), 1e-8);
    }
  }
}

TEST_P(EveryMethod, HoldsTheSameEnergy) {
  Scene scene = stewart_gough({0.40, 0.41, 0.42, 0.40, 0.39, 0.41}, true);
  const auto energy = [](const Equilibrium& e) {
    RodEnergy sum;
    for (const RobotRod& rod : e.robot.rods) {
      const RodEnergy own = rod.model->energy();
      sum.elastic += own.elastic;
      sum.gravity += own.gravity;
      sum.feed_power += own.feed_power;
    }
    return sum;
  };
  const RodEnergy a = energy(Equilibrium(finely(scene, Method::kShooting))),
                  b = energy(Equilibrium(fine(scene)));
  EXPECT_NEAR(a.elastic, b.elastic, 1e-8 * a.elastic);
  EXPECT_NEAR(a.gravity, b.gravity, 1e-8 * a.gravity);
  EXPECT_NEAR(a.feed_power, b.feed_power, 1e-4 * std::abs(a.feed_power));  // local strains
}

}  // namespace
}  // namespace cprsim
