// SPDX-License-Identifier: BSD-3-Clause
// Rods that are bent or wound up without load: shape, straightening, energy, time.
#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4;

Scene precurved(const Vec3& u_rest, int cells = 60) {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, 1e-3));
  scene.rods[0].rest_curvature = u_rest;
  scene.solver.points = cells;
  return scene;
}

Vec3 stiffness(const RodSpec& rod) {
  return section_properties(rod).K_bt;
}

TEST(PrecurvedRod, IsACircleWithoutLoad) {
  const double k = 1.7 * std::numbers::pi / kLength;
  const Equilibrium equilibrium(precurved({0, k, 0}));
  ASSERT_TRUE(equilibrium.report.converged());
  EXPECT_EQ(equilibrium.report.iterations, 0);  // it starts in its unloaded shape
  for (const RodPoint& point : equilibrium.rod().points) {
    const double phi = k * point.s * kLength;
    const Vec3 expected((1 - std::cos(phi)) / k, 0, std::sin(phi) / k);
    EXPECT_LT((point.position - expected).norm(), 1e-12 * kLength) << "at s = " << point.s;
    EXPECT_LT(point.moment.norm() * kLength / bending_stiffness(steel_rod(kLength, 1e-3)), 1e-12);
  }
  EXPECT_LT(equilibrium.robot.rods[0].model->energy().elastic, 1e-20);
}

// Curvature k, torsion t: a helix of radius k / (k2 + t2) about the axis (0, k, t) through
// (radius, 0, 0), climbing t / (k2 + t2) per radian.
TEST(PrecurvedRod, IsAHelixWithoutLoad) {
  const double k = 14, t = 9, w = std::hypot(k, t), radius = k / (w * w);
  const Equilibrium equilibrium(precurved({0, k, t}));
  ASSERT_TRUE(equilibrium.report.converged());
  const Vec3 axis = Vec3(0, k, t) / w, out(-1, 0, 0), around = axis.cross(out);
  for (const RodPoint& point : equilibrium.rod().points) {
    const double s = point.s * kLength, phi = w * s;
    const Vec3 expected = Vec3(radius, 0, 0) +
                          radius * (std::cos(phi) * out + std::sin(phi) * around) +
                          t / w * s * axis;
    EXPECT_LT((point.position - expected).norm(), 1e-12 * kLength) << "at s = " << point.s;
  }
}

/// By how far the point of the axis beside the tip goes along it under a force F there, m.
double spring_travel(Method method, double k, double t, double F) {
  Scene scene = finely(precurved({0, k, t}, 150), method);
  if (method == Method::kShooting) scene.solver.points = 150;
  if (method == Method::kStrain) scene.solver.elements = 12;
  const double w = std::hypot(k, t), radius = k / (w * w), phi = w * kLength;
  const Vec3 axis = Vec3(0, k, t) / w, out(-1, 0, 0), around = axis.cross(out);
  const Vec3 arm = -radius * (std::cos(phi) * out + std::sin(phi) * around), force = F * axis;
  add_load(scene, 1, force, arm.cross(force));
  const Equilibrium found(scene, 1e-13), free(precurved({0, k, t}, 150), 1e-13);
  EXPECT_TRUE(found.report.converged()) << found.report.worst_row;
  const RodPoint now = found.rod().points.back(), then = free.rod().points.back();
  return axis.dot(now.position - then.position +
                  (now.rotation * then.rotation.transpose() - Mat3::Identity()) * arm);
}

class HelicalSpring : public ::testing::TestWithParam<Method> {};

