// SPDX-License-Identifier: BSD-3-Clause
// Random robots that stood only once each of their rods was first brought to its place by itself.
#include "tests/bench/random_robot.h"

#include <gtest/gtest.h>

#include "engine/run/simulation.h"
#include "scenes/loader/load.h"
#include "tests/bench/equilibrium_check.h"

namespace cprsim {
namespace {

TEST(RandomRobots, StandOnceEachRodIsInItsPlace) {
  const LoadResult loaded = load_scene_text(random_robot(33).text, "random.xml");
  ASSERT_TRUE(loaded.scene);
  StaticStudy study(*loaded.scene);
  const SolveReport report = study.solve();
  ASSERT_TRUE(report.converged()) << report.worst_row;
  const EquilibriumCheck check = check_equilibrium(study);
  EXPECT_LT(check.imbalance, 1e-6);
  EXPECT_LT(check.gap, 1e-6);
}

TEST(RandomRobots, AreAssembledRodByRod) {
  for (const std::uint64_t seed : {18, 27, 54, 100}) {
    const LoadResult loaded = load_scene_text(random_robot(seed).text, "random.xml");
    ASSERT_TRUE(loaded.scene) << seed;
    Simulation simulation(*loaded.scene);
    EXPECT_TRUE(simulation.start().converged()) << seed << " " << simulation.failure();
  }
}

}  // namespace
}  // namespace cprsim
