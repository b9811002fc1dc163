// SPDX-License-Identifier: BSD-3-Clause
// Natural frequencies against the frequency equations of Euler-Bernoulli and Timoshenko beams.
#include "engine/study/modes.h"

#include <gtest/gtest.h>

#include "tests/support/jointed_bodies.h"

namespace cprsim {
namespace {

constexpr double kLength = 0.5, kRadius = 0.001;

Scene beam(EndJoint base, EndJoint tip) {
  Scene scene;
  RodSpec rod = steel_rod(kLength, kRadius);
  rod.base.joint = base;
  rod.tip.joint = tip;
  rod.tip.at.X_BF.p = {0, 0, kLength};
  scene.rods.push_back(rod);
  scene.solver.points = 16;
  return scene;
}

/// Frequencies of bending come in pairs; one of each.
std::vector<double> bending_modes(const Scene& scene, int count) {
  StaticStudy study(scene);
  EXPECT_TRUE(study.solve().converged());
  std::vector<double> omegas;
  for (const VibrationMode& mode : natural_modes(study, 2 * count)) {
    const double omega = std::sqrt(mode.omega_squared);
    if (omegas.empty() || omega > omegas.back() * (1 + 1e-6)) omegas.push_back(omega);
  }
  return omegas;
}

/// rad/s of a slender beam with the root beta L of its frequency equation.
double omega_of(double beta_L) {
  const RodSpec rod = steel_rod(kLength, kRadius);
  const double rhoA = 8000 * std::numbers::pi * kRadius * kRadius;
  return beta_L * beta_L / (kLength * kLength) * std::sqrt(bending_stiffness(rod) / rhoA);
}

void expect_roots(const std::vector<double>& omegas, const std::vector<double>& roots,
                  double tolerance) {
  ASSERT_GE(omegas.size(), roots.size());
  for (std::size_t i = 0; i < roots.size(); ++i)
    EXPECT_NEAR(omegas[i] / omega_of(roots[i]), 1, tolerance) << i;
}

TEST(Modes, ClampedFreeBeam) {
  expect_roots(bending_modes(beam(EndJoint::kFixed, EndJoint::kFree), 3),
               {1.87510406871, 4.69409113297, 7.85475743824}, 3e-6);
}

TEST(Modes, ClampedClampedBeam) {
  expect_roots(bending_modes(beam(EndJoint::kFixed, EndJoint::kFixed), 3),
               {4.73004074486, 7.8532046241, 10.995607838}, 3e-6);
}

TEST(Modes, ClampedPinnedBeam) {
  expect_roots(bending_modes(beam(EndJoint::kFixed, EndJoint::kUniversal), 3),
               {3.92660231205, 7.06858274563, 10.2101761228}, 3e-6);
}

TEST(Modes, PinnedPinnedBeam) {
  const double pi = std::numbers::pi;
  expect_roots(bending_modes(beam(EndJoint::kUniversal, EndJoint::kUniversal), 3),
               {pi, 2 * pi, 3 * pi}, 3e-6);
}

// exact Timoshenko beam by transfer matrices, shear factor 1
TEST(Modes, TimoshenkoBeamWithRotaryInertia) {
  Scene scene = beam(EndJoint::kFixed, EndJoint::kFree);
  switch_on(scene, {Effect::kShear, Effect::kExtension, Effect::kRotaryInertia});
  const std::vector<double> omegas = bending_modes(scene, 3);
  const double exact[] = {35.1598667102, 220.332416528, 616.888704223};
  ASSERT_GE(omegas.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(omegas[i] / exact[i], 1, 1e-6) << i;
}

TEST(Modes, BeamWithATipMass) {
  const double beam_mass = 8000 * std::numbers::pi * kRadius * kRadius * kLength;

  const struct {
    double ratio;
    std::vector<double> roots;
  } cases[] = {{0.25, {1.57375130266, 4.22511285671, 7.28123637341}},
               {1, {1.24791740961, 4.03113943671, 7.13413224094}},
               {5, {0.87002145889, 3.94998049114, 7.08253760284}}};

  for (const auto& c : cases) {
    Scene scene = beam(EndJoint::kFixed, EndJoint::kFixed);
    BodySpec body;
    body.name = "weight";
    body.mass = c.ratio * beam_mass;
    body.inertia = 1e-16 * Mat3::Identity();
    body.X_WB.p = {0, 0, kLength};
    scene.bodies.push_back(body);
    scene.rods[0].tip.at = {0, Pose{}};
    expect_roots(bending_modes(scene, 3), c.roots, 3e-6);
  }
}

// A string: bending is negligible beside the tension. And compression lowers the first frequency to
// zero at Euler's load: omega² = omega_0² (1 - P / P_crit), exact for pinned ends.
TEST(Modes, AxialForceChangesAPinnedBeamsFrequencies) {
  Scene scene = column(kLength, kRadius, EndJoint::kUniversal, EndJoint::kUniversal, 0);
  scene.solver.points = 16;
  const double pi = std::numbers::pi;
  const double critical = pi * pi * bending_stiffness(scene.rods[0]) / (kLength * kLength);
  for (const double part : {-3.0, 0.0, 0.5, 0.99}) {
    scene.loads[0].force = {0, 0, -part * critical};
    const std::vector<double> omegas = bending_modes(scene, 1);
    ASSERT_FALSE(omegas.empty());
    EXPECT_NEAR(omegas[0] / (omega_of(pi) * std::sqrt(1 - part)), 1, 1e-6) << part;
  }
}

// A body that hangs on a joint by its arm l, springs k: (m g l + k) / (I + m l²) for swings, k / I
// for the turn about the plumb line.
// A bent rod that stays in its plane has those of its motions that do, with their frequencies.
TEST(Modes, OfAPlanarRobotAreAmongThoseInSpace) {
  Scene arch = beam(EndJoint::kFixed, EndJoint::kFixed);
  arch.rods[0].tip.at.X_BF.p = {0, 0, 0.9 * kLength};
  StaticStudy space(arch);
  arch.planar_normal = Vec3::UnitY();
  StaticStudy plane(arch);
  ASSERT_TRUE(space.solve().converged());
  ASSERT_TRUE(plane.solve().converged());
  ASSERT_GT(std::abs(point_at(plane.snapshot().rods[0], 0.5).position.x()), 0.1 * kLength);
  const std::vector<VibrationMode> all = natural_modes(space, 20);
  for (const VibrationMode& mode : natural_modes(plane, 5)) {
    EXPECT_GT(mode.omega_squared, 0);
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const VibrationMode& other) {
      return std::abs(other.omega_squared / mode.omega_squared - 1) < 1e-6;
    })) << mode.omega_squared;
  }
}

