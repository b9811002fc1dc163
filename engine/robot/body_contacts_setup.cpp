// SPDX-License-Identifier: BSD-3-Clause
// Which bodies may touch which.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/model/flight.h"
#include "engine/model/touch.h"
#include "engine/robot/body_contacts.h"

namespace cprsim {
namespace {

// of its size: what a body sinks by under its own weight
constexpr double kGive = 2e-7;
// m/s², where there is no gravity
constexpr double kWeight = 1;

}  // namespace

BodyContacts::BodyContacts(Robot& robot, const MeshOf& mesh_of) : robot_(robot) {
  const Scene& scene = *robot.scene;
  friction_ = scene.effects.has(Effect::kFriction);
  const std::vector<char> among = bodies_among_rods(scene);
  for (const RigidBody& body : robot.bodies)
    flies_.push_back(among[static_cast<std::size_t>(body.links.front())]);
  if (!scene.effects.has(Effect::kContact) || robot.plane) return;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    for (std::size_t j = 0; j < scene.bodies.size(); ++j) {
      const int a = robot.links[i].body, b = robot.links[j].body;
      const bool neither = a < 0 && b < 0, free = a == LinkPlace::kFree || b == LinkPlace::kFree;
      if (neither || free || a == b) continue;
      const ContactPair pair{ContactParty{false, static_cast<int>(i)},
                             ContactParty{false, static_cast<int>(j)}};
      if (!why_never_touching(scene, pair).empty()) continue;
      for (const ColliderSpec& c : scene.bodies[i].colliders)
        for (const ColliderSpec& d : scene.bodies[j].colliders)
          if (may_touch(c.surface, d.surface)) add_group(i, c, j, d, mesh_of);
    }
}

void BodyContacts::add_group(std::size_t link, const ColliderSpec& collider, std::size_t other_link,
                             const ColliderSpec& other, const MeshOf& mesh_of) {
  const Scene& scene = *robot_.scene;
  if (collider.shape.kind == ShapeKind::kEmpty || other.shape.kind == ShapeKind::kEmpty) return;
  Group group;
  group.first = robot_.probes.size();
  const LinkPlace &place = robot_.links[link], &other_place = robot_.links[other_link];
  const double gravity = robot_.gravity.norm();
  const auto weight = [&](int body) {
    if (body < 0) return std::numeric_limits<double>::infinity();
    return robot_.bodies[static_cast<std::size_t>(body)].mass * (gravity > 0 ? gravity : kWeight);
  };
  const double size =
      std::min(thickness_of(collider.shape, scene.meshes), thickness_of(other.shape, scene.meshes));
  for (BodyProbe probe : probes_of(collider, scene.meshes)) {
    probe.link = static_cast<int>(link);
    probe.other_link = static_cast<int>(other_link);
    probe.body = place.body;
    probe.other = other_place.body;
    probe.X_BC = place.X * probe.X_BC;
    probe.surface = {&other.shape, other_place.X * other.X_BC, mesh_of(other.shape)};
    probe.size = size;
    probe.thickness = thickness_of(other.shape, scene.meshes);
    probe.restitution = collider.surface.restitution * other.surface.restitution;
    if (friction_) probe.friction = collider.surface.friction * other.surface.friction;
    probe.give = kGive * size / std::min(weight(place.body), weight(other_place.body));
    robot_.probes.push_back(probe);
  }
  group.last = robot_.probes.size();
  if (group.last == group.first) return;
  const auto [centre, radius] = ball_around(collider, scene.meshes);
  group.centre = place.X * centre;
  group.radius = radius;
  const auto [other_centre, other_radius] = ball_around(other, scene.meshes);
  group.other_centre = other_place.X * other_centre;
  group.other_radius = other_radius;
  groups_.push_back(group);
}

}  // namespace cprsim
