// SPDX-License-Identifier: BSD-3-Clause
// Tendons along rods that are fed through their base: they keep the same fractions of the length,
// so that a rod of another length has all of them as if it had been built with it.
#include <gtest/gtest.h>

#include "tests/support/end_of.h"
#include "tests/support/methods.h"
#include "tests/support/tendons.h"

namespace cprsim {
namespace {

constexpr double kShort = 0.4, kLong = 0.55, kRadius = 1e-3, kOffset = 0.012;

Scene rod_of(double length, Method method) {
  Scene scene;
  scene.rods.push_back(steel_rod(length, kRadius));
  scene.gravity.setZero();
  scene = finely(scene, method);
  if (method == Method::kCollocation) scene.solver.elements = 12;
  return scene;
}

/// From one length to another, and the term of its drive.
ProfileTerm& feed(Scene& scene, double from, double to, double end) {
  DriveSpec drive;
  drive.quantity = DriveQuantity::kLength;
  drive.rod = 0;
  ProfileTerm ramp;
  ramp.shape = ShapeOfTime::kSmoothstep;
  ramp.from = from;
  ramp.to = to;
  ramp.end = end;
  drive.profile.terms.push_back(ramp);
  scene.drives.push_back(drive);
  return scene.drives.back().profile.terms[0];
}

Vec3 tip_of(const Equilibrium& equilibrium) {
  return equilibrium.rod().points.back().position;
}

TendonSample tendon_of(const Equilibrium& equilibrium, std::size_t k = 0) {
  return equilibrium.robot.rods[0].model->tendons()[k];
}

/// Fed from 0.4 m, where it is in equilibrium, too.
Scene fed_to(Scene scene, double length) {
  scene.rods[0].length = kShort;
  feed(scene, kShort, length, 1);
  return scene;
}

struct FedEquilibrium : Equilibrium {
  explicit FedEquilibrium(const Scene& scene, double tolerance) : Equilibrium(scene, tolerance) {
    EXPECT_TRUE(report.converged()) << report.worst_row;
    equations.set_instant(1, true, StageRates{});
    equations.mark_start();
    SolveOptions options;
    options.tolerance = tolerance;
    options.max_iterations = 60;
    report = solve_statics(equations, options);
  }
};

class FedTendons : public ::testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Every, FedTendons, ::testing::ValuesIn(kEveryMethod), test_name);

// The curvature T r / EI of a parallel tendon does not know the length; what is pulled in does.
TEST_P(FedTendons, BendARodIntoACircleAtEveryLength) {
  for (const double length : {0.3, kShort, kLong}) {
    Scene scene = fed_to(rod_of(length, GetParam()), length);
    const double EI = bending_stiffness(scene.rods[0]), T = 20, k = T * kOffset / EI;
    add_tendon(scene, kOffset, 0, T);
    const FedEquilibrium found(scene, 1e-13);
    ASSERT_TRUE(found.report.converged()) << found.report.worst_row;
    const Vec3 expected((1 - std::cos(k * length)) / k, 0, std::sin(k * length) / k);
    EXPECT_LT((tip_of(found) - expected).norm(), 1e-10);
    EXPECT_NEAR(tendon_of(found).displacement, k * kOffset * length, 1e-12);
  }
}

/// Four tendons of every kind in weight: beside each other, wound, with bends, to a place before
/// the tip.
void add_all(Scene& scene, bool rubs) {
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear});
  scene.gravity = {3, -2, -9};
  add_tendon(scene, kOffset, 0.3, 12, 0.6);
  add_tendon(scene, kOffset, 2.4, 9).termination = 0.7;
  TendonSpec& bent = add_tendon(scene, 0, 0, 6);
  bent.route = TendonRoute::kPoints;
  bent.points = {{0, 0.012, 0}, {0.45, 0.004, 0.006}, {1, -0.002, 0.01}};
  add_tendon(scene, kOffset, -1.5, 0, -0.4);
  displace(scene, 1.5e-3);
  if (!rubs) return;
  switch_on(scene, {Effect::kTendonFriction});
  for (TendonSpec& tendon : scene.tendons)
    tendon.friction = 0.2;
}

