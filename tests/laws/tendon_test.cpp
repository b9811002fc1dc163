// SPDX-License-Identifier: BSD-3-Clause
// Rods bent by tendons, against closed forms, against the equations of Rucker and Webster solved by
// a program of its own, and against what symmetry and energy demand.
#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "tests/support/end_of.h"
#include "tests/support/methods.h"
#include "tests/support/tendon_reference.h"
#include "tests/support/tendons.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.5, kRadius = 1e-3, kOffset = 0.01506;

Scene rod_with_tendons() {
  Scene scene;
  scene.rods.push_back(steel_rod(kLength, kRadius));
  scene.gravity.setZero();
  return scene;
}

Vec3 tip_of(const Equilibrium& equilibrium) {
  return equilibrium.rod().points.back().position;
}

class Tendons : public ::testing::TestWithParam<Method> {};

// A tendon parallel to the axis presses the rod with -T and bends it with T r, all along: total
// force and moment are zero. kappa = T r / EI, stretch 1 - T / EA, pulled in kappa r L + T L / EA.
TEST_P(Tendons, BendARodIntoACircle) {
  for (const bool extensible : {false, true}) {
    Scene scene = finely(rod_with_tendons(), GetParam());
    if (extensible) switch_on(scene, {Effect::kExtension, Effect::kShear});
    const double EI = bending_stiffness(scene.rods[0]),
                 EA = section_properties(scene.rods[0]).K_se.z(), T = 25, angle = 0.6;
    add_tendon(scene, kOffset, angle, T);
    const Equilibrium equilibrium(scene, 1e-13);
    ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
    const double k = T * kOffset / EI, v = extensible ? 1 - T / EA : 1;
    ASSERT_GT(k * kLength, 1);  // far from small angles
    for (const RodPoint& point : equilibrium.rod().points) {
      const double s = point.s * kLength, aside = v * (1 - std::cos(k * s)) / k;
      const Vec3 expected(aside * std::cos(angle), aside * std::sin(angle),
                          v * std::sin(k * s) / k);
      EXPECT_LT((point.position - expected).norm(), 1e-11 * kLength) << "at s = " << point.s;
      EXPECT_LT(point.force.norm(), 1e-10 * T);
      EXPECT_LT(point.moment.norm(), 1e-10 * T * kOffset);
    }
    const TendonSample tendon = equilibrium.robot.rods[0].model->tendons()[0];
    EXPECT_EQ(tendon.tension, T);
    EXPECT_NEAR(tendon.displacement, (k * kOffset + 1 - v) * kLength, 1e-11 * kLength);
  }
}

// Beyond the section to which it is fastened the rod is straight.
TEST_P(Tendons, BendARodOnlyAsFarAsTheyGo) {
  Scene scene = finely(rod_with_tendons(), GetParam());
  const double EI = bending_stiffness(scene.rods[0]), T = 40, end = 0.37;
  add_tendon(scene, kOffset, 0, T).termination = end;
  const Equilibrium equilibrium(scene, 1e-13);
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  const double k = T * kOffset / EI, turn = k * end * kLength, rest = (1 - end) * kLength;
  const Vec3 expected((1 - std::cos(turn)) / k + rest * std::sin(turn), 0,
                      std::sin(turn) / k + rest * std::cos(turn));
  EXPECT_LT((tip_of(equilibrium) - expected).norm(), 1e-10 * kLength);
}

// Two tendons a quarter turn apart are one between them at sqrt(2) times the distance, four equal
// ones press an inextensible rod and leave it straight.
TEST_P(Tendons, Superpose) {
  Scene two = finely(rod_with_tendons(), GetParam()), one = two, four = two;
  const double quarter = std::numbers::pi / 2;
  add_tendon(two, kOffset, 0, 20);
  add_tendon(two, kOffset, quarter, 20);
  add_tendon(one, std::sqrt(2) * kOffset, quarter / 2, 20);
  EXPECT_LT((tip_of(Equilibrium(two, 1e-13)) - tip_of(Equilibrium(one, 1e-13))).norm(),
            1e-10 * kLength);
  for (int k = 0; k < 4; ++k)
    add_tendon(four, kOffset, k * quarter, 20);
  EXPECT_LT((tip_of(Equilibrium(four, 1e-13)) - Vec3(0, 0, kLength)).norm(), 1e-10 * kLength);
}

