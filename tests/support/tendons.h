// SPDX-License-Identifier: BSD-3-Clause
// Tendons for scenes built in code.
#pragma once

#include "tests/support/robots.h"

namespace cprsim {

Profile constant_tension(double value);

/// A tendon along rod 0 beside its centreline, or wound around it, with its drive.
TendonSpec& add_tendon(Scene& scene, double radius, double angle, double tension, double turns = 0);

/// The last tendon is pulled in by so many metres instead.
void displace(Scene& scene, double by);

}  // namespace cprsim
