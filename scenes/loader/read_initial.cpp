// SPDX-License-Identifier: BSD-3-Clause
// How the scene begins: shapes of rods and velocities of links.
#include <algorithm>

#include "scenes/loader/reading.h"
#include "scenes/loader/start_table.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

/// Links that a link cannot move without: welded to it, directly or through others; itself first.
std::vector<int> welded_to(const Scene& scene, int link) {
  std::vector<int> all{link};
  const auto has = [&](int body) { return std::find(all.begin(), all.end(), body) != all.end(); };
  for (std::size_t k = 0; k < all.size(); ++k)
    for (const JointSpec& joint : scene.joints) {
      if (joint.kind != JointKind::kFixed) continue;
      for (const auto& [a, b] : {std::pair{joint.parent, joint.child}, {joint.child, joint.parent}})
        if (a == all[k] && b != kWorld && !has(b)) all.push_back(b);
    }
  return all;
}

/// Why a link cannot move, which it cannot; empty if it can.
std::string what_holds(const Reading& r, int link, const std::vector<bool>& fixed) {
  const Scene& scene = r.scene;
  if (link == kWorld) return "it is fixed to the world";
  if (scene.bodies[at(link)].is_static) return "its model is static";
  if (!fixed[at(link)]) return {};
  const std::vector<int> group = welded_to(scene, link);
  const auto in_group = [&](int body) {
    return std::find(group.begin(), group.end(), body) != group.end();
  };
  for (const JointSpec& joint : scene.joints) {
    if (joint.kind != JointKind::kFixed) continue;
    const bool still = joint.parent == kWorld || joint.child == kWorld ||
                       scene.bodies[at(joint.parent)].is_static ||
                       scene.bodies[at(joint.child)].is_static;
    if (still && (in_group(joint.parent) || in_group(joint.child)))
      return "joint '" + joint.name + "', " + r.report.locate(joint.place) +
             ", welds it to what does not move";
  }
  return "it is welded to what does not move";
}

void read_velocity(Reading& r, const Node& node, const std::vector<bool>& fixed) {
  const Attribute& of = *node.attribute("of");
  const auto found = r.frames.find_outwards(0, of.value);
  if (!found || (found->kind != FrameKind::kLink && found->kind != FrameKind::kModel)) {
    r.report.bad_value("E403", node, of, "there is no link '" + of.value + "'",
                       mean(nearest_name(of.value, r.frames.known_names(0))));
    return;
  }
  const int body = r.frames.body_of(found->index);
  const std::string obstacle = what_holds(r, body, fixed);
  if (!obstacle.empty()) {
    r.report.bad_value("E512", node, of, "'" + of.value + "' cannot have a velocity: " + obstacle,
                       "leave <velocity> out, or hold the link by a joint that moves");
    return;
  }
  for (const int link : welded_to(r.scene, body)) {
    const BodySpec& other = r.scene.bodies[at(link)];
    if (!other.velocity_given) continue;
    r.report.error("E304", node,
                   "a second velocity of " + other.name +
                       (link == body ? "" : ", to which '" + of.value + "' is welded"),
                   "one link of those that are welded together has it");
    return;
  }
  if (r.scene.simulation.mode != Mode::kDynamic)
    r.report.warn("W513", node,
                  "the initial velocity of '" + of.value +
                      "' has no effect: the scene's mode is not dynamic");
  BodySpec& spec = r.scene.bodies[at(body)];
  spec.linear_velocity = vec3_of(node.child("linear"), Vec3::Zero());
  spec.angular_velocity = vec3_of(node.child("angular"), Vec3::Zero());
  spec.velocity_given = true;
}

}  // namespace

void read_initial(Reading& r, const Node& world) {
  const Node* simulation = world.child("cprsim:simulation");
  const Node* initial = simulation ? simulation->child("initial") : nullptr;
  if (!initial) return;
  read_start_table(r, *initial);
  const std::vector<bool> fixed = fixed_bodies(r.scene);
  for (const Node* node : initial->all("velocity"))
    read_velocity(r, *node, fixed);
}

}  // namespace cprsim
