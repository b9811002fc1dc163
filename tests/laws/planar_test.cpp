// SPDX-License-Identifier: BSD-3-Clause
// The planar kernel and the spatial one are two discretisations of one law on one grid: what moves
// in a plane must come out the same from both, up to what their solvers leave.
#include <gtest/gtest.h>

#include "tests/support/methods.h"
#include "tests/support/planar_robots.h"

namespace cprsim {
namespace {

double largest_force(const Snapshot& s) {
  double most = 0;
  for (const RodSample& rod : s.rods)
    for (const RodPoint& point : rod.points)
      most = std::max(most, point.force.norm());
  return most;
}

/// Everything that an observer sees, each relative to the largest of its kind.
void expect_same(const Snapshot& a, const Snapshot& b, double tolerance) {
  ASSERT_EQ(a.rods.size(), b.rods.size());
  const double force = largest_force(a), speed = [&] {
    double most = 0.1;  // the solver leaves 1e-12 m a step of 0.01 s
    for (const RodSample& rod : a.rods)
      for (const RodPoint& point : rod.points)
        most = std::max(most, point.velocity.norm());
    return most;
  }();
  for (std::size_t r = 0; r < a.rods.size(); ++r) {
    const double L = a.rods[r].length;
    ASSERT_EQ(a.rods[r].points.size(), b.rods[r].points.size());
    for (std::size_t k = 0; k < a.rods[r].points.size(); ++k) {
      const RodPoint &p = a.rods[r].points[k], &q = b.rods[r].points[k];
      const std::string where = "rod " + std::to_string(r) + ", s = " + std::to_string(p.s);
      EXPECT_EQ(p.s, q.s);
      EXPECT_LT((p.position - q.position).norm(), tolerance * L) << where;
      EXPECT_LT((p.rotation - q.rotation).norm(), tolerance) << where;
      EXPECT_LT((p.velocity - q.velocity).norm(), tolerance * speed) << where;
      EXPECT_LT((p.force - q.force).norm(), tolerance * force) << where;
      EXPECT_LT((p.moment - q.moment).norm(), tolerance * force * L) << where;
      EXPECT_LT((p.curvature - q.curvature).norm(), 10 * tolerance / L) << where;
      EXPECT_LT((p.shear_stretch - q.shear_stretch).norm(), tolerance) << where;
    }
  }
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    EXPECT_LT((a.bodies[i].X_WB.p - b.bodies[i].X_WB.p).norm(), tolerance) << "body " << i;
    EXPECT_LT((a.bodies[i].X_WB.R - b.bodies[i].X_WB.R).norm(), tolerance) << "body " << i;
  }
  for (std::size_t j = 0; j < a.joints.size(); ++j) {
    EXPECT_LT((a.joints[j].position - b.joints[j].position).norm(), tolerance) << "joint " << j;
    EXPECT_LT((a.joints[j].effort - b.joints[j].effort).norm(), tolerance * force) << "joint " << j;
  }
  const double energy = std::abs(a.energy.kinetic) + std::abs(a.energy.elastic);
  EXPECT_NEAR(a.energy.kinetic, b.energy.kinetic, tolerance * energy);
  EXPECT_NEAR(a.energy.elastic, b.energy.elastic, tolerance * energy);
  EXPECT_NEAR(a.energy.gravity, b.energy.gravity, tolerance * energy);
  EXPECT_NEAR(a.energy.dissipated, b.energy.dissipated, tolerance * energy);
  EXPECT_NEAR(a.energy.work, b.energy.work, tolerance * energy);
}

/// Runs a scene to its end in both kernels. Statics is one instant.
void expect_agreement_of(Method method, Scene scene, const Plane& plane, double tolerance) {
  SCOPED_TRACE(method_name(method));
  scene.solver.method = method;
  scene.solver.residual_tolerance = 1e-12;
  Simulation spatial(scene), planar(in_plane(scene, plane));
  spatial.start();
  planar.start();
  ASSERT_NE(spatial.status(), RunStatus::kFailed) << spatial.failure();
  ASSERT_NE(planar.status(), RunStatus::kFailed) << planar.failure();
  expect_same(spatial.now(), planar.now(), tolerance);
  while (planar.status() == RunStatus::kRunning) {
    spatial.advance();
    planar.advance();
  }
  ASSERT_EQ(spatial.status(), RunStatus::kDone) << spatial.failure();
  ASSERT_EQ(planar.status(), RunStatus::kDone) << planar.failure();
  expect_same(spatial.now(), planar.now(), tolerance);
}

/// By every method, or by shooting if an integrator is given.
void expect_agreement(const Scene& scene, const Plane& plane, double tolerance) {
  for (Method method : kEveryMethod)
    if (method == Method::kShooting || !scene.solver.integrator)
      expect_agreement_of(method, scene, plane, tolerance);
}

class PlanarIsSpatial : public ::testing::TestWithParam<Plane> {};

INSTANTIATE_TEST_SUITE_P(Planes, PlanarIsSpatial,
                         ::testing::Values(coordinate_plane(), oblique_plane()));

TEST_P(PlanarIsSpatial, ForACantilever) {
  for (bool extensible : {false, true}) {
    Scene scene = planar_cantilever(GetParam());
    scene.effects.set(Effect::kExtension, extensible);
    scene.effects.set(Effect::kShear, extensible);
    expect_agreement(scene, GetParam(), 1e-9);
  }
}

TEST_P(PlanarIsSpatial, ForEveryArcLengthIntegrator) {
  for (ArcIntegrator integrator : {ArcIntegrator::kEuler, ArcIntegrator::kRk4,
                                   ArcIntegrator::kGauss2, ArcIntegrator::kGauss4}) {
    Scene scene = planar_cantilever(GetParam());
    scene.solver.integrator = integrator;
    expect_agreement(scene, GetParam(), 1e-9);
  }
}

TEST_P(PlanarIsSpatial, ForTwoRodsBetweenCranksStandingStill) {
  for (bool gravity : {false, true}) {
    Scene scene = rfrfr(GetParam());
    scene.effects.set(Effect::kGravity, gravity);
    expect_agreement(scene, GetParam(), 1e-9);
  }
}

TEST_P(PlanarIsSpatial, ForTwoRodsBetweenCranksInMotion) {
  Scene scene = rfrfr(GetParam(), 0.4);
  switch_on(scene, {Effect::kGravity});
  set_dynamic(scene, 0.2, 0.01, SchemeKind::kEsdirk32);
  expect_agreement(scene, GetParam(), 1e-9);
}

// Long enough for what no row holds, the round-off across the plane, to show if it grew.
TEST_P(PlanarIsSpatial, ForManySteps) {
  Scene scene = rfrfr(GetParam(), 0.4);
  switch_on(scene, {Effect::kGravity, Effect::kDamping});
  for (RodSpec& rod : scene.rods)
    damp(rod, 3e-3);
  for (SchemeKind scheme : {SchemeKind::kEsdirk32, SchemeKind::kBdf2}) {
    set_dynamic(scene, 1.5, 0.01, scheme);
    expect_agreement(scene, GetParam(), 1e-9);
  }
}

TEST_P(PlanarIsSpatial, ForASliderCrank) {
  Scene scene = slider_crank(GetParam(), 1.2);
  expect_agreement(scene, GetParam(), 1e-9);
  set_dynamic(scene, 0.2, 0.005, SchemeKind::kGeneralizedAlpha);
  expect_agreement(scene, GetParam(), 1e-9);
}

TEST_P(PlanarIsSpatial, ForAReleasedRodWithEveryEffect) {
  for (SchemeKind scheme : {SchemeKind::kBackwardEuler, SchemeKind::kBdfAlpha,
                            SchemeKind::kGeneralizedAlpha, SchemeKind::kEsdirk43}) {
    Scene scene = planar_release(GetParam());
    set_dynamic(scene, 0.1, 0.005, scheme);
    expect_agreement(scene, GetParam(), 1e-9);
  }
}

TEST_P(PlanarIsSpatial, ForRodsWithDisks) {
  Scene scene = rfrfr(GetParam());
  switch_on(scene, {Effect::kGravity, Effect::kDamping, Effect::kRotaryInertia});
  for (RodSpec& rod : scene.rods) {
    damp(rod, 3e-3);
    rod.disks = {{0.4, 0.01, 0.03}, {1, 0.02, 0.02}};
  }
  scene.bodies[2].velocity_given = true;
  scene.bodies[2].linear_velocity = GetParam() * Vec3(0.1, 0.02, 0);
  set_dynamic(scene, 0.1, 0.005, SchemeKind::kEsdirk32);
  expect_agreement(scene, GetParam(), 1e-9);
}

TEST_P(PlanarIsSpatial, ForABodyThatStartsMoving) {
  Scene scene = rfrfr(GetParam());
  switch_on(scene, {Effect::kGravity, Effect::kDamping, Effect::kRotaryInertia});
  for (RodSpec& rod : scene.rods)
    damp(rod, 3e-3);
  scene.bodies[2].velocity_given = true;
  scene.bodies[2].linear_velocity = GetParam() * Vec3(0.1, 0.02, 0);
  scene.bodies[2].angular_velocity = 0.3 * GetParam().col(2);
  set_dynamic(scene, 0.1, 0.005, SchemeKind::kEsdirk32);
  expect_agreement(scene, GetParam(), 1e-9);
}

// Flat springs: stiff and soft axis along the normal, and section axes that only the tip holds.
TEST_P(PlanarIsSpatial, ForSectionsThatAreNotRound) {
  for (double turn : {0., std::numbers::pi / 2}) {
    Scene scene = planar_cantilever(GetParam());
    RodSpec& rod = scene.rods[0];
    rod.section.shape = SectionShape::kRectangle;
    rod.section.size = {3e-3, 1e-3};
    rod.base.at.X_BF.R *= Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
    scene.loads[0].force *= 0.2;
    set_dynamic(scene, 0.05, 0.005, SchemeKind::kBdf2);
    switch_on(scene, {Effect::kRotaryInertia, Effect::kExtension, Effect::kShear});
    expect_agreement(scene, GetParam(), 1e-9);
    // stretched rather than buckled, which in space it may do out of the plane
    rod.tip = end_at(EndJoint::kFixed, kWorld, rod.base.at.X_BF, Vec3::UnitX());
    rod.tip.at.X_BF.p += 0.4 * rod.base.at.X_BF.R.col(2);
    rod.base.at.X_BF.R *= Eigen::AngleAxisd(0.7, Vec3::UnitZ()).toRotationMatrix();
    scene.loads[0].rod_s = 0.5;
    rod.base.joint = EndJoint::kBall;
    scene.simulation.mode = Mode::kStatic;
    expect_agreement(scene, GetParam(), 1e-9);
  }
}

// What a joint in space comes down to in the plane. Between two points at rest.
TEST_P(PlanarIsSpatial, ForEveryJointOfARod) {
  struct End {
    EndJoint joint;
    Vec3 axis;
    bool spin_free;
  };

  // in the frame's axes: x along the normal, y in the plane, z the tangent
  const End ends[] = {
      {EndJoint::kFixed, Vec3::UnitX(), true},      {EndJoint::kRevolute, Vec3::UnitX(), false},
      {EndJoint::kRevolute, Vec3::UnitX(), true},   {EndJoint::kRevolute, Vec3::UnitY(), false},
      {EndJoint::kUniversal, Vec3::UnitX(), false}, {EndJoint::kBall, Vec3::UnitX(), false}};
  for (const End& end : ends) {
    SCOPED_TRACE("joint " + std::to_string(static_cast<int>(end.joint)) +
                 (end.spin_free ? ", spin free" : ""));
    Scene scene = planar_cantilever(GetParam());
    RodSpec& rod = scene.rods[0];
    rod.tip = end_at(end.joint, kWorld, frame_in(GetParam(), 0.45, -0.1, 0.5), end.axis);
    rod.tip.spin_free = end.spin_free;
    scene.loads[0].rod_s = 0.5;
    switch_on(scene, {Effect::kExtension});
    expect_agreement(scene, GetParam(), 1e-9);
  }
}

TEST(PlanarRod, ConvergesInArcLengthWithTheOrderOfItsTable) {
  const Plane plane = coordinate_plane();
  const auto tip = [&](ArcIntegrator integrator, int cells) {
    Scene scene = in_plane(planar_cantilever(plane), plane);
    switch_on(scene, {Effect::kExtension, Effect::kShear});
    scene.solver.integrator = integrator;
    scene.solver.points = cells;
    const Equilibrium equilibrium(scene, 1e-13);
    EXPECT_TRUE(equilibrium.report.converged());
    return equilibrium.rod().points.back().position;
  };
  const Vec3 fine = tip(ArcIntegrator::kGauss6, 64);

  struct Case {
    ArcIntegrator integrator;
    int cells;
    double order;
  };

  for (const Case& c : {Case{ArcIntegrator::kEuler, 80, 1}, Case{ArcIntegrator::kGauss2, 16, 2},
                        Case{ArcIntegrator::kGauss4, 8, 4}, Case{ArcIntegrator::kGauss6, 4, 6},
                        Case{ArcIntegrator::kRk4, 16, 4}}) {
    const double coarse = (tip(c.integrator, c.cells) - fine).norm(),
                 half = (tip(c.integrator, 2 * c.cells) - fine).norm();
    EXPECT_NEAR(std::log2(coarse / half), c.order, 0.15 * c.order)
        << "cells " << c.cells << ", errors " << coarse << " " << half;
  }
}

// Steps so short that the rod is cut into segments.
TEST(PlanarRod, AgreesAcrossSegments) {
  const Plane plane = coordinate_plane();
  Scene scene = planar_release(plane);
  scene.solver.points = 12;
  set_dynamic(scene, 1e-3, 2e-5, SchemeKind::kEsdirk32);
  Simulation planar(in_plane(scene, plane));
  ASSERT_GE(planar.facts().rods[0].segments, 3);
  // positions carry round-off of 1e-16 m, and inertia, c_v c_w rhoA L, makes forces 1e8 times as
  // large of it
  expect_agreement(scene, plane, 1e-7);
}

TEST(PlanarRod, FollowsALengthDrive) {
  const Plane plane = coordinate_plane();
  Scene scene = planar_cantilever(plane);
  DriveSpec drive;
  drive.rod = 0;
  drive.quantity = DriveQuantity::kLength;
  drive.profile = ramp(0.3, 0.4, 0.1);
  scene.drives.push_back(drive);
  set_dynamic(scene, 0.1, 0.005, SchemeKind::kEsdirk32);
  expect_agreement(scene, plane, 1e-9);
}

// The joint of the two-rod robot whose rods are 1 m long, cranks at 120 and 60 degrees.
TEST(PlanarRod, FindsThePublishedHandOfTwoRods) {
  const Plane plane = coordinate_plane();
  Scene scene = in_plane(rfrfr(plane), plane);
  scene.solver.points = 20;
  const Equilibrium equilibrium(scene);
  ASSERT_TRUE(equilibrium.report.converged());
  const Vec3 at = plane.transpose() * equilibrium.robot.bodies[2].p;
  EXPECT_NEAR(at.x(), 0, 1e-9);
  EXPECT_NEAR(at.y(), 0.927501479, 1e-9);
}

}  // namespace
}  // namespace cprsim
