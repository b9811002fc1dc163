// SPDX-License-Identifier: BSD-3-Clause
// The second half of the frame graph: names to edges, loops, poses.
#include <algorithm>
#include <set>

#include "scenes/loader/frames.h"
#include "scenes/loader/reporter.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

int FrameGraph::resolve(int scope, std::string_view name, const Node& where, const char* key,
                        bool world) {
  if (world && name == "world") return scopes_[0].self;
  const auto found = find(scope, name);
  if (found && found->kind != FrameKind::kRod) return found->index;
  const std::string best = nearest_name(name, known_names(scope));
  std::string hint = best.empty() ? "" : "did you mean " + best + "?";
  std::string message = "there is no link, frame, joint or model '" + std::string(name) + "' here";
  if (found || name.find("::tip") != name.npos || name.find("::base") != name.npos)
    message = "SDF elements cannot refer to rods: '" + std::string(name) + "'";
  if (const Attribute* a = where.attribute(key))
    report_.bad_value("E403", where, *a, message, hint);
  else
    report_.bad_text("E403", where, message, hint);
  return -1;
}

void FrameGraph::connect() {
  for (FrameVertex& v : vertices_) {
    if (v.kind == FrameKind::kRoot) continue;
    const int self = scopes_[at(v.scope)].self;
    v.X = read_pose(v.node->child("pose"), report_);
    if (v.kind == FrameKind::kLink) {
      connect_pose(v, self);
    } else if (v.kind == FrameKind::kFrame) {
      const std::string_view to = v.node->value("attached_to");
      v.attached_to = to.empty() ? self : resolve(v.scope, to, *v.node, "attached_to", false);
      if (v.attached_to < 0) v.attached_to = scopes_[0].self;
      connect_pose(v, v.attached_to);
    } else if (v.kind == FrameKind::kJoint) {
      const Node* child = v.node->child("child");
      v.attached_to = child && child->text != "world"
                          ? resolve(v.scope, child->text, *child, "", false)
                          : scopes_[0].self;
      if (v.attached_to < 0) v.attached_to = scopes_[0].self;
      connect_pose(v, v.attached_to);
    } else {
      connect_model(v);
    }
  }
}

void FrameGraph::connect_pose(FrameVertex& v, int fallback) {
  v.relative_to = fallback;
  const Node* pose = v.node->child("pose");
  const std::string_view to = pose ? pose->value("relative_to") : std::string_view();
  if (to.empty()) return;
  const int found = resolve(v.scope, to, *pose, "relative_to", false);
  if (found >= 0) v.relative_to = found;
}

void FrameGraph::connect_model(FrameVertex& v) {
  connect_pose(v, scopes_[at(v.scope)].self);
  const int inside = scope_of(v.node);
  if (const std::string_view frame = v.node->value("placement_frame"); !frame.empty())
    v.placement = resolve(inside, frame, *v.node, "placement_frame", false);
  const std::string_view link = v.node->value("canonical_link");
  if (!link.empty())
    v.attached_to = resolve(inside, link, *v.node, "canonical_link", false);
  else
    v.attached_to = canonical_link(inside);
  if (v.attached_to < 0 && link.empty() && !scopes_[at(inside)].is_static)
    report_.missing("E406", *v.node, describe(*v.node) + " has no link");
  if (v.attached_to < 0) v.attached_to = scopes_[0].self;
}

// the first link in document order, those of nested models after the model's own
int FrameGraph::canonical_link(int scope) const {
  const FrameScope& here = scopes_[at(scope)];
  for (const auto& child : here.node->children)
    if (child->name == "link")
      if (const int vertex = vertex_of(child.get()); vertex >= 0) return vertex;
  for (const auto& child : here.node->children)
    if (child->name == "model")
      if (const int inner = scope_of(child.get()); inner >= 0)
        if (const int vertex = canonical_link(inner); vertex >= 0) return vertex;
  return -1;
}

void FrameGraph::cut_loops(int FrameVertex::*next, const char* what) {
  std::vector<int> seen(vertices_.size(), -1);
  for (int start = 0; start < static_cast<int>(vertices_.size()); ++start) {
    int v = start;
    while (v >= 0 && seen[at(v)] < 0) {
      seen[at(v)] = start;
      v = vertices_[at(v)].*next;
    }
    if (v < 0 || seen[at(v)] != start) continue;
    std::string loop = vertices_[at(v)].name;
    for (int u = vertices_[at(v)].*next; u != v; u = vertices_[at(u)].*next)
      loop += " -> " + vertices_[at(u)].name;
    report_.error(
        "E405", *vertices_[at(v)].node,
        std::string("the ") + what + " form a loop: " + loop + " -> " + vertices_[at(v)].name);
    vertices_[at(v)].*next = v == scopes_[0].self ? -1 : scopes_[0].self;
  }
}

Pose FrameGraph::local(int vertex) const {
  const FrameVertex& v = vertices_[at(vertex)];
  if (v.kind != FrameKind::kModel || v.placement < 0) return v.X;
  return v.X * within(v.placement, vertex).inverse();  // (2)
}

// pose of `vertex` in the frame `root`, which is on its way to the world
Pose FrameGraph::within(int vertex, int root) const {
  Pose X;
  for (int v = vertex; v >= 0 && v != root; v = vertices_[at(v)].relative_to)
    X = local(v) * X;
  return X;
}

void FrameGraph::solve() {
  X_W_.resize(vertices_.size());
  body_.assign(vertices_.size(), kWorld);
  std::vector<bool> done(vertices_.size(), false);
  for (int start = 0; start < static_cast<int>(vertices_.size()); ++start) {
    std::vector<int> chain;
    int v = start;
    for (; v >= 0 && !done[at(v)]; v = vertices_[at(v)].relative_to)
      chain.push_back(v);
    Pose X = v >= 0 ? X_W_[at(v)] : Pose{};
    for (auto k = chain.rbegin(); k != chain.rend(); ++k) {
      X = X * local(*k);  // (1)
      X_W_[at(*k)] = X;
      done[at(*k)] = true;
    }
  }
  std::fill(done.begin(), done.end(), false);
  for (int start = 0; start < static_cast<int>(vertices_.size()); ++start) {
    std::vector<int> chain;
    int v = start;
    for (; v >= 0 && !done[at(v)]; v = vertices_[at(v)].attached_to)
      chain.push_back(v);
    int body = v >= 0 ? body_[at(v)] : kWorld;
    for (auto k = chain.rbegin(); k != chain.rend(); ++k) {
      if (vertices_[at(*k)].kind == FrameKind::kLink) body = vertices_[at(*k)].body;
      body_[at(*k)] = body;
      done[at(*k)] = true;
    }
  }
}

}  // namespace cprsim
