// SPDX-License-Identifier: BSD-3-Clause
// Whether the contacts that a scene with rods asks for can be carried out.
#include <algorithm>

#include "engine/model/flight.h"
#include "scenes/loader/reading.h"

namespace cprsim {
namespace {

constexpr int kRodCaret = 12, kCollisionCaret = 10;  // length of "<cprsim:rod", "<collision"

bool round_section(const SectionSpec& section) {
  return section.shape == SectionShape::kCircle || section.shape == SectionShape::kAnnulus;
}

class ContactCheck {
 public:
  explicit ContactCheck(Reading& r)
      : r_(r), flying_(flying_bodies(r.scene)), among_rods_(bodies_among_rods(r.scene)) {}

  void run() {
    const Scene& scene = r_.scene;
    obstacles_ = std::any_of(scene.rods.begin(), scene.rods.end(),
                             [&](const RodSpec& rod) { return touches_itself(rod); });
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      for (const ColliderSpec& collider : scene.bodies[b].colliders)
        if (met(collider)) check(collider, scene.bodies[b].name, !flying_[b] || among_rods_[b]);
    check_softness();
    for (std::size_t a = 0; a < scene.rods.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (touches(scene.rods[a]) && touches(scene.rods[b]) &&
            may_touch(scene.rods[a].surface, scene.rods[b].surface))
          obstacles_ = true;
    if (!obstacles_) return;
    if (scene.planar_normal) {
      r_.scene.planar_normal.reset();
      r_.report.at(Severity::kNote, "W592", scene.simulation.place, 19,
                   "what touches is solved in space: <planar> makes nothing cheaper here, and what "
                   "is not symmetric about the plane may be pushed out of it");
    }
    for (const RodSpec& rod : scene.rods)
      if ((touches(rod) || touches_itself(rod)) && rod.sections.size() > 1)
        complain(rod.place, kRodCaret,
                 "contact of rods is available for sections that do not vary: those of '" +
                     rod.name + "' do",
                 "give the rod <without>contact</without>");
      else if ((touches(rod) || touches_itself(rod)) && !round_section(rod.section))
        complain(
            rod.place, kRodCaret,
            "contact of rods is available for round sections only: '" + rod.name + "' has another",
            "give the rod <without>contact</without>" +
                std::string(touches_itself(rod) ? " and <without>self_contact</without>" : ""));
  }

 private:
  bool touches(const RodSpec& rod) const {
    return r_.scene.effects.has(Effect::kContact) && !rod.lacks("contact");
  }

  bool touches_itself(const RodSpec& rod) const {
    return r_.scene.effects.has(Effect::kSelfContact) && !rod.lacks("self_contact");
  }

  void complain(const Place& place, int caret, const std::string& what, const std::string& hint) {
    r_.report.at(Severity::kError, "E520", place, caret, what).suggestion = hint;
  }

  /// Whether some rod may touch it.
  bool met(const ColliderSpec& collider) const {
    return collider.shape.kind != ShapeKind::kEmpty &&
           std::any_of(r_.scene.rods.begin(), r_.scene.rods.end(), [&](const RodSpec& rod) {
             return touches(rod) && may_touch(rod.surface, collider.surface);
           });
  }

  /// A damper needs a spring beside it, on one side or the other.
  void check_softness() {
    bool springs = false;
    for (const RodSpec& rod : r_.scene.rods)
      springs = springs || rod.surface.stiffness > 0;
    for (const BodySpec& body : r_.scene.bodies)
      for (const ColliderSpec& collider : body.colliders)
        springs = springs || collider.surface.stiffness > 0;
    if (springs) return;
    for (const RodSpec& rod : r_.scene.rods)
      if (rod.surface.damping > 0)
        r_.report.at(Severity::kNote, "W592", rod.place, kRodCaret,
                     "<kd> of '" + rod.name + "' damps nothing: without <kp> contact is rigid");
  }

  void check(const ColliderSpec& collider, const std::string& body, bool within_reach) {
    const std::string name = "'" + body + "::" + collider.name + "'";
    if (!within_reach) {
      r_.report.at(Severity::kWarning, "W506", collider.place, kCollisionCaret,
                   "rods pass through " + name +
                       ", which flies freely: they touch such a body in a dynamic scene, and if no "
                       "<velocity_decay> slows it");
      return;
    }
    obstacles_ = true;
    if (collider.surface.restitution > 0)
      r_.report.at(Severity::kNote, "W592", collider.place, kCollisionCaret,
                   "the restitution of " + name +
                       " is not for rods: how they bounce follows from their elasticity");
  }

  Reading& r_;
  std::vector<char> flying_, among_rods_;
  bool obstacles_ = false;
};

/// Only contact with rods gives.
void check_hard_links(Reading& r) {
  const Scene& scene = r.scene;
  const bool contact = scene.effects.has(Effect::kContact);
  for (const BodySpec& body : scene.bodies)
    for (const ColliderSpec& collider : body.colliders) {
      const SurfaceSpec& surface = collider.surface;
      const bool soft = surface.stiffness > 0 || surface.damping > 0;
      const bool by_rods =
          std::any_of(scene.rods.begin(), scene.rods.end(), [&](const RodSpec& rod) {
            return !rod.lacks("contact") && may_touch(rod.surface, surface);
          });
      if (soft && contact && !by_rods)
        r.report.at(Severity::kNote, "W592", collider.place, kCollisionCaret,
                    "<kp> and <kd> of '" + body.name + "::" + collider.name +
                        "' are for contact with rods: links among themselves are hard");
    }
}

}  // namespace

void check_contact(Reading& r) {
  const bool asked =
      r.scene.effects.has(Effect::kContact) || r.scene.effects.has(Effect::kSelfContact);
  if (asked && !r.scene.rods.empty()) ContactCheck(r).run();
  check_hard_links(r);
}

}  // namespace cprsim