// In statics nothing tells a rod that was fed from one that was built with its length, in space
// and, where tendons lie in it, in a plane.
TEST_P(FedTendons, AreThoseOfARodBuiltWithItsLength) {
  for (const bool rubs : {false, true})
    for (const bool planar : {false, true}) {
      Scene built = rod_of(kLong, GetParam());
      if (planar) {
        switch_on(built, {Effect::kGravity, Effect::kExtension, Effect::kTendonFriction});
        built.gravity = {3, 0, -9};
        built.planar_normal = Vec3::UnitY();
        add_tendon(built, kOffset, 0, 11).friction = rubs ? 0.2 : 0;
        add_tendon(built, kOffset, std::numbers::pi, 0);
        displace(built, -4e-3);
      } else {
        add_all(built, rubs);
      }
      const Equilibrium a(built, 1e-12);
      const FedEquilibrium b(fed_to(built, kLong), 1e-12);
      ASSERT_TRUE(a.report.converged() && b.report.converged()) << b.report.worst_row;
      EXPECT_LT((tip_of(a) - tip_of(b)).norm(), 1e-9 * kLong);
      EXPECT_GT((tip_of(a) - Vec3(0, 0, kLong)).norm(), 0.05 * kLong);
      for (std::size_t k = 0; k < built.tendons.size(); ++k) {
        EXPECT_NEAR(tendon_of(a, k).tension, tendon_of(b, k).tension, 1e-6);
        EXPECT_NEAR(tendon_of(a, k).end_tension, tendon_of(b, k).end_tension, 1e-6);
        EXPECT_NEAR(tendon_of(a, k).displacement, tendon_of(b, k).displacement, 1e-10);
      }
      EXPECT_GT(tendon_of(b, built.tendons.size() - 1).tension, 0.1);
    }
}

// Slowly: quasi-statics ends where statics is.
TEST_P(FedTendons, EndInQuasiStaticsWhereStaticsIs) {
  Scene built = rod_of(kLong, GetParam());
  add_all(built, false);
  Scene fed = built;
  fed.rods[0].length = kShort;
  feed(fed, kShort, kLong, 1);
  fed.simulation.mode = Mode::kQuasistatic;
  fed.simulation.duration = 1;
  fed.solver.step = 0.05;
  Simulation simulation(fed);
  const Snapshot end = run_to_end(simulation);
  ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_LT((end.rods[0].points.back().position - tip_of(Equilibrium(built, 1e-12))).norm(),
            1e-8 * kLong);
}

/// Cut coarsely: books close whatever a rod is cut into.
double imbalance(Scene scene, double step) {
  scene.solver.points = 16;
  scene.solver.degree = 6;
  if (scene.solver.method == Method::kCollocation) scene.solver.elements = 6;
  scene.solver.step = step;
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  const EnergySample& energy = end.energy;
  return std::abs(energy.balance) /
         (std::abs(energy.work) + energy.dissipated + std::abs(energy.total));
}

// The books close: what the feed brings in, what motors pull in and pay out, what friction takes.
TEST_P(FedTendons, KeepTheBooksWhileTheRodIsFedSlowly) {
  for (const bool rubs : {false, true}) {
    Scene scene = rod_of(kShort, GetParam());
    add_all(scene, rubs);
    feed(scene, kShort, kLong, 1);
    ProfileTerm& pull = scene.drives[0].profile.terms[0];
    pull.shape = ShapeOfTime::kSmoothstep;
    pull.from = 12;
    pull.to = 5;
    pull.end = 1;
    scene.simulation.mode = Mode::kQuasistatic;
    scene.simulation.duration = 1;
    const double coarse = imbalance(scene, 0.05), fine = imbalance(scene, 0.025);
    std::printf("%s: %.1e, %.1e\n", rubs ? "rubs" : "slides", coarse, fine);
    EXPECT_LT(fine, rubs ? 2e-3 : 2e-4);
    EXPECT_GT(std::log2(coarse / fine), rubs ? 0.8 : 1.7);
  }
}

