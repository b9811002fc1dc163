// SPDX-License-Identifier: BSD-3-Clause
// What each rod may touch.
#include <algorithm>
#include <stdexcept>

#include "engine/model/flight.h"
#include "engine/model/touch.h"
#include "engine/robot/contacts.h"

namespace cprsim {

RodContacts::RodContacts(Robot& robot)
    : robot_(robot), bodies_(robot, [this](const ShapeSpec& shape) { return mesh_of(shape); }) {
  const Scene& scene = *robot.scene;
  friction_ = scene.effects.has(Effect::kFriction);
  const bool contact = scene.effects.has(Effect::kContact),
             self_contact = scene.effects.has(Effect::kSelfContact);
  index_.assign(robot.rods.size(), -1);
  for (std::size_t r = 0; r < robot.rods.size(); ++r) {
    RobotRod& rod = robot.rods[r];
    Rod mine;
    mine.touches_others = contact && !rod.spec->lacks("contact");
    mine.touches_itself = self_contact && !rod.spec->lacks("self_contact");
    if (!mine.touches_others && !mine.touches_itself) continue;
    mine.rod = &rod;
    mine.index = r;
    mine.side = rod.model->touching();
    mine.radius = rod.section.half_width;
    if (mine.touches_others) add_colliders(mine);
    rods_.push_back(std::move(mine));
  }
  add_other_rods();
  add_rods_themselves();
  for (std::size_t i = 0; i < rods_.size(); ++i) {
    index_[rods_[i].index] = static_cast<int>(i);
    give_surfaces(rods_[i]);
  }
}

// Not of the bodies that hold the rod: what a joint joins is meant to be together.
void RodContacts::add_colliders(Rod& rod) {
  const Scene& scene = *robot_.scene;
  const RobotRod& own = *rod.rod;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const LinkPlace& place = robot_.links[i];
    const bool holds = place.body >= 0 && ((own.base_held && own.base.body == place.body) ||
                                           (own.tip_held && own.tip.body == place.body));
    if (place.body == LinkPlace::kFree || holds) continue;
    for (const ColliderSpec& collider : scene.bodies[i].colliders) {
      if (collider.shape.kind == ShapeKind::kEmpty ||
          !may_touch(collider.surface, own.spec->surface))
        continue;
      Obstacle obstacle;
      obstacle.name = scene.bodies[i].name + "::" + collider.name;
      obstacle.surface = {&collider.shape, place.X * collider.X_BC, mesh_of(collider.shape)};
      obstacle.plane = collider.shape.kind == ShapeKind::kPlane;
      obstacle.link = static_cast<int>(i);
      obstacle.body = std::max(place.body, -1);
      soften(collider.surface, own.spec->surface, obstacle);
      if (friction_) obstacle.friction = collider.surface.friction * own.spec->surface.friction;
      rod.obstacles.push_back(obstacle);
    }
  }
}

/// Its tree, built once.
const MeshDistance* RodContacts::mesh_of(const ShapeSpec& shape) {
  if (shape.kind != ShapeKind::kMesh) return nullptr;
  const std::vector<MeshSpec>& meshes = robot_.scene->meshes;
  meshes_.resize(meshes.size());
  const auto index = static_cast<std::size_t>(shape.mesh);
  if (!meshes_[index]) meshes_[index] = std::make_unique<MeshDistance>(meshes[index]);
  return meshes_[index].get();
}

// Rods that neither touch anything nor are touched are left alone.
void RodContacts::add_other_rods() {
  const Scene& scene = *robot_.scene;
  const auto may_meet = [&scene](const Rod& a, const Rod& b) {
    return a.touches_others && b.touches_others &&
           may_touch(a.rod->spec->surface, b.rod->spec->surface) &&
           !tie_between(scene, static_cast<int>(a.index), static_cast<int>(b.index));
  };
  std::vector<char> met(rods_.size(), 0);
  for (std::size_t a = 0; a < rods_.size(); ++a) {
    if (!rods_[a].obstacles.empty() || rods_[a].touches_itself) met[a] = 1;
    for (std::size_t b = a + 1; b < rods_.size(); ++b)
      if (may_meet(rods_[a], rods_[b])) met[a] = met[b] = 1;
  }
  std::vector<Rod> kept;
  for (std::size_t a = 0; a < rods_.size(); ++a)
    if (met[a]) kept.push_back(std::move(rods_[a]));
  rods_ = std::move(kept);
  for (std::size_t a = 0; a < rods_.size(); ++a)
    for (std::size_t b = a + 1; b < rods_.size(); ++b) {
      if (!may_meet(rods_[a], rods_[b])) continue;
      const SurfaceSpec &mine = rods_[a].rod->spec->surface, &other = rods_[b].rod->spec->surface;
      Obstacle obstacle;
      obstacle.name = rods_[b].rod->spec->name;
      obstacle.rod = static_cast<int>(b);
      if (friction_) obstacle.friction = mine.friction * other.friction;
      soften(mine, other, obstacle);
      rods_[a].obstacles.push_back(obstacle);
    }
}

void RodContacts::add_rods_themselves() {
  // diameters, and cells
  constexpr double kDiameters = 4, kCells = 1.5;
  for (std::size_t i = 0; i < rods_.size(); ++i) {
    Rod& rod = rods_[i];
    if (!rod.touches_itself || !rod.side) continue;
    double longest = 0;
    for (std::size_t c = 0; c + 1 < rod.side->contact_grid().size(); ++c)
      longest = std::max(longest, length(rod, c));
    rod.apart = std::max(kDiameters * 2 * rod.radius, kCells * longest);
    Obstacle obstacle;
    obstacle.name = "itself";
    obstacle.rod = static_cast<int>(i);
    obstacle.itself = true;
    const SurfaceSpec& surface = rod.rod->spec->surface;
    if (friction_) obstacle.friction = surface.friction * surface.friction;
    soften(surface, surface, obstacle);
    rod.obstacles.push_back(obstacle);
  }
}

// Springs in a row give together; dampers as in Gazebo, whose sum is taken.
void RodContacts::soften(const SurfaceSpec& a, const SurfaceSpec& b, Obstacle& obstacle) const {
  for (const SurfaceSpec* side : {&a, &b})
    if (side->stiffness > 0) obstacle.give += 1 / side->stiffness;
  obstacle.lag = obstacle.give * (a.damping + b.damping);
}

void RodContacts::give_surfaces(Rod& rod) {
  if (!rod.side)
    throw std::invalid_argument("rod '" + rod.rod->spec->name +
                                "' may touch something: no method in a plane can");
  std::vector<Surface> surfaces;
  bool rates = friction_;  // what neither rubs nor is damped needs none
  for (const Obstacle& obstacle : rod.obstacles) {
    rates = rates || obstacle.lag > 0;
    surfaces.push_back(obstacle.surface);
    robot_.rods_meet = robot_.rods_meet || !obstacle.fixed() || !rod.side->owns_forces();
  }
  rod.side->set_surfaces(surfaces, rod.radius, rates);
}

}  // namespace cprsim
