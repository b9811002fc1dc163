// SPDX-License-Identifier: BSD-3-Clause
// Rigid bodies that neither a rod nor a joint holds. The engine asks somebody else to integrate
// them (collision/ answers with Bullet); no such object exists in a scene without free bodies.
#pragma once

#include <vector>

#include "engine/math/types.h"
#include "engine/run/snapshot.h"

namespace cprsim {

/// Momentary state of a body that the free ones may bump into.
struct BodyMotion {
  Pose X_WB;
  Vec3 linear_velocity{0, 0, 0};   ///< of the link origin, world axes
  Vec3 angular_velocity{0, 0, 0};  ///< world axes
};

class FreeBodies {
 public:
  virtual ~FreeBodies() = default;

  /// Advances all free bodies by `step` seconds. @param others motions of all bodies of the scene
  /// at the end of the step (indexed as Scene::bodies; entries of free bodies are ignored).
  virtual void advance(double step, const std::vector<BodyMotion>& others) = 0;

  /// Writes the free bodies' motions into `all`, indexed as Scene::bodies.
  virtual void read(std::vector<BodyMotion>& all) const = 0;

  virtual ContactSample contacts() const = 0;

  /// Kinetic plus gravitational energy, J.
  virtual double kinetic_energy() const = 0;
  virtual double gravity_energy() const = 0;
};

}  // namespace cprsim
