// SPDX-License-Identifier: BSD-3-Clause
// What the readers share, and the readers themselves, in the order in which they run. Each fills
// one part of the Scene from a validated tree; values are valid by then, names and physics are not.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/loader/frames.h"
#include "scenes/loader/load.h"
#include "scenes/loader/reporter.h"

namespace cprsim {

struct Reading {
  Scene& scene;
  FrameGraph& frames;
  Reporter& report;
  const LoadOptions& options;
  std::vector<std::string> folders;  ///< of each file, for what it names
  std::vector<std::string> roots;    ///< below which files may be opened
  std::map<std::string, Profile, std::less<>> profiles;
  std::map<std::string, int> mesh_index;  ///< file, scale and part -> Scene::meshes
  std::map<int, int> joint_of_vertex;     ///< frame vertex -> Scene::joints
  std::string expected_failure;
};

/// Values of validated elements; the fallback if the element is absent or broken.
double number_of(const Node* node, double fallback);
bool flag_of(const Node* node, bool fallback);
Vec3 vec3_of(const Node* node, const Vec3& fallback);
double number_attribute(const Node& node, std::string_view key, double fallback);
std::optional<double> optional_number(const Node& node, std::string_view key);

/// Of a solver, a rod or a rod class.
std::optional<Method> method_attribute(const Node& node);

void read_settings(Reading& reading, const Node& world);  // gravity, physics, effects, simulation
void read_bodies(Reading& reading, const Node& world);    // links
void read_joints(Reading& reading, const Node& world);    // rigid joints
void read_rods(Reading& reading, const Node& world);      // rods and their classes
void read_tendons(Reading& reading);                      // after the rods
void read_ties(Reading& reading);                         // likewise
void read_profiles(Reading& reading, const Node& world);
void read_actions(Reading& reading);                     // drives, loads
void read_initial(Reading& reading, const Node& world);  // shapes and velocities to begin with
void read_targets(Reading& reading);                     // after the drives
void read_magnetic_fields(Reading& reading, const Node& world);
void check_fields(Reading& reading, const Node& world);  // that they have something to act on
void read_views(Reading& reading, const Node& world);    // lights, cameras, surroundings
void read_outputs(Reading& reading, const Node& world);  // videos, records, expectations, sweeps
void read_expect(Reading& reading, const Node& node);
void read_sweep(Reading& reading, const Node& node, const Node& world);
void check_physics(Reading& reading);                    // what only the whole scene can tell
void check_tendons(Reading& reading);                    // that all are driven, and how
void check_ties(Reading& reading);                       // what tied rods may have besides
void check_contact(Reading& reading);                    // what rods can touch
void check_planar(Reading& reading, const Node& world);  // that nothing leaves the plane

/// A tendon as seen from a scope, and from its enclosing ones unless only_here.
std::optional<int> find_tendon(const Reading& reading, int scope, std::string_view name,
                               bool only_here = false);

/// Of several <physics> the default one, else the first; null: none.
const Node* chosen_physics(const Node& world);

/// Channels that an attribute (none: the element's text) names; an error if there is none.
std::vector<Channel> channels_of(Reading& reading, const Node& node, const Attribute* attribute);

/// Tells of pairs in `contact(a,b)` that cannot touch.
void warn_of_pairs(Reading& reading, const Node& node, const std::vector<Channel>& channels);

/// Of a rod or its class, all that stand in `owner`.
void read_magnets(Reading& reading, const Node& owner, RodSpec& rod);
void read_temperature(Reading& reading, const Node& node, RodSpec& rod);

/// From a named profile or shapes of its own. @return whether the element has either
bool read_time_function(Reading& reading, const Node& node, Profile& profile);

/// Summed shapes of time that are children of `node`.
Profile read_shapes(Reading& reading, const Node& node);

/// Look of a <material> over a default one.
Look read_look(const Node* material, Look look);
SurfaceSpec read_surface(const Node* node);

/// True if nothing can move the body: static, or welded to the world.
std::vector<bool> fixed_bodies(const Scene& scene);

/// Calls visit(scope, node) for the world and every model.
template <class Visit>
void for_each_scope(const Reading& reading, Visit visit) {
  for (int s = 0; s < static_cast<int>(reading.frames.scopes().size()); ++s)
    visit(s, *reading.frames.scopes()[static_cast<std::size_t>(s)].node);
}

/// "did you mean x?" or nothing.
std::string mean(const std::string& name);

}  // namespace cprsim