TEST_P(FedTendons, KeepTheBooksInMotion) {
  for (const bool planar : {false, true}) {
    Scene scene = rod_of(kShort, GetParam());
    switch_on(scene, {Effect::kGravity, Effect::kDamping, Effect::kExtension, Effect::kShear,
                      Effect::kRotaryInertia});
    scene.gravity = {-2, 0, -9.81};
    damp(scene.rods[0], 2e-3);
    add_tendon(scene, kOffset, 0, 12, planar ? 0 : 0.4);
    add_tendon(scene, kOffset, std::numbers::pi, 0).termination = 0.8;
    displace(scene, -2e-3);
    feed(scene, kShort, 1.1 * kShort, 0.08);
    if (planar) scene.planar_normal = Vec3::UnitY();
    scene.simulation.mode = Mode::kDynamic;
    scene.simulation.initial_static = true;
    scene.simulation.duration = 0.1;
    scene.solver.scheme = SchemeKind::kGeneralizedAlpha;
    const double coarse = imbalance(scene, 2e-3), fine = imbalance(scene, 1e-3);
    std::printf("%s: %.1e, %.1e\n", planar ? "planar" : "spatial", coarse, fine);
    EXPECT_LT(fine, 1e-3);
    EXPECT_GT(std::log2(coarse / fine), 1.5);
  }
}

// A load at a fraction of the length goes on with its section, disks, magnets, loads along a rod
// and thickness that varies likewise: what the feed brings in closes the books with each of them.
TEST_P(FedTendons, LeaveTheFeedToWhateverElseARodHas) {
  const auto run = [](const std::function<void(Scene&)>& add, double order = 1.7,
                      double most = 2e-4) {
    Scene scene = rod_of(kShort, GetParam());
    switch_on(scene, {Effect::kGravity});
    scene.gravity = {-2, 1, -9.81};
    add(scene);
    feed(scene, kShort, kLong, 1);
    scene.simulation.mode = Mode::kQuasistatic;
    scene.simulation.duration = 1;
    const double coarse = imbalance(scene, 0.05), fine = imbalance(scene, 0.025);
    std::printf("%.1e, %.1e\n", coarse, fine);
    EXPECT_LT(fine, most);
    EXPECT_GT(std::log2(coarse / fine), order);
  };
  run([](Scene& scene) { add_load(scene, 0.5, {0.6, 0, 0.2}, {0, 0.02, 0.01}).follower = true; });
  run([](Scene& scene) { scene.rods[0].disks = {{0.5, 0.01, 0.01}, {1, 0.01, 0.01}}; });
  run(
      [](Scene& scene) {
        LoadSpec& load = add_load(scene, 0.2, {1.5, 0, 0.3});
        load.to = 0.9;
        load.follower = true;
      },
      -HUGE_VAL, 5e-4);  // as exact as what lies between nodes
  run(
      [](Scene& scene) {
        switch_on(scene, {Effect::kDrag});
        scene.wind = {3, 1, 1};
        DragSpec water;
        water.normal = 1;
        water.tangential = 0.02;
        water.fluid_density = 100;
        scene.rods[0].drag = water;
      },
      -HUGE_VAL, 2e-3);
  run([](Scene& scene) {
    switch_on(scene, {Effect::kMagnetic});
    scene.rods[0].magnets.push_back({0.3, 1, {0.3, 0, 1}});
    MagneticFieldSpec field;
    field.uniform = {0.2, 0, 0};
    scene.magnetic_fields = {field};
  });
  run([](Scene& scene) {
    SectionSpec thick = scene.rods[0].section, thin = thick;
    thin.s = 1;
    thin.size *= 0.7;
    scene.rods[0].sections = {thick, thin};
  });
}

}  // namespace
}  // namespace cprsim