// An axial force F has the moment F a about a wire wound at the radius a: F a cos(alpha) twists it,
// F a sin(alpha) bends it, alpha its pitch. Castigliano: F L a^2 (cos^2 / GJ + sin^2 / EI).
TEST_P(HelicalSpring, HasTheStiffnessOfItsWire) {
  const double k = 60, t = 25, w = std::hypot(k, t), a = k / (w * w), F = 1e-2;
  const Vec3 K = stiffness(steel_rod(kLength, 1e-3));
  const double cosine = k / w, sine = t / w,
               expected = F * kLength * a * a * (cosine * cosine / K.z() + sine * sine / K.x());
  ASSERT_GT(w * kLength, 4 * 2 * std::numbers::pi);  // turns
  const double travel =
      0.5 * (spring_travel(GetParam(), k, t, F) - spring_travel(GetParam(), k, t, -F));
  EXPECT_NEAR(travel / expected, 1, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Every, HelicalSpring, ::testing::ValuesIn(kEveryMethod), test_name);

// M = K (0 - u_rest) at its tip takes the bend out: straight, and L/2 u_rest K u_rest richer.
TEST(PrecurvedRod, IsStraightenedByTheMomentOfItsRestCurvature) {
  const Vec3 u_rest(2, -3, 1.5);
  Scene scene = precurved(u_rest, 10);
  const Vec3 K = stiffness(scene.rods[0]);
  add_load(scene, 1, Vec3::Zero(), -K.cwiseProduct(u_rest));
  const Equilibrium equilibrium(scene);
  ASSERT_TRUE(equilibrium.report.converged());
  for (const RodPoint& point : equilibrium.rod().points) {
    EXPECT_LT((point.position - Vec3(0, 0, point.s * kLength)).norm(), 1e-10 * kLength);
    EXPECT_LT(point.curvature.norm() * kLength, 1e-9);
  }
  const double expected = 0.5 * kLength * u_rest.dot(K.cwiseProduct(u_rest));
  EXPECT_NEAR(equilibrium.robot.rods[0].model->energy().elastic, expected, 1e-9 * expected);
}

// Bent to a circle of twice its rest curvature, the moment is that of the difference.
TEST(PrecurvedRod, AnswersToTheDifferenceFromItsRestCurvature) {
  const double k = 4;
  Scene scene = precurved({k, 0, 0}, 40);
  add_load(scene, 1, Vec3::Zero(), {bending_stiffness(scene.rods[0]) * k, 0, 0});
  const Equilibrium equilibrium(scene);
  ASSERT_TRUE(equilibrium.report.converged());
  const double phi = 2 * k * kLength;
  const Vec3 expected(0, -(1 - std::cos(phi)) / (2 * k), std::sin(phi) / (2 * k));
  EXPECT_LT((equilibrium.rod().points.back().position - expected).norm(), 1e-11 * kLength);
}

Scene dynamic(Scene scene, double step) {
  switch_on(scene, {Effect::kDamping, Effect::kExtension, Effect::kShear, Effect::kRotaryInertia});
  damp(scene.rods[0], 1e-3);
  scene.solver.scheme = SchemeKind::kGeneralizedAlpha;
  scene.solver.step = step;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.1;
  return scene;
}

TEST(PrecurvedRod, StaysWhereItIsBecauseDampingSeesRatesOnly) {
  const Scene scene = dynamic(precurved({0, 6, 3}, 8), 2e-3);
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  for (const RodPoint& point : end.rods[0].points)
    EXPECT_LT((point.curvature - Vec3(0, 6, 3)).norm() * kLength, 1e-8);
  EXPECT_LT(end.energy.total, 1e-12);
  EXPECT_LT(std::abs(end.energy.dissipated), 1e-12);
}

TEST(PrecurvedRod, KeepsTheEnergyBalanceWhenLetGo) {
  const auto balance = [](double step) {
    Scene scene = dynamic(precurved({0, 6, 3}, 8), step);
    add_load(scene, 1, {-0.3, 0.2, 0}, Vec3::Zero(), true);
    Simulation simulation(scene);
    const Snapshot end = run_to_end(simulation);
    EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    EXPECT_GT(end.energy.dissipated, 0);
    return std::abs(end.energy.balance) / end.energy.dissipated;
  };
  const double coarse = balance(1e-3), fine = balance(5e-4);
  EXPECT_LT(fine, 2e-3);
  EXPECT_GT(std::log2(coarse / fine), 1.7);
}

}  // namespace
}  // namespace cprsim