TEST(Modes, BodiesOnBallsAndUniversals) {
  constexpr double kMass = 0.4, kArm = 0.25, kSpring = 0.3;
  const Vec3 I(2e-3, 3e-3, 1e-3);
  for (JointKind kind : {JointKind::kBall, JointKind::kUniversal}) {
    Scene scene;
    switch_on(scene, {Effect::kGravity});
    scene.gravity = {0, 0, -9.81};
    scene.bodies.push_back(lump("bob", {Mat3::Identity(), {0, 0, -kArm}}, kMass, I));
    scene.joints.push_back(joint_at(scene, kind, Vec3::Zero(), kWorld, 0, Vec3::UnitX()));
    JointSpec& joint = scene.joints[0];
    joint.second.axis = Vec3::UnitY();
    joint.spring_stiffness = joint.second.spring_stiffness = kSpring;
    StaticStudy study(scene);
    ASSERT_TRUE(study.solve().converged());
    const std::vector<VibrationMode> modes = natural_modes(study, 3);
    const double restoring = kMass * 9.81 * kArm + kSpring, swung = kMass * kArm * kArm;
    std::vector<double> expected{restoring / (I.y() + swung), restoring / (I.x() + swung)};
    if (kind == JointKind::kBall) expected.push_back(kSpring / I.z());
    ASSERT_EQ(modes.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(modes[i].omega_squared, expected[i], 1e-8 * expected[i]);
  }
}

}  // namespace
}  // namespace cprsim
