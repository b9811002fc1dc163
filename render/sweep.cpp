// SPDX-License-Identifier: BSD-3-Clause
#include "render/sweep.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cprsim {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSmallestWidth = 1.2;  // pixels; with 4 samples a thinner line breaks into dots

/// A point of the section's outline and its outward normal, in section axes.
struct OutlinePoint {
  Vec2 p, n;
};

std::vector<OutlinePoint> ellipse(double a, double b, int sides) {
  std::vector<OutlinePoint> outline;
  for (int k = 0; k <= sides; ++k) {
    const double t = 2 * kPi * k / sides, c = std::cos(t), s = std::sin(t);
    outline.push_back({{a * c, b * s}, Vec2(b * c, a * s).normalized()});
  }
  return outline;
}

std::vector<OutlinePoint> rectangle(double width, double height) {
  const double x = 0.5 * width, y = 0.5 * height;
  return {{{x, -y}, {1, 0}},   {{x, y}, {1, 0}},   {{x, y}, {0, 1}},
          {{-x, y}, {0, 1}},   {{-x, y}, {-1, 0}}, {{-x, -y}, {-1, 0}},
          {{-x, -y}, {0, -1}}, {{x, -y}, {0, -1}}, {{x, -y}, {1, 0}}};
}

std::vector<OutlinePoint> outline_of(const Tube& tube, double pixels) {
  // an error of the polygon of 1/8 pixel is invisible: cos(pi / sides) = 1 - 1 / (8 r)
  const int sides = std::clamp(static_cast<int>(2 * std::sqrt(4 + 5 * pixels)), 8, 48);
  const Vec2& size = tube.section.size;
  if (tube.section.shape == SectionShape::kRectangle && size.minCoeff() > 0) {
    return rectangle(size.x(), size.y());
  }
  if (tube.section.shape == SectionShape::kEllipse && size.minCoeff() > 0) {
    return ellipse(size.x(), size.y(), sides);
  }
  return ellipse(tube.radius, tube.radius, sides);
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

}  // namespace

void sweep_tube(const Tube& tube, const View& view, TriMesh& mesh) {
  if (tube.rings.size() < 2) return;
  double finest = view.pixel_size(tube.rings.front().position);
  for (const Tube::Ring& ring : tube.rings) {
    finest = std::min(finest, view.pixel_size(ring.position));
  }
  const std::vector<OutlinePoint> outline = outline_of(tube, tube.radius / finest);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto n = static_cast<std::uint32_t>(outline.size());
  Mat3 R = tube.rings.front().rotation;
  for (const Tube::Ring& ring : tube.rings) {
    R = is_round(tube) ? carried(R, ring.rotation) : ring.rotation;
    const double least = 0.5 * kSmallestWidth * view.pixel_size(ring.position);
    const double scale = std::max(1.0, least / std::max(tube.radius, 1e-12));
    const auto color = to_bytes(ring.color, tube.look.opacity);
    for (const OutlinePoint& q : outline) {
      const Vec3 p = ring.position + scale * (R.leftCols<2>() * q.p);
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
  for (std::uint32_t i = 0; i + 1 < count; ++i) {
    const std::uint32_t a = first + 2 * i;
    mesh.indices.insert(mesh.indices.end(), {a, a + 1, a + 3, a, a + 3, a + 2});
  }
}

}  // namespace cprsim
