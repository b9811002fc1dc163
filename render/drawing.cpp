// SPDX-License-Identifier: BSD-3-Clause
#include "render/drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace cprsim {

namespace {

/// Rods are smooth: between two sections whose tangents differ by more than this, another is put
/// in.
constexpr double kLeastRings = 40;     // along a rod
constexpr double kLargestTurn = 0.09;  // rad; above 0.15 the silhouette of a bent rod shows corners

constexpr double kDiskThickness = 0.12;  // of the radius
const Color kArrowColor(0.93F, 0.45F, 0.06F);
const Color kDiskColor(0.62F, 0.64F, 0.67F);  // light metal

Pose pose_of(const Snapshot& now, int body) {
  const auto i = static_cast<std::size_t>(body);
  return body >= 0 && i < now.bodies.size() ? now.bodies[i].X_WB : Pose{};
}

/// Cubic Hermite between two rings with tangents of the chord's length.
Tube::Ring between(const Tube::Ring& a, const Tube::Ring& b, double t) {
  const double h = (b.position - a.position).norm(), t2 = t * t, t3 = t2 * t;
  const Vec3 ta = h * a.rotation.col(2), tb = h * b.rotation.col(2);
  Tube::Ring ring;
  ring.position = (2 * t3 - 3 * t2 + 1) * a.position + (t3 - 2 * t2 + t) * ta +
                  (3 * t2 - 2 * t3) * b.position + (t3 - t2) * tb;
  ring.rotation = Quat(a.rotation).slerp(t, Quat(b.rotation)).toRotationMatrix();
  const auto f = static_cast<float>(t);
  ring.color = (1 - f) * a.color + f * b.color;
  ring.s = (1 - t) * a.s + t * b.s;
  return ring;
}

Tube make_tube(const RodSpec& spec, const Look& look, const RodSample& rod, ColorBy by,
               const Vec2& range) {
  Tube tube;
  tube.section = spec.outline();
  tube.radius = rod.radius > 0 ? rod.radius : spec.outline().size.maxCoeff();
  tube.look = look;
  for (const RodPoint& point : rod.points) {
    const Color color = by == ColorBy::kNone ? Color(look.diffuse.cast<float>())
                                             : color_of(by, colored_value(by, point), range);
    const Tube::Ring ring{point.position, point.rotation, color, point.s};
    if (!ring.position.allFinite() || !ring.rotation.allFinite()) continue;
    if (!tube.rings.empty()) {
      const Tube::Ring last = tube.rings.back();
      const double turn = last.rotation.col(2).cross(ring.rotation.col(2)).norm();
      // an S between parallel tangents turns nowhere and is bent all the same: never too few rings
      const auto intervals = static_cast<double>(rod.points.size() - 1);
      const int least = std::max(1, static_cast<int>(std::ceil(kLeastRings / intervals)));
      const int cells = std::clamp(static_cast<int>(std::ceil(turn / kLargestTurn)), least, 16);
      for (int k = 1; k < cells; ++k) {
        tube.rings.push_back(between(last, ring, static_cast<double>(k) / cells));
      }
    }
    tube.rings.push_back(ring);
  }
  return tube;
}

Ribbon make_ribbon(const TraceLine& trace, std::size_t index, double time) {
  Ribbon ribbon;
  ribbon.color = accent(index);
  for (const TraceLine::Point& point : trace.points) {
    double opacity = 0.95;
    if (trace.seconds > 0) {
      const double age = (time - point.time) / trace.seconds;
      opacity *= std::clamp(1 - age, 0.0, 1.0);
    }
    if (opacity <= 0 || !point.position.allFinite()) continue;
    ribbon.points.push_back({point.position, static_cast<float>(opacity)});
  }
  return ribbon;
}

/// A dark line beside the rod.
Ribbon make_tendon(const TendonSpec& tendon, const Tube& rod) {
  Ribbon ribbon;
  ribbon.color = Color(0.16F, 0.17F, 0.19F);
  ribbon.pixels = 1.5;
  for (const Tube::Ring& ring : rod.rings) {
    if (ring.s > tendon.termination + 1e-9) break;
    const Vec2 r = tendon_offset(tendon, ring.s, ring.s).r;
    ribbon.points.push_back({ring.position + ring.rotation.leftCols<2>() * r, 0.9F});
  }
  return ribbon;
}

/// A flat cylinder across the rod; nothing for a point mass.
std::optional<Tube> make_disk(const DiskSpec& disk, const Tube& rod) {
  const auto beyond = std::find_if(rod.rings.begin(), rod.rings.end(),
                                   [&](const Tube::Ring& ring) { return ring.s > disk.s - 1e-9; });
  if (disk.radius <= 0 || beyond == rod.rings.end() || beyond == rod.rings.begin())
    return std::nullopt;
  const Tube::Ring& before = *std::prev(beyond);
  Tube::Ring at = between(before, *beyond, (disk.s - before.s) / (beyond->s - before.s));
  at.color = kDiskColor;
  Tube tube;
  tube.section.size = Vec2(disk.radius, 0);
  tube.radius = disk.radius;
  tube.look = rod.look;
  const Vec3 half = 0.5 * kDiskThickness * disk.radius * at.rotation.col(2);
  for (const Vec3& side : {Vec3(-half), half}) {
    tube.rings.push_back(at);
    tube.rings.back().position += side;
  }
  return tube;
}

/// A shaft and a head, as wide as the arrow is long in parts; nothing for no force.
void add_arrow(const Vec3& from, const Vec3& arrow, std::vector<Tube>& tubes) {
  constexpr double kShaft = 0.02, kHead = 0.06, kNeck = 0.75;  // of its length
  const double length = arrow.norm();
  if (!(length > 0) || !std::isfinite(length) || !from.allFinite()) return;
  Tube shaft;
  shaft.radius = kShaft * length;
  shaft.look.diffuse = kArrowColor.cast<double>();
  Tube::Ring ring;
  ring.rotation = Quat::FromTwoVectors(Vec3::UnitZ(), arrow).toRotationMatrix();
  ring.color = kArrowColor;
  Tube head = shaft;
  head.radius = kHead * length;
  for (const double s : {0., kNeck, 1.}) {
    ring.position = from + s * arrow;
    if (s < 1) shaft.rings.push_back(ring);
    ring.width = s < 1 ? 1 : 0.02;
    if (s > 0) head.rings.push_back(ring);
    ring.width = 1;
  }
  tubes.push_back(std::move(shaft));
  tubes.push_back(std::move(head));
}

std::array<Vec3, 8> corners_of(const TriMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vertex& vertex : mesh.vertices)
    box.extend(vertex.position.cast<double>());
  std::array<Vec3, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[static_cast<std::size_t>(i)] =
        mesh.vertices.empty() ? Vec3(Vec3::Zero())
                              : Vec3(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  }
  return corners;
}

