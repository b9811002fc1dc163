// SPDX-License-Identifier: BSD-3-Clause
// Stiff rods and a light plate: monolithic means that the mass ratio does not matter (hard case
// N17).
#include <gtest/gtest.h>

#include "tests/support/robots.h"

namespace cprsim {
namespace {

// The plate's path in a push of 0.1 N that ends at 20 ms, at a fixed step of 5 ms.
std::vector<Vec3> path_with_mass(double mass, double* largest = nullptr) {
  Scene scene = stewart_gough({0.4, 0.4, 0.41, 0.42, 0.41, 0.4}, false, mass);
  switch_on(scene, {Effect::kDamping});
  for (RodSpec& leg : scene.rods)
    damp(leg, 1e-3);
  LoadSpec push;
  push.at.body = 0;
  push.force = {0.1, 0, 0};
  let_go(push, 0.02);
  scene.loads.push_back(push);
  scene.solver.points = 6;
  scene.solver.step = 5e-3;
  scene.simulation.mode = Mode::kDynamic;
  scene.simulation.initial_static = true;
  scene.simulation.duration = 0.5;
  Simulation simulation(scene);
  std::vector<Vec3> path;
  simulation.start();
  path.push_back(simulation.now().bodies[0].X_WB.p);
  while (simulation.status() == RunStatus::kRunning) {
    simulation.advance();
    path.push_back(simulation.now().bodies[0].X_WB.p);
    if (largest) *largest = std::max(*largest, (path.back() - path.front()).norm());
  }
  EXPECT_EQ(simulation.status(), RunStatus::kDone)
      << simulation.failure() << " with " << mass << " kg";
  EXPECT_EQ(simulation.statistics().retried, 0) << "with " << mass << " kg";
  return path;
}

double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double d = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    d = std::max(d, ((a[i] - a[0]) - (b[i] - b[0])).norm());
  return d;
}

TEST(LightPlatform, IsStableAndApproachesTheMasslessLimit) {
  double moved = 0;
  const auto heavy = path_with_mass(0.1, &moved);
  EXPECT_GT(moved, 1e-5);
  const auto gram = path_with_mass(1e-3), centigram = path_with_mass(1e-5),
             nothing = path_with_mass(1e-8);
  const double from_heavy = distance(heavy, nothing), from_gram = distance(gram, nothing),
               from_centigram = distance(centigram, nothing);
  // the difference to a massless plate falls in proportion to the mass
  EXPECT_LT(from_gram, 0.3 * from_heavy);
  EXPECT_LT(from_centigram, 0.03 * from_gram);
}

}  // namespace
}  // namespace cprsim
