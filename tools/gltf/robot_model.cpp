// SPDX-License-Identifier: BSD-3-Clause
#include "tools/gltf/robot_model.h"

#include <algorithm>
#include <cmath>

#include "render/camera.h"
#include "render/drawing.h"
#include "tools/gltf/tube_mesh.h"

namespace cprsim {

namespace {

constexpr int kSides = 16;  ///< of a rod's outline
constexpr int kTendonSides = 6;
constexpr double kTendonRadius = 0.15;                 ///< of the rod's
constexpr double kDiskThickness = 0.12;                ///< of its radius
constexpr double kFewestCells = 32, kMostCells = 250;  ///< between the joints of a rod
constexpr double kTurn = 0.12;  ///< rad a cell, of a rod that is wound up at the start

/// z up to y up.
Pose turned() {
  Pose X;
  X.R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return X;
}

/// Display to linear (IEC 61966-2-1).
float to_linear(std::uint8_t display) {
  const double c = display / 255.0;
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

Eigen::Vector4f to_linear(const std::array<std::uint8_t, 4>& c) {
  return {to_linear(c[0]), to_linear(c[1]), to_linear(c[2]), static_cast<float>(c[3]) / 255.0F};
}

/// Of a highlight as wide as Blinn and Phong's with this exponent: alpha² = 2 / (shininess + 2),
/// alpha = roughness² (B. Walter et al., EGSR 2007, eq. 35 and B. Karis, SIGGRAPH course 2013).
float roughness_of(const Look& look) {
  return static_cast<float>(std::pow(2 / (std::max(look.shininess, 0.0) + 2), 0.25));
}

/// The renderer's mesh; one colour for all of it goes into the material.
int add_part(Glb& glb, const std::string& name, const Part& part) {
  const std::vector<Vertex>& vertices = part.mesh.vertices;
  const auto same = [&](const Vertex& v) { return v.color == vertices.front().color; };
  const bool plain = std::all_of(vertices.begin(), vertices.end(), same);
  GlbMesh mesh;
  for (const Vertex& vertex : vertices) {
    mesh.positions.push_back(vertex.position);
    mesh.normals.push_back(vertex.normal);
    if (!plain) mesh.colors.push_back(to_linear(vertex.color));
  }
  mesh.indices = part.mesh.indices;
  GlbMaterial material{
      {1, 1, 1, static_cast<float>(part.look.opacity)}, roughness_of(part.look), !part.closed};
  if (plain) material.color = to_linear(vertices.front().color);
  return glb.add_mesh(name, mesh, glb.add_material(material));
}

/// How many joints do for its tube: rods that are wound up at the start get more.
int tube_cells(const RodSample& rod) {
  double turn = 0;
  for (std::size_t i = 1; i < rod.points.size(); ++i) {
    const Vec3 a = rod.points[i - 1].rotation.col(2), b = rod.points[i].rotation.col(2);
    turn += std::atan2(a.cross(b).norm(), a.dot(b));
  }
  return static_cast<int>(std::clamp(std::ceil(turn / kTurn), kFewestCells, kMostCells));
}

Pose pose_at(const RodSample& rod, double s) {
  const RodPoint point = point_at(rod, s);
  return {point.rotation, point.position};
}

void put(std::vector<float>& list, const Vec4& v, int count) {
  for (int i = 0; i < count; ++i)
    list.push_back(static_cast<float>(v[i]));
}

}  // namespace

RobotModel::RobotModel(const Scene& scene, const Snapshot& first)
    : glb_(scene.name, scene.hash), keyframes_(1) {
  world_ = glb_.add_node({"world", -1, turned()});
  add_bodies(scene, first);
  for (std::size_t i = 0; i < scene.rods.size(); ++i)
    add_rod(scene, i, first.rods.at(i));
  add_cameras(scene, first);
}

void RobotModel::add_bodies(const Scene& scene, const Snapshot& first) {
  const std::vector<bool> still = still_bodies(scene);
  std::vector<int> nodes;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    nodes.push_back(glb_.add_node({scene.bodies[i].name, world_, first.bodies.at(i).X_WB}));
    if (!still[i]) follow(nodes.back(), {static_cast<int>(i), -1, 0, Vec4::Zero()});
  }
  std::vector<int> visuals(scene.bodies.size(), 0);
  for (const Part& part : make_parts(scene)) {
    const auto body = static_cast<std::size_t>(part.body);
    const std::string name = scene.bodies[body].name + " visual " + std::to_string(visuals[body]++);
    glb_.add_node({name, nodes[body], part.X_BV, add_part(glb_, name, part)});
  }
}

void RobotModel::add_rod(const Scene& scene, std::size_t index, const RodSample& rod) {
  const RodSpec& spec = scene.rods[index];
  const int root = glb_.add_node({spec.name + " joints", world_});
  const int cells = tube_cells(rod);
  std::vector<int> joints;
  std::vector<Pose> poses, inverse_binds;
  std::vector<double> s;
  for (int k = 0; k <= cells; ++k) {
    s.push_back(static_cast<double>(k) / cells);
    const Pose X_WJ = pose_at(rod, s.back());
    joints.push_back(glb_.add_node({spec.name + " " + std::to_string(k), root, X_WJ}));
    follow(joints.back(), {-1, static_cast<int>(index), s.back(), Vec4::Zero()});
    poses.push_back(turned() * X_WJ);
    inverse_binds.push_back(poses.back().inverse());
  }
  const int skin = glb_.add_skin(spec.name, root, joints, inverse_binds);

  // a skinned mesh is where its joints are: its own node stands outside, so that no tree moves it
  const auto add_tube = [&](const std::string& name, const GlbMesh& mesh, const Look& look) {
    const GlbMaterial material{to_linear(to_bytes(look.diffuse.cast<float>(), look.opacity)),
                               roughness_of(look), false};
    glb_.add_node({name, -1, {}, glb_.add_mesh(name, mesh, glb_.add_material(material)), skin});
  };
  const double radius = rod.radius > 0 ? rod.radius : spec.outline().size.maxCoeff();
  add_tube(spec.name,
           make_tube_mesh(section_outline(spec.outline(), radius, kSides), poses,
                          std::vector<Vec2>(poses.size(), Vec2::Zero())),
           look_of_rod(spec, index));
  for (std::size_t k = 0; k < spec.disks.size(); ++k) {
    const DiskSpec& disk = spec.disks[k];
    if (disk.radius <= 0) continue;
    const std::string name = spec.name + " disk " + std::to_string(k + 1);
    Part flat;
    ShapeSpec shape;
    shape.kind = ShapeKind::kCylinder;
    shape.size = Vec3(disk.radius, kDiskThickness * disk.radius, 0);
    flat.look = look_of_rod(spec, index);
    flat.look.diffuse = Vec3(0.62, 0.64, 0.67);
    flat.mesh = make_shape(shape, flat.look, scene.meshes);
    flat.closed = true;
    const int node =
        glb_.add_node({name, world_, pose_at(rod, disk.s), add_part(glb_, name, flat)});
    follow(node, {-1, static_cast<int>(index), disk.s, Vec4::Zero()});
  }
  for (const TendonSpec& tendon : scene.tendons) {
    if (tendon.rod != static_cast<int>(index)) continue;
    std::vector<Pose> along;
    std::vector<Vec2> offsets;
    for (std::size_t k = 0; k < s.size() && s[k] <= tendon.termination + 1e-9; ++k) {
      along.push_back(poses[k]);
      offsets.push_back(tendon_offset(tendon, s[k], s[k]).r);
    }
    if (along.size() < 2) continue;
    Look look;
    look.diffuse = Vec3(0.16, 0.17, 0.19);
    const auto outline = section_outline({}, kTendonRadius * radius, kTendonSides);
    add_tube(tendon.name, make_tube_mesh(outline, along, offsets), look);
  }
}

/// As they stand at the start.
void RobotModel::add_cameras(const Scene& scene, const Snapshot& first) {
  for (const CameraSpec& camera : scene.cameras) {
    const View view = make_view(camera, first, 0, 1, camera.width, camera.height);
    const int index = glb_.add_camera(camera.name, 2 * std::atan(view.tan_half_y),
                                      view.tan_half_x / view.tan_half_y);
    glb_.add_node({camera.name, world_, {view.R_WC, view.eye}, -1, -1, index});
  }
}

void RobotModel::follow(int node, const Follower& follower) {
  followers_.push_back(follower);
  glb_.animate(node, GlbPath::kTranslation, keyframes_.size());
  glb_.animate(node, GlbPath::kRotation, keyframes_.size() + 1);
  keyframes_.resize(keyframes_.size() + 2);
}

std::vector<std::size_t> RobotModel::widths() const {
  std::vector<std::size_t> widths{sizeof(float)};
  for (std::size_t i = 0; i < followers_.size(); ++i)
    widths.insert(widths.end(), {3 * sizeof(float), 4 * sizeof(float)});
  return widths;
}

void RobotModel::add_keyframe(const Snapshot& now) {
  keyframes_[0].push_back(static_cast<float>(now.time));
  for (std::size_t i = 0; i < followers_.size(); ++i) {
    Follower& f = followers_[i];
    const Pose X = f.body >= 0 ? now.bodies.at(static_cast<std::size_t>(f.body)).X_WB
                               : pose_at(now.rods.at(static_cast<std::size_t>(f.rod)), f.s);
    Vec4 q = Quat(X.R).normalized().coeffs();
    if (q.dot(f.last_quaternion) < 0) q = -q;
    f.last_quaternion = q;
    put(keyframes_[1 + 2 * i], {X.p.x(), X.p.y(), X.p.z(), 0}, 3);
    put(keyframes_[2 + 2 * i], q, 4);
  }
}

void RobotModel::clear_keyframes() {
  for (std::vector<float>& list : keyframes_)
    list.clear();
}

}  // namespace cprsim
