// SPDX-License-Identifier: BSD-3-Clause
// Rigid bodies that Bullet integrates. Bullet finds the contacts and their forces; its first-order
// motion (free fall is 4.9 mm off after 1 s at 1 ms) is corrected after each substep:
//   (1) a body that nothing touched gets its exact flight (collision/flight.h); only the rotation
//       under the torque of a load remains Bullet's
//   (2) for one that was touched, p += v⁺ dt becomes p += (v⁻ + v⁺)/2 dt along the directions in
//       which no contact holds it
// Bodies never sleep. Contact forces are those of Bullet's projected Gauss-Seidel solver, without
// regularisation; penetration is removed without adding velocity. A moving concave mesh collides as
// its convex hull; links of one model collide like those of two.
#pragma once

#include <memory>
#include <vector>

#include "engine/model/scene.h"
#include "engine/robot/free_bodies.h"

namespace cprsim {

/// Indices of the bodies that nothing holds: not static, no joint and no rod attached.
std::vector<int> find_free_bodies(const Scene& scene);

/// @param free_bodies the bodies to integrate; all others that have colliders are obstacles.
/// @throws std::invalid_argument if a free body has a plane among its colliders or no mass.
std::unique_ptr<FreeBodies> make_bullet_world(const Scene& scene,
                                              const std::vector<int>& free_bodies);

}  // namespace cprsim
