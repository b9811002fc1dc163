// SPDX-License-Identifier: BSD-3-Clause
// Where a scene's run ends.
#pragma once

#include <gtest/gtest.h>

#include "tests/support/robots.h"

namespace cprsim {

/// The last snapshot of a run that must get to its end.
Snapshot end_of(const Scene& scene);

}  // namespace cprsim
