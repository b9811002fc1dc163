// SPDX-License-Identifier: BSD-3-Clause
// Bullet's substep with contact rules before its solver and, after it, the corrections (1) and (2)
// of collision/bullet_world.h to its first-order motion.
#pragma once

#include <memory>
#include <vector>

#include "collision/free_body.h"

class btBroadphaseInterface;
class btCollisionConfiguration;
class btConstraintSolver;
class btDiscreteDynamicsWorld;
class btDispatcher;

namespace cprsim {

/// The parts of a world that Bullet wants from outside; they outlive it.
struct WorldParts {
  btDispatcher* dispatcher = nullptr;
  btBroadphaseInterface* broadphase = nullptr;
  btConstraintSolver* solver = nullptr;
  btCollisionConfiguration* configuration = nullptr;
};

/// @param bodies those whose motion is corrected: element k has the user index k. Outlives the
/// world.
std::unique_ptr<btDiscreteDynamicsWorld> make_stepper(const WorldParts& parts,
                                                      std::vector<FreeBody>& bodies, bool friction);

}  // namespace cprsim
