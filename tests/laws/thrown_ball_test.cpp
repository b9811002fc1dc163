// SPDX-License-Identifier: BSD-3-Clause
// A ball thrown at a rod, neither held by anything: what momentum one loses the other gains. The
// rod's is the quadrature of rho A v by the weights of its cells' Gauss points.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/robot/robot.h"
#include "engine/run/simulation.h"

namespace cprsim {
namespace {

constexpr double kMass = 0.02;

Scene thrown_ball() {
  Scene scene;
  for (Effect e : {Effect::kContact, Effect::kFriction, Effect::kExtension, Effect::kRotaryInertia})
    scene.effects.set(e, true);
  BodySpec ball;
  ball.name = "ball";
  ball.X_WB.p = {0.03, 0.002, 0.09};
  ball.mass = kMass;
  ball.inertia = 2e-6 * Mat3::Identity();
  ball.linear_velocity = {-1, 0, 0.3};
  ball.velocity_given = true;
  ColliderSpec collider;
  collider.name = "c";
  collider.shape.kind = ShapeKind::kSphere;
  collider.shape.size = {0.015, 0, 0};
  collider.surface.friction = 0.6;
  ball.colliders.push_back(collider);
  scene.bodies.push_back(ball);
  RodSpec rod;
  rod.name = "rod";
  rod.length = 0.3;
  rod.section.shape = SectionShape::kCircle;
  rod.section.size = {0.003, 0};
  rod.material = MaterialSpec{1200, 1e8, 4e7, {}};
  rod.surface.friction = 0.6;
  rod.base.joint = EndJoint::kFree;
  rod.tip.joint = EndJoint::kFree;
  scene.rods.push_back(rod);
  scene.solver.points = 8;
  scene.solver.integrator = ArcIntegrator::kGauss6;
  scene.max_step_size = 1e-3;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.duration = 0.05;
  return scene;
}

Vec3 momentum_of(const RobotRod& rod) {
  constexpr double kWeights[3] = {5. / 18, 8. / 18, 5. / 18};
  const VecX& v = rod.model->tracks().front()->v;
  const int cells = rod.model->cells();
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index j = 0; j < 3 * cells; ++j)
    sum += kWeights[j % 3] / cells * v.segment<3>(3 * j);
  return rod.section.rhoA * rod.length * sum;
}

TEST(ThrownBall, GivesTheRodTheMomentumItLoses) {
  Simulation simulation(thrown_ball());
  simulation.start();
  const auto momentum = [&] {
    const Robot& robot = simulation.robot();
    return Vec3(kMass * robot.bodies[0].velocity() + momentum_of(robot.rods[0]));
  };
  const Vec3 before = momentum();
  EXPECT_NEAR(before.x(), -kMass, 1e-15);
  double hardest = 0, energy = simulation.now().energy.kinetic;
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    hardest = std::max(hardest, simulation.now().contact.force);
    // steps are solved to 1e-9 of the rod's length and force
    EXPECT_LT((momentum() - before).norm(), 1e-10) << "at " << simulation.time();
    EXPECT_LT(simulation.now().energy.kinetic + simulation.now().energy.elastic,
              energy * (1 + 1e-6));
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  EXPECT_GT(hardest, 0.1);
  EXPECT_GT(momentum_of(simulation.robot().rods[0]).norm(), 0.1 * kMass);
}

}  // namespace
}  // namespace cprsim
