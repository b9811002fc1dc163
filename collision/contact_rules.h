// SPDX-License-Identifier: BSD-3-Clause
// Who touches whom, and how. Colliders 1 and 2 touch if (category_1 & collide_2) | (category_2 &
// collide_1) is not zero (SDF). Coefficients of friction and restitution of a pair are the products
// of the two colliders' (Bullet's rule). Bounces are made to conserve energy:
//   (1) the bounce takes place in the step in which the gap closes, with v_n⁺ = -e v_n⁻ + a_n dt
// a_n is the acceleration of gravity along the normal. If that is not outwards, there is no bounce.
#pragma once

#include <vector>

#include "engine/model/geometry.h"

class btDispatcher;

namespace cprsim {

/// What a collision object of Bullet carries as its user pointer.
struct Contactor {
  std::vector<SurfaceSpec> surfaces;  ///< one per child shape, or one
  bool free = false;                  ///< integrated by Bullet
};

/// True if some of their colliders may touch and one of the two is free.
bool may_touch(const Contactor& a, const Contactor& b);

/// Between collision detection and the contact solver: removes the points of colliders that may not
/// touch and sets the coefficients of the others for a step of dt.
void apply_contact_rules(btDispatcher& dispatcher, bool friction, double dt);

}  // namespace cprsim
