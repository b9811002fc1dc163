// SPDX-License-Identifier: BSD-3-Clause
// Rods whose sections or rest curvature vary along them, by every method, against closed forms,
// quadrature, CVODE and Ritz's method.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "engine/section/along.h"
#include "engine/study/modes.h"
#include "tests/support/methods.h"
#include "tests/support/reference_arc.h"
#include "tests/support/robots.h"
#include "tests/support/tendons.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.4;

SectionSpec circle(double s, double radius) {
  SectionSpec section;
  section.size = {radius, 0};
  section.s = s;
  return section;
}

Scene with_sections(const std::vector<SectionSpec>& sections) {
  Scene scene;
  RodSpec rod = steel_rod(kLength, 1e-3);
  rod.sections = sections;
  rod.section = sections.front();
  scene.rods.push_back(rod);
  return scene;
}

Scene tapered() {
  return with_sections({circle(0, 1.2e-3), circle(1, 0.6e-3)});
}

Scene stepped() {
  return with_sections(
      {circle(0, 1.2e-3), circle(0.5, 1.2e-3), circle(0.5, 0.8e-3), circle(1, 0.8e-3)});
}

double bending_stiffness_of(double radius) {
  return 200e9 * std::numbers::pi / 4 * std::pow(radius, 4);
}

template <class Function>
double integral(double from, double to, Function f) {
  constexpr int kPieces = 2000;  // Simpson's rule
  const double h = (to - from) / kPieces;
  double sum = 0;
  for (int k = 0; k < kPieces; ++k)
    sum += h / 6 * (f(from + k * h) + 4 * f(from + (k + 0.5) * h) + f(from + (k + 1) * h));
  return sum;
}

class VaryingRod : public ::testing::TestWithParam<Method> {
 public:
  double accuracy() const { return GetParam() == Method::kShooting ? 1e-10 : 2e-9; }
};

INSTANTIATE_TEST_SUITE_P(Every, VaryingRod, ::testing::ValuesIn(kEveryMethod), test_name);

Vec3 tip_of(const Scene& scene, Method method) {
  const Equilibrium equilibrium(finely(scene, method));
  EXPECT_TRUE(equilibrium.report.converged());
  return equilibrium.rod().points.back().position;
}

// Curvature that grows with s: Cornu's spiral, whose end Fresnel's integrals give.
TEST_P(VaryingRod, AtRestFollowsAClothoid) {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, 1e-3));
  constexpr double kEnd = 20;
  for (double s : {0., 0.25, 0.7, 1.})
    scene.rods[0].rest_samples.push_back({s, {0, kEnd * s, 0}});
  const auto angle = [](double s) { return kEnd * s * s / (2 * kLength); };
  const double x = integral(0, kLength, [&](double s) { return std::sin(angle(s)); }),
               z = integral(0, kLength, [&](double s) { return std::cos(angle(s)); });
  EXPECT_LT((tip_of(scene, GetParam()) - Vec3(x, 0, z)).norm(), accuracy() * kLength);
}

// The moment T r of a parallel tendon bends each section by its own T r / EI.
TEST_P(VaryingRod, BendsUnderATendonByItsOwnStiffness) {
  Scene scene = tapered();
  constexpr double kTension = 2, kOffset = 0.01;
  add_tendon(scene, kOffset, std::numbers::pi / 2, kTension);
  const auto turned = [&](double to) {
    return integral(0, to, [&](double s) {
      return kTension * kOffset / bending_stiffness_of(1.2e-3 - 0.6e-3 * s / kLength);
    });
  };
  const double y = integral(0, kLength, [&](double s) { return std::sin(turned(s)); }),
               z = integral(0, kLength, [&](double s) { return std::cos(turned(s)); });
  EXPECT_LT((tip_of(scene, GetParam()) - Vec3(0, y, z)).norm(), 5 * accuracy() * kLength);
}

// Lengths of tendons are counted from the unloaded shape, whatever it is.
TEST_P(VaryingRod, WithATendonPulledInByNothingIsUnloaded) {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, 1e-3));
  for (double s : {0., 0.25, 0.7, 1.})
    scene.rods[0].rest_samples.push_back({s, {3, 20 * s, -4}});
  const Vec3 unloaded = tip_of(scene, GetParam());
  add_tendon(scene, 0.01, 0.3, 0);
  displace(scene, 0);
  EXPECT_LT((tip_of(scene, GetParam()) - unloaded).norm(), 1e-10 * kLength);
  displace(scene, 1e-3);
  const Equilibrium pulled(finely(scene, GetParam()));
  ASSERT_TRUE(pulled.report.converged());
  EXPECT_GT(pulled.robot.rods[0].model->tendons()[0].tension, 0);
  EXPECT_NEAR(pulled.robot.rods[0].model->tendons()[0].displacement, 1e-3, 1e-10);
}

