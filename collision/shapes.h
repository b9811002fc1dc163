// SPDX-License-Identifier: BSD-3-Clause
// Collision shapes of a scene as Bullet shapes, in world units of 1 mm and without margins: with
// double precision this finds gaps to 3e-10 m, in metres or with margins it does not. An ellipsoid
// is a shape of its own with the exact support point (a scaled btMultiSphereShape does not have
// it).
#pragma once

#include <memory>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/body_spec.h"
#include "engine/model/geometry.h"

class btCollisionShape;

namespace cprsim {

/// Makes shapes and owns them.
class Shapes {
 public:
  explicit Shapes(const std::vector<MeshSpec>& meshes);
  ~Shapes();
  Shapes(const Shapes&) = delete;
  Shapes& operator=(const Shapes&) = delete;

  /// Nothing to touch.
  btCollisionShape* empty();

  /// A shape for something that Bullet does not integrate: meshes keep their triangles.
  btCollisionShape* for_obstacle(const ShapeSpec& shape);

  /// One shape for all colliders of a body that Bullet integrates, in the axes G of its centre of
  /// mass; child k is collider k. A mesh becomes its convex hull.
  /// @throws std::invalid_argument for a plane, which has no inside to fall with.
  btCollisionShape* for_free_body(const BodySpec& body, const Pose& X_BG);

 private:
  btCollisionShape* tube(const ShapeSpec& spec);

  struct Store;
  const std::vector<MeshSpec>& meshes_;  // read while building only
  std::unique_ptr<Store> store_;
};

}  // namespace cprsim