// A twist c winds parallel tendons up, and their tension resists: M = GJ c + sum T c r^2 / sqrt(1 +
// c^2 r^2), whatever the angle.
TEST_P(Tendons, StiffenARodAgainstTwist) {
  Scene scene = finely(rod_with_tendons(), GetParam());
  for (int k = 0; k < 4; ++k)
    add_tendon(scene, kOffset, k * std::numbers::pi / 2, 200);
  const double GJ = section_properties(scene.rods[0]).K_bt.z(), c = 3 / kLength,
               wound = 800 * c * kOffset * kOffset / std::hypot(1, c * kOffset);
  ASSERT_GT(wound, 0.3 * GJ * c);
  add_load(scene, 1, Vec3::Zero(), {0, 0, GJ * c + wound});
  const Equilibrium equilibrium(scene, 1e-13);
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  const RodPoint tip = equilibrium.rod().points.back();
  EXPECT_LT((tip.position - Vec3(0, 0, kLength)).norm(), 1e-10 * kLength);
  EXPECT_LT((tip.rotation - exp_so3({0, 0, c * kLength})).norm(), 1e-9);
}

// What a given tension displaces, that displacement needs as tension: the same shape, in weight.
TEST_P(Tendons, PulledInByAGivenLengthFindTheirTension) {
  Scene given = finely(rod_with_tendons(), GetParam());
  switch_on(given, {Effect::kGravity, Effect::kExtension});
  given.gravity = {3, -2, -9};
  add_tendon(given, kOffset, 0.3, 12, 0.6);
  add_tendon(given, kOffset, 2.4, 18);
  Scene asked = given;
  const Equilibrium equilibrium(given, 1e-13);
  const std::vector<TendonSample> tendons = equilibrium.robot.rods[0].model->tendons();
  for (std::size_t k = 0; k < 2; ++k) {
    asked.drives[k].quantity = DriveQuantity::kDisplacement;
    asked.drives[k].profile = constant_tension(tendons[k].displacement);
  }
  const Equilibrium again(asked, 1e-13);
  ASSERT_TRUE(again.report.converged()) << again.report.worst_row;
  EXPECT_LT((tip_of(again) - tip_of(equilibrium)).norm(), 1e-9 * kLength);
  for (std::size_t k = 0; k < 2; ++k) {
    const TendonSample found = again.robot.rods[0].model->tendons()[k];
    EXPECT_NEAR(found.tension / tendons[k].tension, 1, 1e-8);
    EXPECT_NEAR(found.displacement, tendons[k].displacement, 1e-11);
  }
}

// A tendon cannot push: pulled by another one that is on the same side it hangs slack, and the rod
// bends as if it were not there.
TEST_P(Tendons, HangSlackRatherThanPush) {
  Scene scene = finely(rod_with_tendons(), GetParam());
  add_tendon(scene, kOffset, 0, 20);
  const Equilibrium alone(scene, 1e-13);
  const double pulled = alone.robot.rods[0].model->tendons()[0].displacement;
  add_tendon(scene, 0.5 * kOffset, 0, 0);
  displace(scene, 0.3 * pulled);  // less than the other one gives way
  const Equilibrium both(scene, 1e-13);
  ASSERT_TRUE(both.report.converged()) << both.report.worst_row;
  EXPECT_LT((tip_of(both) - tip_of(alone)).norm(), 1e-10 * kLength);
  EXPECT_EQ(both.robot.rods[0].model->tendons()[1].tension, 0);
  EXPECT_NEAR(both.robot.rods[0].model->tendons()[1].displacement, 0.5 * pulled, 1e-10);
}

