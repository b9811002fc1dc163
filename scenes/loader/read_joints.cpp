// SPDX-License-Identifier: BSD-3-Clause
// Rigid joints. At q = 0 the joint's frame is one and the same seen from both sides: X_WP X_PJ =
// X_WC X_CJ = X_WJ.
#include <algorithm>
#include <cmath>

#include "scenes/loader/reading.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

// a side of a joint: a vertex, or -1 after an error
int side(Reading& r, const Node& joint, int scope, const char* element) {
  const Node* node = joint.child(element);
  if (!node) return -1;
  if (node->text == "world") {
    if (std::string_view(element) == "child") {
      r.report.bad_text("E407", *node, "the world cannot be the child of a joint");
      return -1;
    }
    return r.frames.scopes()[0].self;
  }
  const auto found = r.frames.find(scope, node->text);
  if (found && found->kind != FrameKind::kRod) return found->index;
  r.report.bad_text("E403", *node,
                    "there is no link, frame, joint or model '" + node->text + "' here",
                    mean(nearest_name(node->text, r.frames.known_names(scope))));
  return -1;
}

Vec3 axis_in_joint(Reading& r, const Node& axis, int scope, int vertex) {
  const Node* xyz = axis.child("xyz");
  Vec3 direction = vec3_of(xyz, Vec3::UnitZ());
  if (direction.norm() < 1e-9) {
    r.report.bad_text("E506", *xyz, "the joint's axis has length 0");
    return Vec3::UnitZ();
  }
  const std::string_view in = xyz ? xyz->value("expressed_in") : std::string_view();
  if (!in.empty()) {
    auto found = r.frames.find(scope, in);
    if (in == "world") found = Named{FrameKind::kRoot, r.frames.scopes()[0].self};
    if (found && found->kind != FrameKind::kRod)
      direction = r.frames.X_W(vertex).R.transpose() * r.frames.X_W(found->index).R * direction;
    else
      r.report.bad_value("E403", *xyz, *xyz->attribute("expressed_in"),
                         "there is no frame '" + std::string(in) + "' here",
                         mean(nearest_name(in, r.frames.known_names(scope))));
  }
  return direction.normalized();
}

void read_axis(Reading& r, const Node& axis, AxisSpec& joint) {
  constexpr double kUnlimited = 1e16;  // SDF's own way to write infinity
  if (const Node* limit = axis.child("limit")) {
    const double inf = HUGE_VAL;
    joint.lower = number_of(limit->child("lower"), -inf);
    joint.upper = number_of(limit->child("upper"), inf);
    joint.effort_limit = number_of(limit->child("effort"), inf);
    joint.velocity_limit = number_of(limit->child("velocity"), inf);
    if (joint.lower <= -kUnlimited) joint.lower = -inf;
    if (joint.upper >= kUnlimited) joint.upper = inf;
    if (joint.effort_limit < 0 || joint.effort_limit >= kUnlimited) joint.effort_limit = inf;
    if (joint.velocity_limit < 0 || joint.velocity_limit >= kUnlimited) joint.velocity_limit = inf;
    if (const Node* stiffness = limit->child("stiffness"))
      joint.stop_stiffness = number_of(stiffness, 1);
    joint.stop_dissipation = number_of(limit->child("dissipation"), 1);
    if (joint.lower > joint.upper)
      r.report.error("E306", *limit,
                     "the lower limit, " + format_number(joint.lower) +
                         ", lies above the upper one, " + format_number(joint.upper));
  }
  if (const Node* dynamics = axis.child("dynamics")) {
    joint.damping = number_of(dynamics->child("damping"), 0);
    joint.friction = number_of(dynamics->child("friction"), 0);
    joint.spring_stiffness = number_of(dynamics->child("spring_stiffness"), 0);
    joint.spring_reference = number_of(dynamics->child("spring_reference"), 0);
  }
}

JointKind kind_of(std::string_view type) {
  if (type == "revolute") return JointKind::kRevolute;
  if (type == "continuous") return JointKind::kContinuous;
  if (type == "prismatic") return JointKind::kPrismatic;
  if (type == "ball") return JointKind::kBall;
  if (type == "universal") return JointKind::kUniversal;
  if (type == "screw") return JointKind::kScrew;
  if (type == "cylindrical") return JointKind::kCylindrical;
  if (type == "planar") return JointKind::kPlanar;
  return JointKind::kFixed;
}

bool mentioned(const Node& joint, std::string_view element) {
  return std::any_of(joint.children.begin(), joint.children.end(),
                     [&](const auto& part) { return part->name == element; });
}

/// What the axes of a kind must be like to each other.
void check_directions(Reading& r, const Node& node, const JointSpec& joint) {
  constexpr double kNearly = 1e-6;
  const Vec3 &a = joint.axis, &b = joint.second.axis;
  const Node* second = node.child("axis2");
  if (!second) return;
  if (joint.kind == JointKind::kUniversal && a.cross(b).norm() < kNearly)
    r.report.error("E506", *second, "the two axes of a universal joint are parallel");
  if (joint.kind == JointKind::kCylindrical && second->child("xyz") && a.cross(b).norm() > kNearly)
    r.report.error("E506", *second, "a cylindrical joint turns about the axis it slides along");
  if (joint.kind == JointKind::kPlanar && std::abs(a.dot(b)) > kNearly)
    r.report.error("E506", *second, "the two slides of a planar joint are not perpendicular");
}