TEST_P(VaryingRod, TwistAndLoadOnAVaryingRestShapeAgreeWithCvode) {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, 1e-3));
  const Vec3 first(2, -3, 5), slope(4, 6, -12);
  scene.rods[0].rest_samples = {{0, first}, {0.4, first + 0.4 * slope}, {1, first + slope}};
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear});
  scene.gravity = {3, -4, -9};
  add_load(scene, 1, {0.4, 0.3, -0.2}, {0.02, -0.03, 0.01});
  const Equilibrium equilibrium(finely(scene, GetParam()));
  ASSERT_TRUE(equilibrium.report.converged());
  const RodSample rod = equilibrium.rod();
  const SectionProperties section = section_properties(scene.rods[0]);
  ReferenceRod reference;
  reference.length = kLength;
  reference.C_bt = section.K_bt.cwiseInverse().asDiagonal();
  reference.C_se = section.K_se.cwiseInverse().asDiagonal();
  reference.f = section.rhoA * scene.gravity;
  reference.vary = [=](double s, const Mat3&, ReferenceRod& here) {
    here.u_ref = first + s / kLength * slope;
  };
  ReferenceSection base;
  base.n = rod.points.front().force;
  base.m = rod.points.front().moment;
  const ReferenceSection end = integrate_reference_arc(reference, base, 1, 1e-13);
  EXPECT_LT((end.X_WS.p - rod.points.back().position).norm(), accuracy() * kLength);
  EXPECT_LT((end.X_WS.R - rod.points.back().rotation).norm(), 20 * accuracy());
}

TEST_P(VaryingRod, ATaperedCantileverUnderLoadAndWeightAgreesWithCvode) {
  Scene scene = tapered();
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear});
  scene.gravity = {3, -4, -9};
  add_load(scene, 1, {1.5, 1, -0.5}, {0.05, -0.1, 0.05});
  const Equilibrium equilibrium(finely(scene, GetParam()));
  ASSERT_TRUE(equilibrium.report.converged());
  const RodSample rod = equilibrium.rod();
  ReferenceRod reference;
  reference.length = kLength;
  reference.vary = [=](double s, const Mat3&, ReferenceRod& here) {
    const double r = 1.2e-3 - 0.6e-3 * s / kLength, A = std::numbers::pi * r * r, I = A * r * r / 4;
    here.C_bt = Vec3(1 / (200e9 * I), 1 / (200e9 * I), 1 / (160e9 * I)).asDiagonal();
    here.C_se = Vec3(1 / (80e9 * A), 1 / (80e9 * A), 1 / (200e9 * A)).asDiagonal();
    here.f = 8000 * A * scene.gravity;
  };
  ReferenceSection base;
  base.n = rod.points.front().force;
  base.m = rod.points.front().moment;
  const ReferenceSection end = integrate_reference_arc(reference, base, 1, 1e-13);
  EXPECT_GT(rod.points.back().position.head<2>().norm(), 0.1);
  EXPECT_LT((end.X_WS.p - rod.points.back().position).norm(), 10 * accuracy() * kLength);
  EXPECT_LT((end.n - scene.loads[0].force).norm(), 1e-6);
}

TEST_P(VaryingRod, SmallDeflectionsAreThoseOfBeams) {
  constexpr double P = 1e-4;
  for (const bool steps : {false, true}) {
    Scene scene = steps ? stepped() : tapered();
    add_load(scene, 1, {P, 0, 0});
    const auto share = [&](double s) {
      const double r =
          steps ? (s < 0.5 * kLength ? 1.2e-3 : 0.8e-3) : 1.2e-3 - 0.6e-3 * s / kLength;
      return P * (kLength - s) * (kLength - s) / bending_stiffness_of(r);
    };
    const double half = kLength / 2;
    const double sag =
        steps ? P / 3 *
                    ((std::pow(kLength, 3) - std::pow(half, 3)) / bending_stiffness_of(1.2e-3) +
                     std::pow(half, 3) / bending_stiffness_of(0.8e-3))
              : integral(0, kLength, share);
    EXPECT_NEAR(tip_of(scene, GetParam()).x() / sag, 1, 1e-6) << steps;
  }
}

