// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/rod_ends.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "engine/model/rest_shape.h"
#include "engine/model/start_pose.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {
namespace {

/// The rod's end, "leg::tip", that an end is attached to; nothing if that is something else.
std::optional<RodOnRod> owner_of(Reading& r, const Node& end, int scope) {
  const Attribute* a = end.attribute("attached_to");
  const std::size_t colons = a ? a->value.rfind("::") : std::string::npos;
  if (colons == std::string::npos) return std::nullopt;
  const std::string which = a->value.substr(colons + 2);
  if (which != "base" && which != "tip") return std::nullopt;
  const auto owner = r.frames.find_outwards(scope, a->value.substr(0, colons));
  if (!owner || owner->kind != FrameKind::kRod) return std::nullopt;
  RodOnRod on_rod;
  on_rod.owner = static_cast<std::size_t>(owner->index);
  on_rod.on_tip = which == "tip";
  on_rod.node = &end;
  const Node* pose = end.child("pose");
  if (pose && !pose->value("relative_to").empty())
    r.report.error("E310", *pose, "the <pose> of an end on a rod is relative to that rod's end");
  on_rod.X_OE = read_pose(pose, r.report);
  return on_rod;
}

/// Though perhaps not as it should be.
bool is_written(const Node& node, std::string_view name) {
  return std::any_of(node.children.begin(), node.children.end(),
                     [&](const auto& child) { return child->name == name; });
}

std::optional<Named> end_frame(Reading& r, const Node& end, int scope) {
  const Attribute* a = end.attribute("attached_to");
  if (!a || a->value.empty()) return std::nullopt;
  const auto found = r.frames.find_outwards(scope, a->value);
  if (found && found->kind != FrameKind::kRod) return found;
  if (found)
    r.report.bad_value("E403", end, *a, "'" + a->value + "' is a rod",
                       "name one of its ends: " + a->value + "::base or " + a->value + "::tip");
  else
    r.report.bad_value("E403", end, *a, "there is no link or frame '" + a->value + "'",
                       mean(nearest_name(a->value, r.frames.known_names(scope))));
  return std::nullopt;
}

RodEndSpec read_end(Reading& r, const Node& node, int scope, std::optional<RodOnRod>& on_rod) {
  RodEndSpec end;
  end.place = node.place;
  const std::string_view joint = node.value("joint");
  if (joint == "fixed") end.joint = EndJoint::kFixed;
  if (joint == "revolute") end.joint = EndJoint::kRevolute;
  if (joint == "ball") end.joint = EndJoint::kBall;
  if (joint == "universal") end.joint = EndJoint::kUniversal;
  end.spin_free = node.value("spin") == "free";
  on_rod = owner_of(r, node, scope);
  std::optional<Named> named;
  if (!on_rod) {
    named = end_frame(r, node, scope);
    if (!named) return end;
  }
  const Pose X_WE = named ? r.frames.posed(node, scope, named->index) : Pose{};
  if (named) end.at = r.frames.frame_ref(r.frames.body_of(named->index), X_WE);
  const Node* axis = node.child("axis");
  if (end.joint == EndJoint::kRevolute && !axis && !is_written(node, "axis"))
    r.report.missing("E303", node, "a revolute <" + node.name + "> needs an <axis>");
  if (end.joint != EndJoint::kRevolute && axis)
    r.report.error("E310", *axis, "only a revolute end has an axis");
  const Node* xyz = axis ? axis->child("xyz") : nullptr;
  if (!xyz) return end;
  end.axis = vec3_of(xyz, end.axis);
  if (end.axis.norm() < 1e-9) r.report.bad_text("E506", *xyz, "the axis has length 0");
  if (const Attribute* in = xyz->attribute("expressed_in"); in && !in->value.empty()) {
    const auto frame = r.frames.find_outwards(scope, in->value);
    if (!named)
      r.report.error("E310", *xyz, "the axis of an end on a rod is in the axes of that rod's end");
    else if (!frame || frame->kind == FrameKind::kRod)
      r.report.bad_value("E403", *xyz, *in, "there is no frame '" + in->value + "'");
    else
      end.axis = X_WE.R.transpose() * r.frames.X_W(frame->index).R * end.axis;
  }
  end.axis.normalize();
  return end;
}

/// What rods on that end of `owner` are attached to; nothing, with an error, if that turns in a
/// joint.
std::optional<FrameRef> end_of(Reading& r, const RodOnRod& on_rod) {
  Scene& scene = r.scene;
  RodSpec& owner = scene.rods[on_rod.owner];
  RodEndSpec& end = on_rod.on_tip ? owner.tip : owner.base;
  if (end.joint == EndJoint::kFixed && !end.spin_free) return end.at;
  if (end.joint != EndJoint::kFree) {
    r.report.bad_value("E520", *on_rod.node, *on_rod.node->attribute("attached_to"),
                       "that end of '" + owner.name + "' turns in its own joint",
                       "attach both to a light link");
    return std::nullopt;
  }
  BodySpec link;
  link.name = owner.name + (on_rod.on_tip ? "::tip" : "::base");
  link.place = on_rod.node->place;
  link.X_WB = start_pose(scene, owner.base.at);
  if (on_rod.on_tip) link.X_WB = link.X_WB * RestShape(owner).unloaded(1, owner.length);
  end.joint = EndJoint::kFixed;
  end.at = {static_cast<int>(scene.bodies.size()), Pose{}};
  scene.bodies.push_back(std::move(link));
  return end.at;
}

}  // namespace

void read_rod_ends(Reading& r, const RodEntry& entry, RodSpec& rod,
                   std::vector<RodOnRod>& on_rods) {
  const Node* base = entry.node->child("base");
  const Node* tip = entry.node->child("tip");
  const auto read = [&](const Node* node, bool at_tip) {
    if (!node) return;
    std::optional<RodOnRod> on_rod;
    (at_tip ? rod.tip : rod.base) = read_end(r, *node, entry.scope, on_rod);
    if (!on_rod) return;
    on_rod->rod = r.scene.rods.size();
    on_rod->at_tip = at_tip;
    on_rods.push_back(*on_rod);
  };
  read(base, false);
  read(tip, true);
  if (base && base->value("joint") == "free" && r.scene.simulation.mode != Mode::kDynamic)
    r.report.bad_value("E520", *base, *base->attribute("joint"), "a free base has no equilibrium",
                       "available: fixed, revolute, ball, universal; free in a dynamic scene");
}

void join_rods(Reading& r, std::vector<RodOnRod> on_rods) {
  const auto waits = [&](std::size_t rod, bool at_tip) {
    return std::any_of(on_rods.begin(), on_rods.end(), [&](const RodOnRod& other) {
      return other.rod == rod && other.at_tip == at_tip;
    });
  };
  while (!on_rods.empty()) {
    // a tip's place follows from the base's, or is where it is attached
    const auto next = std::find_if(on_rods.begin(), on_rods.end(), [&](const RodOnRod& on_rod) {
      return !waits(on_rod.owner, false) && !(on_rod.on_tip && waits(on_rod.owner, true));
    });
    if (next == on_rods.end()) {
      const RodOnRod& one = on_rods.front();
      r.report.bad_value("E405", *one.node, *one.node->attribute("attached_to"),
                         "rods are attached to each other in a circle");
      return;
    }
    if (const auto place = end_of(r, *next)) {
      RodSpec& rod = r.scene.rods[next->rod];
      (next->at_tip ? rod.tip : rod.base).at = {place->body, place->X_BF * next->X_OE};
    }
    on_rods.erase(next);
  }
}

}  // namespace cprsim