void check_ball(Reading& r, const Node& node, const JointSpec& joint) {
  const Node* axis = node.child("axis");
  if (!axis) return;
  if (const Node* limit = axis->child("limit"); limit && joint.limited())
    r.report.error("E520", *limit, "limits of a ball joint are not available in this version")
        .suggestion = "available: damping and spring_stiffness";
  if (joint.friction > 0)
    r.report.error("E520", *axis, "dry friction of a ball joint is not available in this version")
        .suggestion = "available: damping and spring_stiffness";
  if (joint.spring_reference != 0)
    r.report.error("E310", *axis,
                   "the spring of a ball joint is relaxed where parent and child frame coincide; "
                   "it has no spring_reference");
}

void read_screw(Reading& r, const Node& node, JointSpec& joint) {
  const Node* pitch = node.child("screw_thread_pitch");
  joint.screw_pitch = number_of(pitch, 1);
  if (joint.kind == JointKind::kScrew) {
    if (!mentioned(node, "screw_thread_pitch"))
      r.report.missing("E303", node, describe(node) + " has no <screw_thread_pitch>");
    if (joint.screw_pitch == 0)
      r.report.bad_text("E306", *pitch, "a screw with pitch 0 is a revolute joint");
  } else if (pitch) {
    r.report.error("E310", *pitch, "only a screw joint has a thread");
  }
}

/// Directions, limits and dynamics of every axis.
void read_axes(Reading& r, const Node& node, int scope, int vertex, JointSpec& joint) {
  constexpr const char* kElements[] = {"axis", "axis2", "axis3"};
  const bool ball = joint.kind == JointKind::kBall;
  const int count = ball ? 1 : freedom_count(joint.kind);
  for (int i = 0; i < 3; ++i) {
    const Node* axis = node.child(kElements[i]);
    const bool turn_of_plane = joint.kind == JointKind::kPlanar && i == 2;
    const bool optional =
        ball || turn_of_plane || (joint.kind == JointKind::kCylindrical && i == 1);
    if (axis && i >= count) {
      r.report.error("E310", *axis,
                     "a " + std::string(node.value("type")) + " joint has no <" + axis->name + ">");
    } else if (axis) {
      AxisSpec& spec = axis_of(joint, i);
      const bool directed = !turn_of_plane && (axis->child("xyz") || !optional);
      if (directed) spec.axis = axis_in_joint(r, *axis, scope, vertex);
      read_axis(r, *axis, spec);
    } else if (i < count && !optional && !mentioned(node, kElements[i])) {
      r.report.missing("E303", node, describe(node) + " has no <" + kElements[i] + ">");
    }
  }
  check_directions(r, node, joint);
  if (ball) check_ball(r, node, joint);
  read_screw(r, node, joint);
}

void read_joint(Reading& r, int vertex) {
  const FrameVertex& v = r.frames.vertices()[at(vertex)];
  const Node& node = *v.node;
  if (node.broken) return;
  JointSpec joint;
  joint.name = v.name;
  joint.place = node.place;
  joint.kind = kind_of(node.value("type"));
  const int parent = side(r, node, v.scope, "parent"), child = side(r, node, v.scope, "child");
  if (parent < 0 || child < 0) return;
  joint.parent = r.frames.body_of(parent);
  joint.child = r.frames.body_of(child);
  if (joint.parent == joint.child) {
    r.report.error("E407", node,
                   "joint '" + v.name + "' connects " +
                       (joint.parent == kWorld ? std::string("the world")
                                               : r.scene.bodies[at(joint.parent)].name) +
                       " with itself");
    return;
  }
  joint.X_PJ = r.frames.frame_ref(joint.parent, r.frames.X_W(vertex)).X_BF;
  joint.X_CJ = r.frames.frame_ref(joint.child, r.frames.X_W(vertex)).X_BF;
  if (joint.kind != JointKind::kFixed) read_axes(r, node, v.scope, vertex, joint);
  if (joint.kind == JointKind::kContinuous) joint.lower = -HUGE_VAL, joint.upper = HUGE_VAL;
  r.joint_of_vertex[vertex] = static_cast<int>(r.scene.joints.size());
  r.scene.joints.push_back(std::move(joint));
}

}  // namespace

std::vector<bool> fixed_bodies(const Scene& scene) {
  std::vector<bool> fixed;
  for (const BodySpec& body : scene.bodies)
    fixed.push_back(body.is_static);
  const auto is_fixed = [&](int body) { return body == kWorld || fixed[at(body)]; };
  for (bool changed = true; changed;) {
    changed = false;
    for (const JointSpec& joint : scene.joints) {
      if (joint.kind != JointKind::kFixed || is_fixed(joint.parent) == is_fixed(joint.child))
        continue;
      fixed[at(is_fixed(joint.parent) ? joint.child : joint.parent)] = true;
      changed = true;
    }
  }
  return fixed;
}

void read_joints(Reading& r, const Node&) {
  for (int vertex = 0; vertex < static_cast<int>(r.frames.vertices().size()); ++vertex)
    if (r.frames.vertices()[at(vertex)].kind == FrameKind::kJoint) read_joint(r, vertex);
}

}  // namespace cprsim
