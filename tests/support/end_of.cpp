// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/end_of.h"

#include <gtest/gtest.h>

namespace cprsim {

Snapshot end_of(const Scene& scene) {
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  return end;
}

}  // namespace cprsim