bool is_level_plane(const ShapeSpec& shape, const Mat3& R_WS) {
  return shape.kind == ShapeKind::kPlane && shape.normal.norm() > 0 &&
         (R_WS * shape.normal.normalized()).z() > 1 - 1e-9;
}

template <class Visit>
void visit_corners(const std::vector<Part>& parts, const Drawing& drawing, bool still_only,
                   Visit&& visit) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].is_ground || (still_only && parts[i].moves)) continue;
    for (const Vec3& corner : parts[i].corners)
      visit(drawing.part_poses[i] * corner);
  }
  if (still_only) return;
  for (const Tube& tube : drawing.tubes) {
    for (const Tube::Ring& ring : tube.rings)
      visit(ring.position);
  }
}

}  // namespace

std::vector<bool> still_bodies(const Scene& scene) {
  std::vector<bool> still(scene.bodies.size());
  for (std::size_t i = 0; i < still.size(); ++i)
    still[i] = scene.bodies[i].is_static;
  const auto is_still = [&](int body) {
    return body == kWorld || (body >= 0 && still[static_cast<std::size_t>(body)]);
  };
  // a chain of fixed joints is at most as long as there are joints
  for (bool changed = true; changed;) {
    changed = false;
    for (const JointSpec& joint : scene.joints) {
      if (joint.kind != JointKind::kFixed || is_still(joint.parent) == is_still(joint.child))
        continue;
      still[static_cast<std::size_t>(is_still(joint.parent) ? joint.child : joint.parent)] = true;
      changed = true;
    }
  }
  return still;
}

Look look_of(const VisualSpec& visual, bool fixed) {
  if (visual.look.set) return visual.look;
  Look look = visual.look;
  // a dark frame and bright moving parts
  look.diffuse = fixed ? Vec3(0.30, 0.325, 0.36) : Vec3(0.86, 0.87, 0.88);
  look.specular = Vec3::Constant(0.35);
  look.shininess = 48;
  return look;
}

Look look_of_rod(const RodSpec& rod, std::size_t index) {
  if (rod.look.set) return rod.look;
  Look look = rod.look;
  look.diffuse = accent(index + 1).cast<double>();
  look.specular = Vec3::Constant(0.4);
  look.shininess = 48;
  return look;
}

std::vector<Part> make_parts(const Scene& scene) {
  const std::vector<bool> still = still_bodies(scene);
  std::vector<Part> parts;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodySpec& body = scene.bodies[i];
    for (const VisualSpec& visual : body.visuals) {
      Part part;
      part.body = static_cast<int>(i);
      part.X_BV = visual.X_BV;
      part.look = look_of(visual, still[i]);
      part.mesh = make_shape(visual.shape, part.look, scene.meshes);
      part.moves = !still[i];
      part.closed = visual.shape.kind != ShapeKind::kMesh && visual.shape.kind != ShapeKind::kPlane;
      part.casts_shadow = visual.cast_shadows;
      // 5 m: wider than any of these robots, so that its edge is not part of the picture
      part.is_ground = still[i] && is_level_plane(visual.shape, (body.X_WB * visual.X_BV).R) &&
                       visual.shape.size.head<2>().minCoeff() >= 5;
      part.corners = corners_of(part.mesh);
      if (!part.mesh.indices.empty()) parts.push_back(std::move(part));
    }
  }
  return parts;
}

