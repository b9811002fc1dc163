// SPDX-License-Identifier: BSD-3-Clause
// A made-up six-rod robot for tests of drawing: looks like the real one, is computed by no solver.
#pragma once

#include "engine/model/scene.h"
#include "engine/run/snapshot.h"

namespace cprsim {

/// A base plate fixed to the world, a platform, six rods of 2 mm steel, a camera and a film.
Scene six_rods_scene();

/// Its platform heaves, sways and turns; rods are cubics that leave both plates at right angles,
/// with the moment that belongs to their curvature.
Snapshot six_rods_at(double t);

}  // namespace cprsim