// Rods that cannot stretch, in their weight, with the tendon on whichever side: found without help
// at every fineness, by one method as by another.
TEST_P(Tendons, PulledInByLittleAreFoundAtOnce) {
  for (const double displaced : {-1e-3, 0., 1e-3, 3e-3}) {
    Vec3 fine = Vec3::Zero();
    for (const int order : {12, 6, 4, 3}) {
      Scene scene = rod_with_tendons();
      scene.solver.method = GetParam();
      scene.solver.order = order;
      scene.solver.points = 3 * order;
      scene.solver.elements = GetParam() == Method::kStrain ? 1 : 2 * order;
      switch_on(scene, {Effect::kGravity});
      scene.gravity = {9.81, 0, 0};
      add_tendon(scene, kOffset, 0, 0);
      displace(scene, displaced);
      const Equilibrium equilibrium(scene, 1e-11);
      ASSERT_TRUE(equilibrium.report.converged()) << displaced << ", " << order;
      EXPECT_LE(equilibrium.report.iterations, 12) << displaced << ", " << order;
      if (order == 12)
        fine = tip_of(equilibrium);
      else
        EXPECT_LT((tip_of(equilibrium) - fine).norm(), 1e-4 * kLength)
            << displaced << ", " << order;
    }
  }
}

// They are fixed to the sections: a base turned in space turns the whole shape.
TEST_P(Tendons, TurnWithTheRod) {
  Scene scene = finely(rod_with_tendons(), GetParam());
  add_tendon(scene, kOffset, 0.4, 15, 0.8);
  const Vec3 straight = tip_of(Equilibrium(scene, 1e-13));
  const Mat3 R = exp_so3({0.7, -1.9, 0.5});
  scene.rods[0].base.at.X_BF = {R, Vec3(1, 2, 3)};
  EXPECT_LT((tip_of(Equilibrium(scene, 1e-13)) - (R * straight + Vec3(1, 2, 3))).norm(),
            1e-10 * kLength);
}

// Points on a straight line in the section's plane are a tendon that converges; those on the helix
// approach it with the square of their distance.
TEST_P(Tendons, RunStraightBetweenPoints) {
  Scene scene = rod_with_tendons();
  scene.solver.method = GetParam();
  scene.solver.points = 60;
  scene.solver.elements = 24;
  Scene helix = finely(scene, GetParam());
  add_tendon(helix, kOffset, 0, 15, 0.25);
  const Vec3 exact = tip_of(Equilibrium(helix, 1e-12));
  double last = 0;
  for (int pieces : {4, 8}) {
    Scene polygon = scene;
    TendonSpec& tendon = add_tendon(polygon, kOffset, 0, 15);
    tendon.route = TendonRoute::kPoints;
    for (int k = 0; k <= pieces; ++k) {
      const double s = double(k) / pieces, a = std::numbers::pi / 2 * s;
      tendon.points.push_back({s, kOffset * std::cos(a), kOffset * std::sin(a)});
    }
    const Equilibrium equilibrium(polygon, 1e-12);
    ASSERT_TRUE(equilibrium.report.converged());
    const double error = (tip_of(equilibrium) - exact).norm();
    if (last > 0) {
      EXPECT_NEAR(std::log2(last / error), 2, 0.1);
    }
    last = error;
  }
  EXPECT_LT(last, 5e-3 * kLength);
}

// The dimensions of the tendon robot of Till's published examples (steel, 2 mm, 0.5 m, tendons at
// 15.06 mm; one of them with 15 N), made harder: tendons wind, the rod has weight and carries a
// force. The reference begins at the tip; where it ends is where the scene begins.
TEST_P(Tendons, AgreeWithTheEquationsOfRuckerAndWebster) {
  Scene scene = finely(rod_with_tendons(), GetParam());
  if (GetParam() == Method::kStrain) scene.solver.order = 12;
  switch_on(scene, {Effect::kGravity, Effect::kExtension, Effect::kShear});
  const SectionProperties section = section_properties(scene.rods[0]);
  PulledReferenceRod reference{kLength, section.K_bt, section.K_se, {}, {}, {}};
  reference.tendons = {{kOffset, 0.3, 0, 15}, {kOffset, 1.7, 1.2, 12}, {0.01, -2, -0.7, 30}};
  const Vec3 gravity(4, -6, -7);
  reference.load = section.rhoA * gravity;
  reference.force = {0.3, 0.5, -0.4};
  const ReferenceBase base = solve_tendon_rod(reference, 4000);
  ASSERT_LT((solve_tendon_rod(reference, 2000).X_TB.p - base.X_TB.p).norm(), 2e-10);

  const Mat3 R_BT = base.X_TB.R.transpose();
  scene.gravity = R_BT * gravity;
  for (const ReferenceTendon& tendon : reference.tendons)
    add_tendon(scene, tendon.radius, tendon.angle, tendon.tension, tendon.turns);
  add_load(scene, 1, R_BT * reference.force);
  const Equilibrium equilibrium(scene, 1e-12);
  ASSERT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  const RodPoint tip = equilibrium.rod().points.back();
  const Vec3 expected = -(R_BT * base.X_TB.p);
  EXPECT_GT((expected - Vec3(0, 0, kLength)).norm(), 0.2 * kLength);
  EXPECT_LT((tip.position - expected).norm(), 1e-8 * kLength);
  EXPECT_LT((tip.rotation - R_BT).norm(), 1e-7);
}

