// SPDX-License-Identifier: BSD-3-Clause
// Names to channels. A pattern splits into an entity, an optional point on a rod and a rest:
//   robot::leg_*(s=0.5).position.x  ->  robot::leg_* | 0.5 | position.x
// Every entity has a list of scalar names; the rest selects those that it matches as a whole or up
// to a dot. Of these `pose` stands for position and orientation, `wrench` groups force and moment,
// and `shape` stands for eleven points. `contact(a,b).rest` is apart: two names, then the rest.
#include "engine/model/channel.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/model/channel_list.h"
#include "engine/model/scene.h"

namespace cprsim {

namespace {

constexpr int kShapePoints = 11;

void add_joint(ChannelList& list, const JointSpec& joint) {
  const bool ball = joint.kind == JointKind::kBall;
  const int count = ball ? 3 : freedom_count(joint.kind);
  const auto add = [&](const char* name, Quantity quantity, const char* turn, const char* slide) {
    for (int i = 0; i < count; ++i) {
      std::string suffix = name;
      if (ball) suffix += std::string(".") + kAxes[i];
      if (!ball && count > 1) suffix += "." + std::to_string(i + 1);
      list.add(suffix, quantity, i, slides(joint.kind, i) ? slide : turn);
    }
  };
  add("position", Quantity::kJointPosition, "rad", "m");
  add("velocity", Quantity::kJointVelocity, "rad/s", "m/s");
  add("effort", Quantity::kJointEffort, "N m", "N");
  bool limited = false;
  for (int i = 0; i < freedom_count(joint.kind); ++i)
    limited = limited || axis_of(joint, i).limited();
  if (limited) add("limit", Quantity::kJointLimit, "N m", "N");
}

void add_sums(ChannelList& list, const Scene& scene, ChannelEntity kind) {
  if (kind == ChannelEntity::kEnergy) {
    list.add("kinetic", Quantity::kEnergyKinetic);
    list.add("elastic", Quantity::kEnergyElastic);
    list.add("gravity", Quantity::kEnergyGravity);
    if (scene.effects.has(Effect::kMagnetic)) list.add("magnetic", Quantity::kEnergyMagnetic);
    list.add("dissipated", Quantity::kEnergyDissipated);
    list.add("work", Quantity::kEnergyWork);
    list.add("total", Quantity::kEnergyTotal);
    list.add("balance", Quantity::kEnergyBalance);
  } else if (kind == ChannelEntity::kSolver) {
    list.add("iterations", Quantity::kSolverIterations);
    list.add("residual", Quantity::kSolverResidual);
    list.add("step", Quantity::kSolverStep);
    list.add("wall_time", Quantity::kSolverWallTime);
  } else {
    list.add("count", Quantity::kContactCount);
    list.add("penetration", Quantity::kContactPenetration);
    list.add("force", Quantity::kContactForce);
    list.add("friction", Quantity::kContactFriction);
    list.add("slip", Quantity::kContactSlip);
  }
}

// every scalar of an entity but those of arbitrary points of a rod
std::vector<ChannelScalar> scalars_of(const Scene& scene, const NamedEntity& entity) {
  ChannelList list(entity);
  switch (entity.kind) {
    case ChannelEntity::kBody:
    case ChannelEntity::kFrame:
      list.add_vector("position", Quantity::kPosition);
      list.add_vector("orientation", Quantity::kOrientation, 4);
      list.add_vector("linear_velocity", Quantity::kLinearVelocity);
      list.add_vector("angular_velocity", Quantity::kAngularVelocity);
      break;
    case ChannelEntity::kJoint:
      add_joint(list, scene.joints[static_cast<std::size_t>(entity.index)]);
      break;
    case ChannelEntity::kRod:
    case ChannelEntity::kRodPoint:
      list.add("length", Quantity::kLength);
      list.add_point("base", 0);
      list.add_point("tip", 1);
      break;
    case ChannelEntity::kTendon:
      list.add("tension", Quantity::kTension);
      list.add("end_tension", Quantity::kEndTension);
      list.add("displacement", Quantity::kDisplacement);
      break;
    default:
      add_sums(list, scene, entity.kind);
  }
  return std::move(list.scalars);
}

std::vector<NamedEntity> entities_of(const Scene& scene) {
  std::vector<NamedEntity> all;
  const auto add = [&](const std::string& name, ChannelEntity kind, std::size_t index) {
    all.push_back({name, kind, static_cast<int>(index)});
  };
  for (std::size_t k = 0; k < scene.bodies.size(); ++k)
    add(scene.bodies[k].name, ChannelEntity::kBody, k);
  for (std::size_t k = 0; k < scene.frames.size(); ++k)
    add(scene.frames[k].name, ChannelEntity::kFrame, k);
  for (std::size_t k = 0; k < scene.joints.size(); ++k)
    add(scene.joints[k].name, ChannelEntity::kJoint, k);
  for (std::size_t k = 0; k < scene.rods.size(); ++k)
    add(scene.rods[k].name, ChannelEntity::kRod, k);
  for (std::size_t k = 0; k < scene.tendons.size(); ++k)
    add(scene.tendons[k].name, ChannelEntity::kTendon, k);
  all.push_back({"energy", ChannelEntity::kEnergy, 0});
  all.push_back({"solver", ChannelEntity::kSolver, 0});
  all.push_back({"contact", ChannelEntity::kContact, 0});
  return all;
}

std::string point_suffix(double s) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, s);
  return "(s=" + (error == std::errc() ? std::string(buffer, end) : std::string("?")) + ")";
}

