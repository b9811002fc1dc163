// SPDX-License-Identifier: BSD-3-Clause
// Links: inertia, shapes, looks.
#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>

#include "scenes/loader/files.h"
#include "scenes/loader/meshes.h"
#include "scenes/loader/reading.h"
#include "scenes/loader/values.h"
#include "scenes/loader/weigh.h"

namespace cprsim {

namespace {

Vec3 color_of(const Node* node, const Vec3& fallback, double* alpha = nullptr) {
  const auto numbers = node ? parse_numbers(node->text) : std::nullopt;
  if (!numbers || numbers->size() < 3) return fallback;
  if (alpha && numbers->size() > 3) *alpha = std::min((*numbers)[3], 1.0);
  return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

// the scene keeps each mesh once per file, scale and part
int read_mesh(Reading& r, const Node& node) {
  const Node* uri = node.child("uri");
  if (!uri) return -1;
  const FoundFile found =
      find_resource(uri->text, r.folders[at(node.place.file < 0 ? 0 : node.place.file)], r.roots);
  if (!found.code.empty()) {
    Diagnostic& d = r.report.bad_text(found.code, *uri, "mesh " + found.message);
    for (const std::string& place : found.tried)
      d.details.push_back("tried " + place);
    return -1;
  }
  const Vec3 scale = vec3_of(node.child("scale"), Vec3::Ones());
  const Node* part = node.child("submesh");
  const Node* name = part ? part->child("name") : nullptr;
  const bool center = part && flag_of(part->child("center"), false);
  std::string key = found.path + (center ? "|centred" : "|") + (name ? name->text : "");
  for (const double factor : {scale[0], scale[1], scale[2]})
    key += "|" + format_number(factor);
  if (const auto known = r.mesh_index.find(key); known != r.mesh_index.end()) return known->second;
  std::string error;
  MeshSpec mesh = load_mesh(found.path, found.root, scale, name ? name->text : "", center, error);
  if (!error.empty()) {
    r.report.bad_text("E109", *uri, "mesh '" + uri->text + "': " + error);
    return -1;
  }
  const int index = static_cast<int>(r.scene.meshes.size());
  r.scene.meshes.push_back(std::move(mesh));
  r.mesh_index.emplace(std::move(key), index);
  return index;
}

Vec3 unit(Reading& r, const Node& node, const Vec3& v) {
  if (v.norm() > 1e-9) return v.normalized();
  r.report.bad_text("E506", node, "<" + node.name + "> has no direction: its length is 0");
  return Vec3::UnitZ();
}

void positive(Reading& r, const Node* node, const Vec3& v) {
  if (node && v.minCoeff() <= 0)
    r.report.bad_text("E306", *node, "<" + node->name + "> must be positive in every direction");
}

ShapeSpec read_primitive(Reading& r, const Node& node) {
  ShapeSpec shape;
  const double radius = number_of(node.child("radius"), 1),
               length = number_of(node.child("length"), 1);
  if (node.name == "box") {
    shape.kind = ShapeKind::kBox;
    shape.size = vec3_of(node.child("size"), Vec3::Ones());
    positive(r, node.child("size"), shape.size);
  } else if (node.name == "sphere") {
    shape.kind = ShapeKind::kSphere;
    shape.size = Vec3(radius, 0, 0);
  } else if (node.name == "ellipsoid") {
    shape.kind = ShapeKind::kEllipsoid;
    shape.size = vec3_of(node.child("radii"), Vec3::Ones());
    positive(r, node.child("radii"), shape.size);
  } else if (node.name == "cprsim:tube") {
    const double inner = number_of(node.child("inner_radius"), 0.5 * radius);
    shape.kind = ShapeKind::kTube;
    shape.size = Vec3(radius, length, inner);
    if (inner >= radius)
      r.report.bad_text("E306", *node.child("inner_radius"),
                        "<inner_radius> must be less than <radius>");
  } else if (node.name == "plane") {
    shape.kind = ShapeKind::kPlane;
    const auto size = node.child("size") ? parse_numbers(node.child("size")->text) : std::nullopt;
    shape.size = size && size->size() == 2 ? Vec3((*size)[0], (*size)[1], 0) : Vec3(1, 1, 0);
    if (const Node* normal = node.child("normal"))
      shape.normal = unit(r, *normal, vec3_of(normal, Vec3::UnitZ()));
  } else if (node.name == "mesh") {
    shape.kind = ShapeKind::kMesh;
    shape.mesh = read_mesh(r, node);
  } else if (node.name != "empty") {
    shape.kind = node.name == "cylinder"  ? ShapeKind::kCylinder
                 : node.name == "capsule" ? ShapeKind::kCapsule
                                          : ShapeKind::kCone;
    shape.size = Vec3(radius, length, 0);
  }
  return shape;
}

ShapeSpec read_geometry(Reading& r, const Node& owner) {
  const Node* geometry = owner.child("geometry");
  if (!geometry) return {};
  const Node* only = nullptr;
  for (const auto& child : geometry->children) {
    if (child->foreign) continue;
    if (only) {
      r.report.error("E304", *child,
                     "a <geometry> holds one shape; the first is <" + only->name + ">");
      return {};
    }
    only = child.get();
  }
  if (!only) {
    r.report.missing("E303", *geometry, "<geometry> of " + describe(owner) + " has no shape");
    return {};
  }
  return only->broken ? ShapeSpec{} : read_primitive(r, *only);
}

void read_inertial(Reading& r, const Node& node, BodySpec& body) {
  if (const Node* density = node.child("density"))
    r.report.error("E310", *density, "<density> is for <inertial auto=\"true\">",
                   "add auto=\"true\", or write mass and inertia");
  const Node* inertia = node.child("inertia");
  body.mass = number_of(node.child("mass"), 0);
  const Pose X_BI = read_pose(node.child("pose"), r.report);
  body.com = X_BI.p;
  if (!inertia) return;
  const auto entry = [&](const char* name) { return number_of(inertia->child(name), 0); };
  Mat3 I;
  I << entry("ixx"), entry("ixy"), entry("ixz"), entry("ixy"), entry("iyy"), entry("iyz"),
      entry("ixz"), entry("iyz"), entry("izz");
  body.inertia = X_BI.R * I * X_BI.R.transpose();
  for (const char* name : {"ixx", "iyy", "izz"})
    if (!inertia->child(name)) return;  // the check of the whole scene says what is missing

  // moments of inertia of a real body are positive and fulfil the triangle inequality
  const Vec3 principal = Eigen::SelfAdjointEigenSolver<Mat3>(I).eigenvalues();
  const double slack = 1e-6 * principal.cwiseAbs().maxCoeff();
  if (principal[0] <= 0)
    r.report.error("E502", *inertia, "the inertia is not positive definite");
  else if (principal[0] + principal[1] < principal[2] - slack)
    r.report.error("E502", *inertia,
                   "no body has this inertia: the largest principal moment, " +
                       format_number(principal[2]) + ", exceeds the sum of the others, " +
                       format_number(principal[0] + principal[1]));
}

void unique_names(Reading& r, const Node& link, const char* element) {
  std::set<std::string_view> names;
  for (const Node* node : link.all(element))
    if (!names.insert(node->value("name")).second)
      r.report.error("E401", *node,
                     "the name '" + std::string(node->value("name")) + "' is already used in " +
                         describe(link));
}

void read_shapes_of(Reading& r, const Node& link, int vertex, BodySpec& body) {
  const int scope = r.frames.vertices()[at(vertex)].scope;
  const auto pose_of = [&](const Node& node) {
    return body.X_WB.inverse() * r.frames.posed(node, scope, vertex);
  };
  for (const Node* node : link.all("visual")) {
    VisualSpec visual;
    visual.name = node->value("name");
    visual.place = node->place;
    visual.X_BV = pose_of(*node);
    visual.shape = read_geometry(r, *node);
    visual.look = read_look(node->child("material"), {});
    visual.look.opacity *= 1 - std::min(number_of(node->child("transparency"), 0), 1.0);
    visual.cast_shadows = flag_of(node->child("cast_shadows"), true);
    body.visuals.push_back(std::move(visual));
  }
  for (const Node* node : link.all("collision")) {
    ColliderSpec collider;
    collider.name = node->value("name");
    collider.place = node->place;
    collider.X_BC = pose_of(*node);
    collider.shape = read_geometry(r, *node);
    collider.surface = read_surface(node->child("surface"));
    if (collider.surface.restitution > 1)
      r.report.error("E306", *node, "a restitution above 1 would create energy");
    body.colliders.push_back(std::move(collider));
  }
}

}  // namespace

SurfaceSpec read_surface(const Node* node) {
  SurfaceSpec surface;
  if (!node) return surface;
  if (const Node* friction = node->child("friction")) {
    if (const Node* bullet = friction->child("bullet")) {
      surface.friction = number_of(bullet->child("friction"), surface.friction);
      surface.rolling_friction = number_of(bullet->child("rolling_friction"), 0);
    }
    if (const Node* ode = friction->child("ode"))
      surface.friction = number_of(ode->child("mu"), surface.friction);
  }
  if (const Node* bounce = node->child("bounce"))
    surface.restitution = number_of(bounce->child("restitution_coefficient"), 0);
  if (const Node* contact = node->child("contact")) {
    for (const char* engine : {"bullet", "ode"})
      if (const Node* soft = contact->child(engine)) {
        surface.stiffness = number_of(soft->child("kp"), surface.stiffness);
        surface.damping = number_of(soft->child("kd"), surface.damping);
      }
    surface.collide_bitmask =
        static_cast<unsigned>(number_of(contact->child("collide_bitmask"), 0xffff));
    surface.category_bitmask =
        static_cast<unsigned>(number_of(contact->child("category_bitmask"), 0xffff));
  }
  return surface;
}

Look read_look(const Node* material, Look look) {
  if (!material) return look;
  look.set = true;
  look.diffuse = color_of(material->child("diffuse"), look.diffuse, &look.opacity);
  const bool ambient = material->child("ambient") != nullptr;
  look.ambient = ambient ? color_of(material->child("ambient"), look.ambient) : look.diffuse;
  look.specular = color_of(material->child("specular"), look.specular);
  look.emissive = color_of(material->child("emissive"), look.emissive);
  look.shininess = number_of(material->child("shininess"), look.shininess);
  return look;
}

void read_bodies(Reading& r, const Node&) {
  for (int b = 0; b < r.frames.body_count(); ++b) {
    const int vertex = r.frames.link_of(b);
    const FrameVertex& v = r.frames.vertices()[at(vertex)];
    const Node& link = *v.node;
    BodySpec body;
    body.name = v.name;
    body.place = link.place;
    body.X_WB = r.frames.X_W(vertex);
    body.is_static = r.frames.scopes()[at(v.scope)].is_static;
    body.gravity = flag_of(link.child("gravity"), true);
    const Node* inertial = link.child("inertial");
    const bool weighed = inertial && computes_inertia(*inertial);
    if (inertial && !weighed) read_inertial(r, *inertial, body);
    if (const Node* decay = link.child("velocity_decay")) {
      body.linear_decay = number_of(decay->child("linear"), 0);
      body.angular_decay = number_of(decay->child("angular"), 0);
    }
    unique_names(r, link, "visual");
    unique_names(r, link, "collision");
    read_shapes_of(r, link, vertex, body);
    if (weighed) weigh(r, link, *inertial, body);
    r.scene.bodies.push_back(std::move(body));
  }
  for (int vertex = 0; vertex < static_cast<int>(r.frames.vertices().size()); ++vertex) {
    const FrameVertex& v = r.frames.vertices()[at(vertex)];
    if (v.kind == FrameKind::kFrame) r.scene.frames.push_back({v.name, r.frames.frame_ref(vertex)});
  }
}

}  // namespace cprsim