// beside the rod in its plane, one of them not to the tip; at rest and in motion
TEST_P(Tendons, AreInAPlaneThoseInSpace) {
  for (const bool displaced : {false, true})
    for (const bool moves : {false, true})
      for (const bool stretches : {false, true}) {
        Vec3 tips[2];
        double work[2], tensions[2];
        for (const int plane : {0, 1}) {
          Scene scene = finely(rod_with_tendons(), GetParam());
          if (stretches) switch_on(scene, {Effect::kExtension, Effect::kShear});
          add_load(scene, 1, {0.3, 0, -0.2});
          add_tendon(scene, 0.01, 0, 8).termination = 0.8;
          add_tendon(scene, 0.012, std::numbers::pi, 3);
          if (displaced) displace(scene, -2e-3);
          if (plane == 1) scene.planar_normal = Vec3::UnitY();
          if (moves) scene.simulation.mode = Mode::kDynamic;
          scene.simulation.duration = 0.02;
          scene.solver.scheme = SchemeKind::kEsdirk43;
          scene.solver.step = 0.001;
          Simulation simulation(scene);
          const Snapshot end = run_to_end(simulation);
          ASSERT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
          tips[plane] = end.rods[0].points.back().position;
          work[plane] = end.energy.work;
          tensions[plane] = end.tendons[1].tension;
        }
        EXPECT_GT(tips[0].x(), 0.02);
        EXPECT_LT((tips[1] - tips[0]).norm(), displaced ? 1e-10 : 1e-12);
        EXPECT_NEAR(work[1], work[0], displaced ? 1e-10 : 1e-12);
        EXPECT_NEAR(tensions[1], tensions[0], 1e-7);
      }
}

/// Weight, every effect, a winding tendon and a straight one that go from 12 N and 8 N to less.
Scene released(Method method, ShapeOfTime shape, double step) {
  Scene scene = rod_with_tendons();
  switch_on(scene, {Effect::kGravity, Effect::kDamping, Effect::kExtension, Effect::kShear,
                    Effect::kRotaryInertia});
  scene.gravity = {-2, 1, -9.81};
  scene.solver.method = method;
  damp(scene.rods[0], 1e-3);
  add_tendon(scene, kOffset, 0.3, 12, 0.4);
  add_tendon(scene, kOffset, 2, 8);
  for (DriveSpec& drive : scene.drives) {
    ProfileTerm& pull = drive.profile.terms[0];
    pull.shape = shape;
    pull.from = pull.value;
    pull.to = 0.3 * pull.value;
    pull.end = 0.08;
  }
  scene.solver.scheme = SchemeKind::kGeneralizedAlpha;
  scene.solver.step = step;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.1;
  return scene;
}

Snapshot unwound(const Scene& scene) {
  const Snapshot end = end_of(scene);
  EXPECT_LT(end.energy.work, 0);  // the rod unwinds and pulls the tendons out
  return end;
}

double imbalance(const EnergySample& energy) {
  return std::abs(energy.balance) / (std::abs(energy.work) + energy.dissipated);
}

