// SPDX-License-Identifier: BSD-3-Clause
// A heavy rod that is pressed along the bottom of a level tube, with the clearance c around it and
// the weight w per length. It buckles sideways, in half waves of pi / k, at (Dawson and Paslay, J.
// Pet. Technol. 36, 1984)
//   F = 2 sqrt(EI w / c),  k^4 = w / (EI c)                                              (1)
// Below, a sideways load q_m sin(m k x) moves it by q_m sin(m k x) / (EI (m k)^4 - F (m k)^2 + w /
// c). A helix has no more energy than the straight rod from (Chen, Lin and Cheatham, J. Energy
// Resour. Technol. 112, 1990)
//   F = 2 sqrt(2) sqrt(EI w / c)                                                         (2)
// on, which supposes that its pitch is the same all round: the true one can have less.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/run/simulation.h"
#include "scenes/loader/load.h"

namespace cprsim {
namespace {

constexpr double kPi = 3.14159265358979323846, kClearance = 0.004;
constexpr double kBending = 2e11 * kPi * 1e-12 / 4, kWeight = 7800 * 9.81 * kPi * 1e-6;

double unit_force() {
  return std::sqrt(kBending * kWeight / kClearance);
}

Scene rod_in_tube() {
  const LoadResult loaded =
      load_scene(std::string(CPRSIM_SOURCE_DIR) + "/scenes/contact/rod_in_tube.xml");
  return *loaded.scene;
}

/// Of what presses the slider, all the time.
void press(Scene& scene, double force) {
  for (LoadSpec& load : scene.loads) {
    if (load.rod >= 0) continue;
    load.force = Vec3(-force, 0, 0);
    load.has_profile = false;
  }
}

Snapshot at_rest(const Scene& scene) {
  Simulation simulation(scene);
  simulation.start();
  while (simulation.status() == RunStatus::kRunning)
    simulation.advance();
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  return simulation.now();
}

/// How far it leans aside in the middle of its half waves under 1 mN/m of changing sign.
double leans(double force) {
  Scene scene = rod_in_tube();
  press(scene, force);
  scene.simulation.duration = 3;
  const Snapshot now = at_rest(scene);
  double most = 0;
  for (const RodPoint& point : now.rods[0].points)
    most = std::max(most, std::abs(point.position.y()));
  return most;
}

double should_lean(double force) {
  const double k2 = std::sqrt(kWeight / (kBending * kClearance));
  double sum = 0;
  for (int m = 1; m < 20; m += 2) {
    const double q = 4e-3 / (kPi * m), stiffness = kBending * m * m * m * m * k2 * k2 -
                                                   force * m * m * k2 + kWeight / kClearance;
    sum += (m % 4 == 1 ? 1 : -1) * q / stiffness;
  }
  return sum;
}

TEST(Tube, ARodLeansAsideAsItsLinearEquationSays) {
  for (double part : {0.5, 0.8, 0.9})
    EXPECT_NEAR(leans(part * 2 * unit_force()) / should_lean(part * 2 * unit_force()), 1, 0.015)
        << part;
}

// 1 / (what it leans by) falls to zero at the load at which it buckles.
TEST(Tube, ARodBucklesSidewaysWhereDawsonAndPaslaySay) {
  const double F = 2 * unit_force(), a = 1 / leans(0.8 * F), b = 1 / leans(0.9 * F);
  EXPECT_NEAR(0.8 + 0.1 * a / (a - b), 1, 3e-3);
  EXPECT_LT(leans(0.98 * F), 1e-3);
  EXPECT_GT(leans(1.1 * F), 1e-3);
}

/// Energy of a helix of so many turns and of what presses it, over that of the straight rod.
/// @param length of the rod
double helix_energy(double force, int turns, double& length) {
  Scene scene = rod_in_tube();
  const double q = std::sqrt(force / (2 * kBending)), X = 2 * kPi * turns / q;
  length = X * std::hypot(1, kClearance * q);
  press(scene, force);
  scene.loads.erase(std::remove_if(scene.loads.begin(), scene.loads.end(),
                                   [](const LoadSpec& load) { return load.rod >= 0; }),
                    scene.loads.end());
  for (BodySpec& body : scene.bodies) {
    if (body.name == "rig::slider") body.X_WB.p.x() = X;
    for (ColliderSpec& collider : body.colliders)
      collider.shape.size.y() = 20;
  }
  for (JointSpec& joint : scene.joints)
    if (joint.name == "rig::slide") joint.X_PJ.p.x() = X;
  RodSpec& rod = scene.rods[0];
  rod.length = length;
  scene.solver.points = 24 * turns;
  for (int i = 0; i <= 60 * turns; ++i) {
    const double s = static_cast<double>(i) / (60 * turns), angle = 2 * kPi * turns * s;
    rod.start.push_back({s, {X * s, kClearance * std::sin(angle), -kClearance * std::cos(angle)}});
  }
  scene.simulation.duration = 4;
  const Snapshot now = at_rest(scene);
  double slider = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].name == "rig::slider") slider = now.bodies[i].X_WB.p.x();
  return now.energy.elastic + now.energy.gravity + kWeight * kClearance * length -
         force * (length - slider);
}

// Two turns more have the same ends: what they add is of a turn. It changes as 1 - (F / F_0)^2.
TEST(Tube, AHelixHasNoMoreEnergyFromItsOnsetOn) {
  const double F = 3 * unit_force();
  double few = 0, many = 0;
  const double less = helix_energy(F, 4, few), more = helix_energy(F, 6, many);
  const double added = (more - less) / (many - few) / (kWeight * kClearance);
  EXPECT_LT(added, 0);
  EXPECT_NEAR(3 / std::sqrt(1 - added) / (2 * std::sqrt(2)), 1, 0.02);
}

}  // namespace
}  // namespace cprsim
