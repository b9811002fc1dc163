// SPDX-License-Identifier: BSD-3-Clause
#include "render/sweep.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/outline.h"

namespace cprsim {

namespace {

constexpr double kSmallestWidth = 1.2;  // pixels; with 4 samples a thinner line breaks into dots

std::vector<OutlinePoint> outline_of(const Tube& tube, double pixels) {
  // an error of the polygon of 1/8 pixel is invisible: cos(pi / sides) = 1 - 1 / (8 r)
  const int sides = std::clamp(static_cast<int>(2 * std::sqrt(4 + 5 * pixels)), 8, 48);
  return section_outline(tube.section, tube.radius, sides);
}

bool is_round(const Tube& tube) {
  return tube.section.shape == SectionShape::kCircle ||
         tube.section.shape == SectionShape::kAnnulus;
}

/// The frame at b that follows from R at a without turning about the tangent, so that a twisted
/// round rod is swept without wringing.
Mat3 carried(const Mat3& R, const Mat3& R_b) {
  const Vec3 z = R_b.col(2);
  Vec3 x = R.col(0) - z * z.dot(R.col(0));
  if (x.norm() < 1e-6) return R_b;
  x.normalize();
  Mat3 carried_frame;
  carried_frame << x, z.cross(x), z;
  return carried_frame;
}

void add_cap(const std::vector<OutlinePoint>& outline, std::size_t rim, const Tube::Ring& ring,
             const Vec3& normal, TriMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const Eigen::Vector3f n = normal.cast<float>();
  const auto color = mesh.vertices[rim].color;
  mesh.vertices.push_back({ring.position.cast<float>(), n, color});
  for (std::size_t k = 0; k < outline.size(); ++k) {
    mesh.vertices.push_back({mesh.vertices[rim + k].position, n, color});
  }
  for (std::uint32_t k = 1; k < outline.size(); ++k) {
    mesh.indices.insert(mesh.indices.end(), {first, first + k, first + k + 1});
  }
}

/// Half of a rod's round, the half that is seen, in as few faces as a thin rod needs: its edge is
/// exact and its shading that of the round, because the normals are.
void sweep_front(const Tube& tube, const View& view, int faces, TriMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto n = static_cast<std::uint32_t>(faces) + 1;
  for (const Tube::Ring& ring : tube.rings) {
    const Vec3 to_eye = view.eye - ring.position;
    const Vec3 side = to_eye.cross(ring.rotation.col(2)).normalized();
    const Vec3 front = ring.rotation.col(2).cross(side);
    const double r = std::max(tube.radius, 0.5 * kSmallestWidth * view.pixel_size(ring.position));
    const auto color = to_bytes(ring.color, tube.look.opacity);
    for (std::uint32_t k = 0; k < n; ++k) {
      const double a = std::numbers::pi * k / faces;
      const Vec3 normal = std::cos(a) * side + std::sin(a) * front;
      mesh.vertices.push_back(
          {(ring.position + r * normal).cast<float>(), normal.cast<float>(), color});
    }
  }
  for (std::uint32_t i = 0; i + 1 < tube.rings.size(); ++i) {
    for (std::uint32_t k = 0; k + 1 < n; ++k) {
      const std::uint32_t a = first + i * n + k, b = a + n;
      mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  }
}

/// Is the rod thin in the picture and nowhere seen along its length?
bool is_thin(const Tube& tube, const View& view, double pixels) {
  constexpr double kThin = 5;      // pixels of radius; beyond, caps and the far side begin to show
  constexpr double kAlong = 0.94;  // cosine; beyond, a half round does not cover the whole
  // one of two rings is a disk
  if (!is_round(tube) || pixels > kThin || tube.rings.size() < 3) return false;
  return std::none_of(tube.rings.begin(), tube.rings.end(), [&](const Tube::Ring& ring) {
    return std::abs(ring.rotation.col(2).dot((view.eye - ring.position).normalized())) > kAlong;
  });
}

/// The section turned about the centreline, as it is, with caps.
void sweep_whole(const Tube& tube, const View& view, double pixels, TriMesh& mesh) {
  const std::vector<OutlinePoint> outline = outline_of(tube, pixels);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto n = static_cast<std::uint32_t>(outline.size());
  Mat3 R = tube.rings.front().rotation;
  for (const Tube::Ring& ring : tube.rings) {
    R = is_round(tube) ? carried(R, ring.rotation) : ring.rotation;
    const double least = 0.5 * kSmallestWidth * view.pixel_size(ring.position);
    const double scale = std::max(1.0, least / std::max(tube.radius, 1e-12));
    const auto color = to_bytes(ring.color, tube.look.opacity);
    for (const OutlinePoint& q : outline) {
      const Vec3 p = ring.position + scale * ring.width * (R.leftCols<2>() * q.p);
      const Vec3 normal = R.leftCols<2>() * q.n;
      mesh.vertices.push_back({p.cast<float>(), normal.cast<float>(), color});
    }
  }
  for (std::uint32_t i = 0; i + 1 < tube.rings.size(); ++i) {
    for (std::uint32_t k = 0; k + 1 < n; ++k) {
      const std::uint32_t a = first + i * n + k, b = a + n;
      mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  }
  const std::size_t last_rim = first + (tube.rings.size() - 1) * n;
  add_cap(outline, first, tube.rings.front(), -tube.rings.front().rotation.col(2), mesh);
  add_cap(outline, last_rim, tube.rings.back(), tube.rings.back().rotation.col(2), mesh);
}

/// A band of two vertices a point.
void add_band(std::uint32_t first, std::size_t points, TriMesh& mesh) {
  for (std::uint32_t i = 0; i + 1 < points; ++i) {
    const std::uint32_t a = first + 2 * i;
    mesh.indices.insert(mesh.indices.end(), {a, a + 1, a + 3, a, a + 3, a + 2});
  }
}

}  // namespace

void sweep_tube(const Tube& tube, const View& view, TriMesh& mesh) {
  if (tube.rings.size() < 2) return;
  double finest = view.pixel_size(tube.rings.front().position);
  for (const Tube::Ring& ring : tube.rings) {
    finest = std::min(finest, view.pixel_size(ring.position));
  }
  const double pixels = view.fineness * tube.radius / finest;
  if (is_thin(tube, view, pixels)) {
    sweep_front(tube, view, pixels < 2 ? 2 : 4, mesh);
  } else {
    sweep_whole(tube, view, pixels, mesh);
  }
}

void sweep_shadow(const Tube& tube, const Vec3& to_light, TriMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  Vec3 side = Vec3::UnitX();
  for (const Tube::Ring& ring : tube.rings) {
    const Vec3 across = to_light.cross(ring.rotation.col(2));
    if (across.norm() > 1e-6) side = across.normalized();
    for (double reach : {ring.width * tube.radius, -ring.width * tube.radius}) {
      mesh.vertices.push_back(
          {(ring.position + reach * side).cast<float>(), Eigen::Vector3f::UnitZ(), {0, 0, 0, 255}});
    }
  }
  add_band(first, tube.rings.size(), mesh);
}

void sweep_ribbon(const Ribbon& ribbon, const View& view, TriMesh& mesh) {
  const std::size_t count = ribbon.points.size();
  if (count < 2) return;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  Vec3 last_side = view.R_WC.col(0);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& p = ribbon.points[i].position;
    const Vec3 along = ribbon.points[std::min(i + 1, count - 1)].position -
                       ribbon.points[i > 0 ? i - 1 : 0].position;
    const Vec3 side = along.cross(view.eye - p);
    if (side.norm() > 1e-9 * along.norm() * (view.eye - p).norm() && side.norm() > 0) {
      last_side = side.normalized();
    }
    const Vec3 reach = 0.5 * ribbon.pixels * view.pixel_size(p) * last_side;
    const auto color = to_bytes(ribbon.color, ribbon.points[i].opacity);
    mesh.vertices.push_back({(p + reach).cast<float>(), Eigen::Vector3f::UnitZ(), color});
    mesh.vertices.push_back({(p - reach).cast<float>(), Eigen::Vector3f::UnitZ(), color});
  }
  add_band(first, count, mesh);
}

}  // namespace cprsim
