// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/frames.h"

#include <algorithm>
#include <cmath>

#include "scenes/loader/reporter.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

Mat3 read_quaternion(const std::vector<double>& x, const Node& pose, Reporter& report) {
  constexpr double kExact = 1e-9, kNormalisable = 0.1;
  Quat q(x[6], x[3], x[4], x[5]);
  const double norm = q.norm();
  if (!(norm > kNormalisable && norm < 1 / kNormalisable)) {
    report.bad_text("E506", pose, "the quaternion has length " + format_number(norm) + ", not 1");
    return Mat3::Identity();
  }
  if (std::abs(norm - 1) > 1e-4)
    report.warn("W507", pose,
                "the quaternion has length " + format_number(norm) + " and has been normalised");
  if (std::abs(norm - 1) > kExact) q.normalize();
  return q.normalized().toRotationMatrix();
}

}  // namespace

Pose read_pose(const Node* pose, Reporter& report) {
  Pose X;
  if (!pose || pose->broken || pose->text.empty()) return X;
  const auto numbers = parse_numbers(pose->text);
  if (!numbers || numbers->size() < 6) return X;
  const std::vector<double>& x = *numbers;
  const bool quaternion = pose->value("rotation_format") == "quat_xyzw";
  if (x.size() != (quaternion ? 7u : 6u)) {
    report.bad_text("E305", *pose,
                    quaternion ? "<pose> as quat_xyzw needs 7 numbers: x y z qx qy qz qw"
                               : "<pose> needs 6 numbers: x y z roll pitch yaw");
    return X;
  }
  X.p = Vec3(x[0], x[1], x[2]);
  const double unit = pose->value("degrees") == "true" || pose->value("degrees") == "1"
                          ? 3.14159265358979323846 / 180
                          : 1;
  X.R = quaternion ? read_quaternion(x, *pose, report)
                   : rotation_from_rpy(unit * x[3], unit * x[4], unit * x[5]);
  return X;
}

FrameGraph::FrameGraph(const Node& world, Reporter& report) : report_(report) {
  add_scope(world, -1, "");
  connect();
  cut_loops(&FrameVertex::relative_to, "poses");
  cut_loops(&FrameVertex::attached_to, "attachments");
  solve();
}

void FrameGraph::add_scope(const Node& node, int parent, const std::string& prefix) {
  const int index = static_cast<int>(scopes_.size());
  FrameScope scope;
  scope.node = &node;
  scope.prefix = prefix;
  scope.parent = parent;
  if (const Node* flag = node.child("static"))
    scope.is_static = parse_bool(flag->text).value_or(false);
  if (parent >= 0) scope.is_static = scope.is_static || scopes_[at(parent)].is_static;
  scope_index_[&node] = index;
  scopes_.push_back(std::move(scope));
  if (parent < 0) {
    const int self = add_vertex(FrameKind::kRoot, node, index);
    scopes_[at(index)].self = self;
  } else {
    // a model's own vertex lives in the scope around it
    scopes_[at(index)].self = vertex_of(&node);
  }
  add_children(index);
}

void FrameGraph::add_children(int scope) {
  const Node& node = *scopes_[at(scope)].node;
  for (const auto& child : node.children) {
    if (child->value("name").empty() || child->foreign) continue;
    const std::string name(child->value("name"));
    const std::string prefix = scopes_[at(scope)].prefix + name + "::";
    if (child->name == "model") {
      const int vertex = add_vertex(FrameKind::kModel, *child, scope);
      declare(scope, *child, {FrameKind::kModel, vertex});
      scopes_[at(scope)].inner.emplace(name, static_cast<int>(scopes_.size()));
      add_scope(*child, scope, prefix);
    } else if (child->name == "link") {
      const int vertex = add_vertex(FrameKind::kLink, *child, scope);
      vertices_[at(vertex)].body = body_count();
      link_of_body_.push_back(vertex);
      declare(scope, *child, {FrameKind::kLink, vertex});
    } else if (child->name == "frame" || child->name == "joint" || child->name == "cprsim:joint") {
      const FrameKind kind = child->name == "frame" ? FrameKind::kFrame : FrameKind::kJoint;
      const int vertex = add_vertex(kind, *child, scope);
      declare(scope, *child, {kind, vertex});
    } else if (child->name == "cprsim:rod") {
      declare(scope, *child, {FrameKind::kRod, static_cast<int>(rods_.size())});
      rods_.push_back({child.get(), scopes_[at(scope)].prefix + name, scope});
    }
  }
}

