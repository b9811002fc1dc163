// SPDX-License-Identifier: BSD-3-Clause
// The frames of a scene: who stands relative to whom, and who is fixed to which body. SDF's rules:
// names are local to their model, `inner::name` reaches into a nested one; a link's pose is
// relative to its model unless relative_to says otherwise, a frame's to what it is attached to, a
// joint's to its child.
//
//   X_W(v) = X_W(relative_to(v)) X(v)                                   (1)
//   a model whose placement frame is F:  X(m) = pose X_MF^-1            (2)
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/body_spec.h"
#include "scenes/loader/document.h"

namespace cprsim {

class Reporter;

enum class FrameKind { kRoot, kModel, kLink, kFrame, kJoint, kRod };

/// What a name stands for: a vertex of the frame graph, or a rod.
struct Named {
  FrameKind kind = FrameKind::kRoot;
  int index = -1;
};

/// A world or model: the names that are local to it.
struct FrameScope {
  const Node* node = nullptr;
  std::string prefix;  ///< "robot::"
  int parent = -1;
  int self = -1;  ///< vertex of the model or world frame
  bool is_static = false;
  std::map<std::string, Named, std::less<>> names;
  std::map<std::string, int, std::less<>> inner;  ///< scopes of nested models
};

struct FrameVertex {
  FrameKind kind = FrameKind::kFrame;
  const Node* node = nullptr;
  std::string name;  ///< scoped
  int scope = -1;
  int relative_to = -1, attached_to = -1, placement = -1;
  Pose X;             ///< in relative_to, before (2)
  int body = kWorld;  ///< of links
};

struct RodEntry {
  const Node* node = nullptr;
  std::string name;
  int scope = -1;
};

/// Pose of a <pose> element (null: identity), angles and quaternion as its attributes say.
Pose read_pose(const Node* pose, Reporter& report);

class FrameGraph {
 public:
  FrameGraph(const Node& world, Reporter& report);

  const std::vector<FrameScope>& scopes() const { return scopes_; }

  const std::vector<FrameVertex>& vertices() const { return vertices_; }

  const std::vector<RodEntry>& rods() const { return rods_; }

  /// Scope whose element is `node`, -1 if there is none.
  int scope_of(const Node* node) const;
  /// Vertex whose element is `node`, -1 if there is none.
  int vertex_of(const Node* node) const;

  /// A name as seen from a scope, by SDF's rules.
  std::optional<Named> find(int scope, std::string_view name) const;
  /// As find(), then from the enclosing scopes; "world" is always known. For cprsim elements.
  std::optional<Named> find_outwards(int scope, std::string_view name) const;
  /// All names that find_outwards() would know without "::", for suggestions.
  std::vector<std::string> known_names(int scope) const;

  const Pose& X_W(int vertex) const { return X_W_[static_cast<std::size_t>(vertex)]; }

  /// Body that a vertex is fixed to, kWorld for the world.
  int body_of(int vertex) const { return body_[static_cast<std::size_t>(vertex)]; }

  /// The same frame in the coordinates of its body.
  FrameRef frame_ref(int vertex) const;
  /// A pose in the world, given in the coordinates of the body.
  FrameRef frame_ref(int body, const Pose& X_WF) const;

  int body_count() const { return static_cast<int>(link_of_body_.size()); }

  int link_of(int body) const { return link_of_body_[static_cast<std::size_t>(body)]; }

  /// Pose in the world of an element with a <pose> child, by default relative to `vertex`.
  Pose posed(const Node& element, int scope, int vertex);

 private:
  void add_scope(const Node& node, int parent, const std::string& prefix);
  void add_children(int scope);
  int add_vertex(FrameKind kind, const Node& node, int scope);
  void declare(int scope, const Node& node, Named named);
  void connect();
  void connect_pose(FrameVertex& v, int fallback);
  void connect_model(FrameVertex& v);
  int resolve(int scope, std::string_view name, const Node& where, const char* key, bool world);
  int canonical_link(int scope) const;
  void cut_loops(int FrameVertex::*next, const char* what);
  Pose local(int vertex) const;
  Pose within(int vertex, int root) const;
  void solve();

  Reporter& report_;
  std::vector<FrameScope> scopes_;
  std::vector<FrameVertex> vertices_;
  std::vector<RodEntry> rods_;
  std::vector<Pose> X_W_;
  std::vector<int> body_, link_of_body_;
  std::map<const Node*, int> scope_index_, vertex_index_;
};

}  // namespace cprsim
