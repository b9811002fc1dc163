// SPDX-License-Identifier: BSD-3-Clause
// What is particular to rods of polynomial strain: errors that fall exponentially with the order.
#include "engine/rod/strain_basis.h"

#include <gtest/gtest.h>

#include <iomanip>

#include "tests/support/elastica.h"
#include "tests/support/methods.h"
#include "tests/support/robots.h"

namespace cprsim {
namespace {

Scene bent_rod(double s, int order, int elements = 1) {
  Scene scene;
  scene.rods.push_back(steel_rod(0.4, 1e-3));
  const double P = 5 * bending_stiffness(scene.rods[0]) / 0.16;
  add_load(scene, s, {P, 0, 0});
  scene.solver.method = Method::kStrain;
  scene.solver.order = order;
  scene.solver.elements = elements;
  return scene;
}

Vec3 tip(const Scene& scene) {
  const Equilibrium equilibrium(scene, 1e-13);
  EXPECT_TRUE(equilibrium.report.converged()) << equilibrium.report.worst_row;
  return equilibrium.rod().points.back().position / 0.4;
}

// each order gains a digit, until the Magnus steps are what is left
TEST(StrainBasis, ConvergesExponentiallyToTheElastica) {
  const Elastica exact = solve_elastica(5);
  std::cout << "order  error of the tip / L\n";
  double last = 1;
  for (int order = 1; order <= 10; ++order) {
    const double error = (tip(bent_rod(1, order)) - Vec3(exact.x, 0, exact.z)).norm();
    std::cout << std::setw(5) << order << "  " << error << "\n";
    if (order % 2 == 1) {
      EXPECT_LT(error, std::max(0.03 * last, 2e-11)) << "order " << order;
      last = error;
    }
  }
  EXPECT_LT(last, 2e-11);
}

// with a load inside, where the curvature has a kink, it is as fast: elements end there
TEST(StrainBasis, ConvergesExponentiallyWithALoadInside) {
  const Vec3 exact = tip(finely(bent_rod(0.37, 1), Method::kShooting));
  double last = 1;
  for (int order : {1, 3, 5}) {
    const Scene scene = bent_rod(0.37, order);
    const double error = (tip(scene) - exact).norm();
    EXPECT_LT(error, std::max(0.03 * last, 1e-9)) << "order " << order;
    last = error;
    EXPECT_EQ(Equilibrium(scene).robot.rods[0].model->resolution().elements, 2);
  }
  EXPECT_LT(last, 1e-8);
}

TEST(StrainBasis, HasOnlyTheStrainsThatEffectsAllow) {
  Scene scene = bent_rod(1, 4);
  Equilibrium before(scene);
  EXPECT_EQ(before.robot.rods[0].model->unknown_count(), 12 + 3 * 5);
  switch_on(scene, {Effect::kExtension});
  EXPECT_EQ(Equilibrium(scene).robot.rods[0].model->unknown_count(), 12 + 4 * 5);
  switch_on(scene, {Effect::kShear});
  EXPECT_EQ(Equilibrium(scene).robot.rods[0].model->unknown_count(), 12 + 6 * 5);
  scene.planar_normal = Vec3::UnitY();
  EXPECT_EQ(Equilibrium(scene).robot.rods[0].model->unknown_count(), 6 + 3 * 5);
  scene.effects = {};
  EXPECT_EQ(Equilibrium(scene).robot.rods[0].model->unknown_count(), 6 + 5);
}

// A helix of four turns that sags: its bending in section axes goes round with the winding.
TEST(StrainBasis, CutsAWoundRodFinelyEnough) {
  Scene scene;
  scene.rods.push_back(steel_rod(0.8, 1e-3));
  scene.rods[0].rest_curvature = {0, 24, 18};
  switch_on(scene, {Effect::kGravity});
  scene.gravity = {-9.81, 3, 0};
  scene.solver.accuracy = 1e-7;
  const Equilibrium shooting(scene);
  scene.solver.method = Method::kStrain;
  const Equilibrium strain(scene);
  ASSERT_TRUE(strain.report.converged()) << strain.report.worst_row;
  EXPECT_GE(strain.robot.rods[0].model->resolution().elements, 6);
  EXPECT_NE(strain.robot.rods[0].choice.why.find("more for its rest shape"), std::string::npos);
  EXPECT_LT((shooting.rod().points.back().position - strain.rod().points.back().position).norm(),
            1e-7);
}

TEST(Auto, TakesTheMethodWhoseResolutionIsGiven) {
  Scene scene = bent_rod(1, 4);
  scene.solver.method = Method::kAuto;
  EXPECT_EQ(build_robot(scene).rods[0].model->resolution().method, Method::kStrain);
  scene.solver.order.reset();
  scene.solver.elements.reset();
  EXPECT_EQ(build_robot(scene).rods[0].model->resolution().method, Method::kShooting);
  scene.rods[0].method = Method::kStrain;
  scene.solver.accuracy = 1e-9;
  const Robot robot = build_robot(scene);
  const RodResolution resolution = robot.rods[0].model->resolution();
  EXPECT_EQ(resolution.method, Method::kStrain);
  EXPECT_GE(resolution.order, 7);
  EXPECT_EQ(robot.rods[0].choice.why, "the rod asks for it; cut for 1e-09 m");
}

// Between hinges 1 m apart hang 1.2 m of 0.5 N/m, EA = 500 N: the sag of the elastic catenary.
TEST(Auto, TakesTheStrainBasisForWhatHangsLikeACable) {
  RodSpec rod = steel_rod(1.2, 1e-2);
  rod.stiffness.bending_x = rod.stiffness.bending_y = rod.stiffness.torsion = 0.864e-5;
  rod.stiffness.axial = 500;
  rod.material->density = 0.5 / (std::numbers::pi * 1e-4);
  const Mat3 along_x = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitY()).toRotationMatrix();
  rod.base.joint = rod.tip.joint = EndJoint::kRevolute;
  rod.base.axis = rod.tip.axis = Vec3::UnitY();
  rod.base.at.X_BF = {along_x, Vec3::Zero()};
  rod.tip.at.X_BF = {along_x, Vec3::UnitX()};
  Scene scene;
  switch_on(scene, {Effect::kGravity, Effect::kExtension});
  scene.gravity = {0, 0, -1};
  scene.solver.method = Method::kAuto;
  scene.rods.push_back(rod);
  const Equilibrium hanging(scene, 1e-9);
  ASSERT_TRUE(hanging.report.converged()) << hanging.report.worst_row;
  EXPECT_NE(hanging.robot.rods[0].choice.why.find("hangs like a cable"), std::string::npos);
  EXPECT_NEAR(point_at(hanging.rod(), 0.5).position.z(), -0.2929124, 2e-4);
  scene.rods[0].stiffness.bending_x = scene.rods[0].stiffness.bending_y = 1;
  EXPECT_EQ(build_robot(scene).rods[0].choice.method, Method::kShooting);
}

}  // namespace
}  // namespace cprsim