// The motors' work is counted, and motion and balance have the order of the scheme.
TEST_P(Tendons, KeepTheOrderOfTheScheme) {
  const auto run = [](double step) {
    return unwound(released(GetParam(), ShapeOfTime::kSmoothstep, step));
  };
  const Snapshot coarse = run(1e-3), fine = run(5e-4), exact = run(6.25e-5);
  EXPECT_LT(imbalance(fine.energy), 1e-4);
  EXPECT_GT(std::log2(imbalance(coarse.energy) / imbalance(fine.energy)), 1.8);
  const auto error = [&](const Snapshot& of) {
    return (of.rods[0].points.back().position - exact.rods[0].points.back().position).norm();
  };
  EXPECT_LT(error(fine), 1e-3 * kLength);
  EXPECT_NEAR(std::log2(error(coarse) / error(fine)), 2, 0.3);
}

// The books close with an order of their own where the scheme has one: motors that pull by a smooth
// function of time, long steps.
TEST_P(Tendons, CountTheWorkOfMotorsAsExactlyAsTheMotion) {
  const auto run = [](double step) {
    Scene scene = released(GetParam(), ShapeOfTime::kSmoothstep, step);
    scene.solver.scheme = SchemeKind::kEsdirk43;
    return imbalance(unwound(scene).energy);
  };
  const double coarse = run(2e-3), fine = run(1e-3);
  EXPECT_LT(fine, 1e-6);
  EXPECT_GT(std::log2(coarse / fine), 2.5);
  std::printf("imbalance %.1e, %.1e\n", coarse, fine);
}

// The same for tensions that are unknown: the motors' work is the integral of what they turn out
// to be.
TEST_P(Tendons, KeepTheOrderOfTheSchemeWhenPulledInByALength) {
  const auto run = [](double step) {
    Scene scene = released(GetParam(), ShapeOfTime::kSmoothstep, step);
    for (DriveSpec& drive : scene.drives) {
      drive.quantity = DriveQuantity::kDisplacement;
      drive.profile.terms[0].from = 0.006;
      drive.profile.terms[0].to = 0.004;
    }
    return unwound(scene);
  };
  const Snapshot coarse = run(1e-3), fine = run(5e-4), exact = run(6.25e-5);
  EXPECT_GT(exact.tendons[0].tension, 0.1);
  EXPECT_NEAR(exact.tendons[0].displacement, 0.004, 1e-9);
  EXPECT_LT(imbalance(fine.energy), 5e-5);
  EXPECT_GT(std::log2(imbalance(coarse.energy) / imbalance(fine.energy)), 1.8);
  std::printf("imbalance %.1e, %.1e\n", imbalance(coarse.energy), imbalance(fine.energy));
  const auto error = [&](const Snapshot& of) {
    return (of.rods[0].points.back().position - exact.rods[0].points.back().position).norm();
  };
  EXPECT_LT(error(fine), 1e-3 * kLength);
  EXPECT_GT(std::log2(error(coarse) / error(fine)), 1.6);
}

// The books of found tensions close as exactly, too: their work is what the scheme makes of the
// power.
TEST_P(Tendons, CountTheWorkOfFoundTensionsAsExactlyAsTheMotion) {
  const auto run = [](double step) {
    Scene scene = released(GetParam(), ShapeOfTime::kSmoothstep, step);
    for (DriveSpec& drive : scene.drives) {
      drive.quantity = DriveQuantity::kDisplacement;
      drive.profile.terms[0].from = 0.006;
      drive.profile.terms[0].to = 0.004;
    }
    scene.solver.scheme = SchemeKind::kEsdirk43;
    return imbalance(unwound(scene).energy);
  };
  const double coarse = run(2e-3), fine = run(1e-3);
  std::printf("imbalance %.1e, %.1e\n", coarse, fine);
  EXPECT_LT(fine, 1e-5);
  EXPECT_GT(std::log2(coarse / fine), 2);
}

// A jump of tension excites what no step resolves, which the scheme takes away; the rest stays
// accounted for.
TEST_P(Tendons, MayBeLetGoSuddenly) {
  EXPECT_LT(imbalance(unwound(released(GetParam(), ShapeOfTime::kStep, 5e-4)).energy), 8e-3);
}

INSTANTIATE_TEST_SUITE_P(Every, Tendons, ::testing::ValuesIn(kEveryMethod), test_name);

}  // namespace
}  // namespace cprsim
