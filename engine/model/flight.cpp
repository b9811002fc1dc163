// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/flight.h"

#include <algorithm>

namespace cprsim {
namespace {

bool touches(const RodSpec& rod) {
  return std::find(rod.without.begin(), rod.without.end(), "contact") == rod.without.end();
}

bool touched_by_rods(const Scene& scene, const BodySpec& body) {
  return std::any_of(body.colliders.begin(), body.colliders.end(), [&](const ColliderSpec& c) {
    return c.shape.kind != ShapeKind::kEmpty &&
           std::any_of(scene.rods.begin(), scene.rods.end(), [&](const RodSpec& rod) {
             return touches(rod) && may_touch(rod.surface, c.surface);
           });
  });
}

bool may_touch(const BodySpec& a, const BodySpec& b) {
  for (const ColliderSpec& c : a.colliders)
    for (const ColliderSpec& d : b.colliders)
      if (c.shape.kind != ShapeKind::kEmpty && d.shape.kind != ShapeKind::kEmpty &&
          may_touch(c.surface, d.surface))
        return true;
  return false;
}

}  // namespace

bool may_touch(const SurfaceSpec& a, const SurfaceSpec& b) {
  return ((a.category_bitmask & b.collide_bitmask) | (b.category_bitmask & a.collide_bitmask)) != 0;
}

std::vector<char> flying_bodies(const Scene& scene) {
  std::vector<char> flying;
  for (const BodySpec& body : scene.bodies)
    flying.push_back(body.is_static ? 0 : 1);
  const auto hold = [&](int body) {
    if (body != kWorld) flying.at(static_cast<std::size_t>(body)) = 0;
  };
  for (const JointSpec& joint : scene.joints) {
    hold(joint.parent);
    hold(joint.child);
  }
  for (const RodSpec& rod : scene.rods) {
    if (rod.base.joint != EndJoint::kFree) hold(rod.base.at.body);
    if (rod.tip.joint != EndJoint::kFree) hold(rod.tip.at.body);
  }
  return flying;
}

std::vector<char> bodies_among_rods(const Scene& scene) {
  std::vector<char> among(scene.bodies.size(), 0);
  if (!scene.effects.has(Effect::kContact) || scene.rods.empty() ||
      scene.simulation.mode != Mode::kDynamic)
    return among;
  const std::vector<char> flying = flying_bodies(scene);
  for (std::size_t b = 0; b < among.size(); ++b) {
    const BodySpec& body = scene.bodies[b];
    if (!flying[b] || body.linear_decay > 0 || body.angular_decay > 0 ||
        !touched_by_rods(scene, body))
      continue;
    among[b] = 1;
    for (std::size_t other = 0; other < among.size(); ++other)
      if (other != b && may_touch(body, scene.bodies[other])) among[b] = 0;
  }
  return among;
}

}  // namespace cprsim