int FrameGraph::add_vertex(FrameKind kind, const Node& node, int scope) {
  FrameVertex v;
  v.kind = kind;
  v.node = &node;
  v.scope = scope;
  v.name = kind == FrameKind::kRoot ? "world"
                                    : scopes_[at(scope)].prefix + std::string(node.value("name"));
  const int index = static_cast<int>(vertices_.size());
  vertices_.push_back(std::move(v));
  vertex_index_[&node] = index;
  return index;
}

void FrameGraph::declare(int scope, const Node& node, Named named) {
  const std::string name(node.value("name"));
  const auto [earlier, fresh] = scopes_[at(scope)].names.emplace(name, named);
  if (fresh) return;
  const Node* other = earlier->second.kind == FrameKind::kRod
                          ? rods_[at(earlier->second.index)].node
                          : vertices_[at(earlier->second.index)].node;
  report_.error("E401", node,
                "the name '" + name + "' is already used by <" + other->name + "> at " +
                    report_.locate(other->place));
}

int FrameGraph::scope_of(const Node* node) const {
  const auto found = scope_index_.find(node);
  return found == scope_index_.end() ? -1 : found->second;
}

int FrameGraph::vertex_of(const Node* node) const {
  const auto found = vertex_index_.find(node);
  return found == vertex_index_.end() ? -1 : found->second;
}

std::optional<Named> FrameGraph::find(int scope, std::string_view name) const {
  while (true) {
    const FrameScope& here = scopes_[at(scope)];
    const std::size_t colons = name.find("::");
    const std::string_view head = name.substr(0, colons);
    if (colons == std::string_view::npos) {
      if (head == "__model__" && here.parent >= 0) return Named{FrameKind::kModel, here.self};
      if (head == "world" && here.parent < 0) return Named{FrameKind::kRoot, here.self};
      const auto found = here.names.find(head);
      if (found == here.names.end()) return std::nullopt;
      return found->second;
    }
    const auto inner = here.inner.find(head);
    if (inner == here.inner.end()) return std::nullopt;
    scope = inner->second;
    name.remove_prefix(colons + 2);
  }
}

std::optional<Named> FrameGraph::find_outwards(int scope, std::string_view name) const {
  if (name == "world") return Named{FrameKind::kRoot, scopes_[0].self};
  for (int s = scope; s >= 0; s = scopes_[at(s)].parent)
    if (const auto found = find(s, name)) return found;
  return std::nullopt;
}

std::vector<std::string> FrameGraph::known_names(int scope) const {
  std::vector<std::string> names;
  for (int s = scope; s >= 0; s = scopes_[at(s)].parent)
    for (const auto& [name, named] : scopes_[at(s)].names)
      names.push_back(name);
  // from the world, what lies in models is named with its model
  if (scopes_[at(scope)].parent < 0) {
    for (const FrameVertex& v : vertices_)
      names.push_back(v.name);
    for (const RodEntry& rod : rods_)
      names.push_back(rod.name);
  }
  return names;
}

FrameRef FrameGraph::frame_ref(int vertex) const {
  return frame_ref(body_of(vertex), X_W(vertex));
}

FrameRef FrameGraph::frame_ref(int body, const Pose& X_WF) const {
  if (body == kWorld) return {kWorld, X_WF};
  return {body, X_W(link_of(body)).inverse() * X_WF};
}

Pose FrameGraph::posed(const Node& element, int scope, int vertex) {
  const Node* pose = element.child("pose");
  if (!pose) return X_W(vertex);
  const std::string_view relative = pose->value("relative_to");
  const int base = relative.empty() ? vertex : resolve(scope, relative, *pose, "relative_to", true);
  return X_W(base < 0 ? vertex : base) * read_pose(pose, report_);
}

}  // namespace cprsim