struct Pattern {
  std::string_view entity, rest;
  bool at_point = false;
  double s = 0;
  bool valid = true;
};

Pattern split(std::string_view text) {
  Pattern p;
  const std::size_t open = text.find("(s=");
  if (open == std::string_view::npos) {
    const std::size_t dot = text.find('.');
    p.valid = dot != std::string_view::npos && dot > 0;
    if (!p.valid) return p;
    p.entity = text.substr(0, dot);
    p.rest = text.substr(dot + 1);
    return p;
  }
  const std::size_t close = text.find(").", open);
  p.valid = open > 0 && close != std::string_view::npos;
  if (!p.valid) return p;
  p.entity = text.substr(0, open);
  p.rest = text.substr(close + 2);
  p.at_point = true;
  const std::string_view number = text.substr(open + 3, close - open - 3);
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), p.s);
  p.valid = error == std::errc() && end == number.data() + number.size() && p.s >= 0 && p.s <= 1;
  return p;
}

// "tip.pose" -> "tip.position", "tip.orientation"
std::vector<std::string> expand_pose(std::string_view rest) {
  constexpr std::string_view kPose = "pose";
  const std::size_t found = rest.find(kPose);
  const bool whole = found != std::string_view::npos && (found == 0 || rest[found - 1] == '.') &&
                     found + kPose.size() == rest.size();
  if (!whole) return {std::string(rest)};
  const std::string head(rest.substr(0, found));
  return {head + "position", head + "orientation"};
}

void pick(const std::vector<ChannelScalar>& scalars, const std::string& head, std::string_view rest,
          std::vector<Channel>& out) {
  for (const std::string& wanted : expand_pose(rest))
    for (const ChannelScalar& scalar : scalars)
      if (selects_channel(head + wanted, scalar.suffix)) out.push_back(scalar.channel);
}

void pick_point(const NamedEntity& rod, double s, std::string_view rest,
                std::vector<Channel>& out) {
  ChannelList list(rod);
  const std::string where = point_suffix(s);
  list.add_point(where, s);
  pick(list.scalars, where + ".", rest, out);
}

void pick_from(const Scene& scene, const NamedEntity& entity, const Pattern& pattern,
               std::vector<Channel>& out) {
  const bool rod = entity.kind == ChannelEntity::kRod;
  if (pattern.at_point) {
    if (rod) pick_point(entity, pattern.s, pattern.rest, out);
    return;
  }
  const bool shape = pattern.rest == "shape";
  if (rod && (shape || pattern.rest == "curvature" || pattern.rest == "strain")) {
    for (int k = 0; k < kShapePoints; ++k)
      pick_point(entity, k / double(kShapePoints - 1), shape ? "position" : pattern.rest, out);
    return;
  }
  pick(scalars_of(scene, entity), "", pattern.rest, out);
}

// names without their components: what people write
std::vector<std::string> stems_of(const Scene& scene, const NamedEntity& entity) {
  std::vector<std::string> stems;
  for (const ChannelScalar& scalar : scalars_of(scene, entity)) {
    std::string name = scalar.channel.name;
    const bool component = name.size() > 2 && name[name.size() - 2] == '.';
    if (component) name.resize(name.size() - 2);
    if (stems.empty() || stems.back() != name) stems.push_back(std::move(name));
  }
  if (stems.empty()) return stems;
  if (entity.kind == ChannelEntity::kBody || entity.kind == ChannelEntity::kFrame)
    stems.push_back(entity.name + ".pose");
  if (entity.kind == ChannelEntity::kRod)
    for (const char* more : {".base.pose", ".tip.pose", ".base.wrench", ".tip.wrench", ".shape",
                             ".curvature", ".strain"})
      stems.push_back(entity.name + more);
  return stems;
}

}  // namespace

std::vector<Channel> find_channels(const Scene& scene, std::string_view pattern) {
  std::vector<Channel> channels;
  if (const PairPattern pair = pair_pattern(pattern); pair.is_one) {
    return find_pair_channels(scene, pair);
  }
  const Pattern parts = split(pattern);
  if (!parts.valid) return channels;
  for (const NamedEntity& entity : entities_of(scene))
    if (glob_fits(parts.entity, entity.name)) pick_from(scene, entity, parts, channels);
  return channels;
}

std::vector<std::string> nearest_channels(const Scene& scene, std::string_view pattern,
                                          std::size_t count) {
  constexpr std::size_t kLongest = 200;
  pattern = pattern.substr(0, kLongest);
  if (const PairPattern pair = pair_pattern(pattern); pair.is_one)
    return nearest_pair_channels(scene, pair, count);
  // the entity decides first, so that a wrong quantity is answered with that entity's own
  const auto entity_of = [](std::string_view name) {
    return name.substr(0, name.find_first_of(".("));
  };
  const std::string_view wanted = entity_of(pattern);
  std::vector<std::pair<int, std::string>> ranked;
  for (const NamedEntity& entity : entities_of(scene)) {
    const int apart = 2 * letters_apart(wanted, entity.name);
    for (const std::string& stem : stems_of(scene, entity))
      ranked.emplace_back(apart + letters_apart(pattern, stem), stem);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (std::size_t k = 0; k < ranked.size() && k < count; ++k)
    names.push_back(ranked[k].second);
  return names;
}

}  // namespace cprsim
