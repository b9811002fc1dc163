// SPDX-License-Identifier: BSD-3-Clause
// Where a scene's run ends.
#pragma once

#include <gtest/gtest.h>

#include "tests/support/robots.h"

namespace cprsim {

/// The last snapshot of a run that must get to its end.
inline Snapshot end_of(const Scene& scene) {
  Simulation simulation(scene);
  const Snapshot end = run_to_end(simulation);
  EXPECT_EQ(simulation.status(), RunStatus::kDone) << simulation.failure();
  return end;
}

}  // namespace cprsim
