// SPDX-License-Identifier: BSD-3-Clause
// Contact of a convex shape with a plane, found in closed form. Bullet's own algorithm gives one
// support point per call and so lets a box that lands flat tip over its first corner; this one
// gives all the points that may carry: the corners of a polyhedron, both ends of a capsule, the
// rims of a cylinder, apex and rim of a cone, the exact lowest point of anything round.
#pragma once

#include <memory>

class btCollisionDispatcher;

namespace cprsim {

/// Registers the algorithm with a dispatcher; has to live as long as that.
class PlaneContact {
 public:
  explicit PlaneContact(btCollisionDispatcher& dispatcher);
  ~PlaneContact();
  PlaneContact(const PlaneContact&) = delete;
  PlaneContact& operator=(const PlaneContact&) = delete;

 private:
  struct Functions;
  std::unique_ptr<Functions> functions_;
};

}  // namespace cprsim