double colored_value(ColorBy by, const RodPoint& point) {
  const Vec3 m = point.rotation.transpose() * point.moment;
  const Vec3 n = point.rotation.transpose() * point.force;
  switch (by) {
    case ColorBy::kBendingMoment:
      return std::hypot(m.x(), m.y());
    case ColorBy::kCurvature:
      return std::hypot(point.curvature.x(), point.curvature.y());
    case ColorBy::kTension:
      return n.z();
    case ColorBy::kStrainEnergy:
      return 0.5 * std::abs(m.dot(point.curvature - point.rest_curvature) +
                            n.dot(point.shear_stretch - Vec3::UnitZ()));
    case ColorBy::kNone:
      break;
  }
  return 0;
}

double largest_value(ColorBy by, const Snapshot& now) {
  double largest = 0;
  for (const RodSample& rod : now.rods) {
    for (const RodPoint& point : rod.points) {
      const double value = std::abs(colored_value(by, point));
      if (std::isfinite(value)) largest = std::max(largest, value);
    }
  }
  return largest;
}

Vec2 range_of(ColorBy by, double largest) {
  const double top = nice_ceiling(largest);
  return {is_signed(by) ? -top : 0, top};
}

Drawing make_drawing(const Scene& scene, const std::vector<Part>& parts, const Snapshot& now,
                     const FrameDecor& decor, const Vec2& color_range) {
  Drawing drawing;
  drawing.tubes_mean_numbers = decor.color_by != ColorBy::kNone;
  drawing.part_poses.reserve(parts.size());
  for (const Part& part : parts)
    drawing.part_poses.push_back(pose_of(now, part.body) * part.X_BV);
  std::vector<Tube> disks;
  const std::size_t rods = std::min(scene.rods.size(), now.rods.size());
  for (std::size_t i = 0; i < rods; ++i) {
    Tube tube = make_tube(scene.rods[i], look_of_rod(scene.rods[i], i), now.rods[i], decor.color_by,
                          color_range);
    for (const TendonSpec& tendon : scene.tendons)
      if (tendon.rod == static_cast<int>(i)) drawing.ribbons.push_back(make_tendon(tendon, tube));
    for (const DiskSpec& disk : scene.rods[i].disks)
      if (auto flat = make_disk(disk, tube)) disks.push_back(std::move(*flat));
    if (tube.rings.size() > 1) drawing.tubes.push_back(std::move(tube));
  }
  // behind all rods, whose tubes have the rods' numbers
  drawing.tubes.insert(drawing.tubes.end(), disks.begin(), disks.end());
  if (decor.contact_forces) {
    for (const ContactPoint& at : now.contact.points)
      add_arrow(at.position, *decor.contact_forces * at.force, drawing.tubes);
    for (const LinkContact& at : now.contact.links)
      add_arrow(at.position, *decor.contact_forces * at.force, drawing.tubes);
  }
  for (std::size_t i = 0; i < decor.traces.size(); ++i) {
    Ribbon ribbon = make_ribbon(decor.traces[i], i, now.time);
    if (ribbon.points.size() > 1) drawing.ribbons.push_back(std::move(ribbon));
  }
  return drawing;
}

Ball bounds_of(const std::vector<Part>& parts, const Drawing& drawing) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Vec3 low = Vec3::Constant(kInf), high = Vec3::Constant(-kInf);
  visit_corners(parts, drawing, false, [&](const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  });
  if (!low.allFinite() || !high.allFinite()) return {Vec3::Zero(), 0.5};
  return {0.5 * (low + high), std::max(0.5 * (high - low).norm(), 1e-4)};
}

double ground_height(const Scene& scene, const std::vector<Part>& parts, const Drawing& drawing) {
  const std::vector<bool> still = still_bodies(scene);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodySpec& body = scene.bodies[i];
    if (!still[i]) continue;
    for (const VisualSpec& visual : body.visuals) {
      const Pose X_WV = body.X_WB * visual.X_BV;
      if (is_level_plane(visual.shape, X_WV.R)) return X_WV.p.z();
    }
    for (const ColliderSpec& collider : body.colliders) {
      const Pose X_WC = body.X_WB * collider.X_BC;
      if (is_level_plane(collider.shape, X_WC.R)) return X_WC.p.z();
    }
  }
  double lowest = std::numeric_limits<double>::infinity();
  const auto lower = [&](const Vec3& p) { lowest = std::min(lowest, p.z()); };
  visit_corners(parts, drawing, true, lower);
  if (!std::isfinite(lowest)) lowest = 0;
  visit_corners(parts, drawing, false, lower);
  for (std::size_t i = 0; i < std::min(scene.rods.size(), drawing.tubes.size()); ++i) {
    const RodSpec& rod = scene.rods[i];
    if (rod.tip.joint != EndJoint::kFree || drawing.tubes[i].rings.empty()) continue;
    lowest = std::min(lowest, drawing.tubes[i].rings.front().position.z() - 1.02 * rod.length);
  }
  return lowest;
}

}  // namespace cprsim
