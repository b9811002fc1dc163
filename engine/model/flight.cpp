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
  const std::size_t n = scene.bodies.size();
  std::vector<char> among(n, 0);
  if (!scene.effects.has(Effect::kContact) || scene.rods.empty() ||
      scene.simulation.mode != Mode::kDynamic)
    return among;
  const std::vector<char> flying = flying_bodies(scene);
  const auto can = [&](std::size_t b) {
    const BodySpec& body = scene.bodies[b];
    return flying[b] && !(body.linear_decay > 0) && !(body.angular_decay > 0);
  };
  const auto held = [&](std::size_t b) { return !flying[b] && !scene.bodies[b].is_static; };
  std::vector<std::size_t> next;
  for (std::size_t b = 0; b < n; ++b) {
    if (!can(b)) continue;
    bool meets = touched_by_rods(scene, scene.bodies[b]);
    for (std::size_t other = 0; other < n && !meets; ++other)
      meets = held(other) && may_touch(scene.bodies[b], scene.bodies[other]);
    if (!meets) continue;
    among[b] = 1;
    next.push_back(b);
  }
  // what touches one of them is one of them
  while (!next.empty()) {
    const std::size_t b = next.back();
    next.pop_back();
    for (std::size_t other = 0; other < n; ++other) {
      if (among[other] || !can(other) || !may_touch(scene.bodies[b], scene.bodies[other])) continue;
      among[other] = 1;
      next.push_back(other);
    }
  }
  return among;
}

}  // namespace cprsim