/// The first frequency of a clamped beam, rad/s, by Ritz's method with (s / L)^2 .. (s / L)^11.
double ritz_frequency(const RodSpec& rod) {
  constexpr int kFunctions = 10;
  const SectionsAlong along(rod, false);
  MatX K(kFunctions, kFunctions), M(kFunctions, kFunctions);
  for (int i = 0; i < kFunctions; ++i)
    for (int j = 0; j < kFunctions; ++j) {
      const double a = i + 2, b = j + 2;
      const auto over = [&](double from, double to, auto f) {
        return integral(from, to, [&](double x) { return f(x, along.at(x, 0.5 * (from + to))); });
      };
      K(i, j) = M(i, j) = 0;
      for (double from : {0., 0.5}) {
        K(i, j) += over(from, from + 0.5, [&](double x, const SectionProperties& s) {
          return s.K_bt.x() * a * (a - 1) * b * (b - 1) * std::pow(x, a + b - 4);
        });
        M(i, j) += over(from, from + 0.5, [&](double x, const SectionProperties& s) {
          return s.rhoA * std::pow(x, a + b);
        });
      }
    }
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatX> solver(K / std::pow(kLength, 3),
                                                              M * kLength);
  return std::sqrt(solver.eigenvalues()[0]);
}

TEST_P(VaryingRod, SwingsAtTheFrequencyOfTheBeam) {
  Scene scene = finely(tapered(), GetParam());
  if (GetParam() == Method::kShooting) scene.solver.points = 16;
  StaticStudy study(scene);
  ASSERT_TRUE(study.solve().converged());
  EXPECT_NEAR(std::sqrt(natural_modes(study, 2)[0].omega_squared) / ritz_frequency(scene.rods[0]),
              1, 1e-5);
}

Scene released(Method method) {
  Scene scene = finely(tapered(), method);
  if (method == Method::kShooting) scene.solver.points = 10;
  if (method == Method::kCollocation) scene.solver.elements = 8;
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear, Effect::kRotaryInertia,
                    Effect::kDamping, Effect::kDrag});
  damp(scene.rods[0], 1e-3);
  scene.rods[0].drag = DragSpec{0.5, 0.02, 1000, 1, {}};
  scene.rods[0].rest_samples = {{0, {0, 0, 0}}, {0.5, {0.5, 0, 1}}, {1, {1, 0, 2}}};
  add_load(scene, 1, {-0.2, 0, 0}, Vec3::Zero(), true);
  scene.solver.scheme = SchemeKind::kEsdirk43;
  scene.solver.step = 1e-3;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.05;
  return scene;
}

TEST(VaryingRods, MethodsAgreeInMotionAndCloseTheBalance) {
  std::vector<Vec3> tips;
  for (Method method : kEveryMethod) {
    Simulation simulation(released(method));
    const Snapshot end = run_to_end(simulation);
    ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
    tips.push_back(end.rods[0].points.back().position);
    EXPECT_LT(std::abs(end.energy.balance), 1e-3 * end.energy.dissipated) << method_name(method);
  }
  EXPECT_LT((tips[1] - tips[0]).norm(), 1e-6 * kLength);
  EXPECT_LT((tips[2] - tips[0]).norm(), 1e-6 * kLength);
}

TEST(SectionsAlong, AreLinearWithSteps) {
  const SectionsAlong taper(tapered().rods[0], false);
  EXPECT_NEAR(taper.at(0.5, 0.5).K_bt.x(), bending_stiffness_of(0.9e-3), 1e-12);
  EXPECT_TRUE(taper.breaks().empty());
  const SectionsAlong step(stepped().rods[0], false);
  EXPECT_EQ(step.breaks(), std::vector<double>{0.5});
  EXPECT_NEAR(step.at(0.5, 0.4).K_bt.x(), bending_stiffness_of(1.2e-3), 1e-12);
  EXPECT_NEAR(step.at(0.5, 0.6).K_bt.x(), bending_stiffness_of(0.8e-3), 1e-12);
}

}  // namespace
}  // namespace cprsim
