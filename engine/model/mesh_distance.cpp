// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace cprsim {
namespace {

constexpr std::size_t kLeaf = 4;  // triangles in the smallest boxes
// of a triangle: points this little outside are inside
constexpr double kSlack = 1e-12;
// sine of the angle between two triangles below which they are one: vertices have single precision
constexpr double kSmooth = 1e-6;

constexpr std::size_t next(std::size_t i) {
  return (i + 1) % 3;
}

}  // namespace

MeshDistance::MeshDistance(const MeshSpec& mesh) {
  // files have corners several times, with the normals of each side
  std::map<std::array<float, 3>, std::size_t> known;
  std::vector<std::size_t> index;
  for (const Eigen::Vector3f& p : mesh.positions) {
    // adding 0 makes -0 the same
    const auto [at, fresh] =
        known.try_emplace({p.x() + 0.0F, p.y() + 0.0F, p.z() + 0.0F}, corners_.size());
    if (fresh) corners_.emplace_back(p.cast<double>());
    index.push_back(at->second);
  }
  double volume = 0;
  for (const std::array<unsigned, 3>& t : mesh.triangles) {
    Triangle triangle;
    for (std::size_t i = 0; i < 3; ++i)
      triangle.corners[i] = index[t[i]];
    const Vec3 &a = corner(triangle, 0), &b = corner(triangle, 1), &c = corner(triangle, 2);
    triangle.normal = (b - a).cross(c - a).normalized();
    volume += a.dot(b.cross(c));
    if (triangle.normal.norm() > 0.5) triangles_.push_back(triangle);
  }
  join_triangles();
  if (closed_ && volume < 0) {
    // inside out
    for (Triangle& triangle : triangles_) {
      triangle.normal *= -1;
      for (Vec3& normal : triangle.edge_normal)
        normal *= -1;
    }
    for (Vec3& normal : corner_normal_)
      normal *= -1;
  }
  if (triangles_.empty()) return;
  boxes_.emplace_back();
  build(0, 0, triangles_.size());
}

void MeshDistance::join_triangles() {
  struct Edge {
    Vec3 sum = Vec3::Zero(), first = Vec3::Zero();
    int forward = 0, backward = 0;
    double bend = 0;
  };

  corner_normal_.assign(corners_.size(), Vec3::Zero());
  std::map<std::pair<std::size_t, std::size_t>, Edge> edges;
  const auto key = [](std::size_t a, std::size_t b) {
    return std::pair(std::min(a, b), std::max(a, b));
  };
  for (const Triangle& triangle : triangles_)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t a = triangle.corners[i], b = triangle.corners[next(i)];
      Edge& edge = edges[key(a, b)];
      if (edge.forward + edge.backward == 0)
        edge.first = triangle.normal;
      else
        edge.bend = std::max(edge.bend, (edge.first - triangle.normal).norm());
      edge.sum += triangle.normal;
      ++(a < b ? edge.forward : edge.backward);
      const Vec3 u = corners_[b] - corners_[a], v = corner(triangle, next(next(i))) - corners_[a];
      corner_normal_[a] += std::atan2(u.cross(v).norm(), u.dot(v)) * triangle.normal;
    }
  closed_ = std::all_of(edges.begin(), edges.end(), [](const auto& entry) {
    return entry.second.forward == entry.second.backward;
  });
  for (Triangle& triangle : triangles_)
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge& edge = edges.at(key(triangle.corners[i], triangle.corners[next(i)]));
      triangle.edge_normal[i] = edge.sum;
      triangle.sharp[i] = edge.forward + edge.backward == 1 || edge.bend > kSmooth;
    }
}

void MeshDistance::build(std::size_t box, std::size_t first, std::size_t count) {
  const double inf = std::numeric_limits<double>::infinity();
  Vec3 low = Vec3::Constant(inf), high = -low;
  const auto begin = triangles_.begin() + static_cast<std::ptrdiff_t>(first),
             end = begin + static_cast<std::ptrdiff_t>(count);
  std::for_each(begin, end, [&](const Triangle& triangle) {
    for (std::size_t i = 0; i < 3; ++i) {
      low = low.cwiseMin(corner(triangle, i));
      high = high.cwiseMax(corner(triangle, i));
    }
  });
  boxes_[box] = {low, high, first, count};
  if (count <= kLeaf) return;
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const auto middle = [&](const Triangle& triangle) {
    return corner(triangle, 0)[axis] + corner(triangle, 1)[axis] + corner(triangle, 2)[axis];
  };
  std::stable_sort(begin, end,
                   [&](const Triangle& a, const Triangle& b) { return middle(a) < middle(b); });
  const std::size_t child = boxes_.size();
  boxes_[box].first = child;
  boxes_[box].count = 0;
  boxes_.resize(boxes_.size() + 2);
  build(child, first, count / 2);
  build(child + 1, first + count / 2, count - count / 2);
}

// Where the foot of x on the plane is within the triangle, that; else on the nearest edge.
MeshDistance::Nearest MeshDistance::nearest_on(std::size_t index, const Vec3& x) const {
  const Triangle& triangle = triangles_[index];
  Nearest out;
  out.triangle = index;
  const Vec3& first = corner(triangle, 0);
  const double height = triangle.normal.dot(x - first);
  const Vec3 foot = x - height * triangle.normal;
  const auto area = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return (b - a).cross(c - a).dot(triangle.normal);
  };
  const double whole = area(first, corner(triangle, 1), corner(triangle, 2));
  bool within = true;
  for (std::size_t i = 0; i < 3 && within; ++i)
    within = area(corner(triangle, i), corner(triangle, next(i)), foot) / whole >= -kSlack;
  if (within) {
    out.y = foot;
    out.squared = height * height;
    return out;
  }
  out.squared = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = corner(triangle, i), along = corner(triangle, next(i)) - a;
    const double at = along.dot(x - a) / along.squaredNorm();
    const Vec3 y = a + std::clamp(at, 0.0, 1.0) * along;
    const double squared = (x - y).squaredNorm();
    if (squared >= out.squared) continue;
    out.squared = squared;
    out.y = y;
    const bool on_edge = at >= -kSlack && at <= 1 + kSlack;
    out.edge = on_edge ? i : 3;
    out.corner = on_edge ? 3 : at < 0 ? i : next(i);
  }
  return out;
}

MeshDistance::Nearest MeshDistance::nearest(const Vec3& x) const {
  struct Visit {
    std::size_t box;
    double squared;
  };

  // four million triangles in halves of halves are twenty deep
  std::array<Visit, 64> open;
  std::size_t count = 0;
  Nearest best;
  best.squared = std::numeric_limits<double>::infinity();
  open[count++] = {0, boxes_.front().squared_distance(x)};
  while (count > 0) {
    const Visit now = open[--count];
    if (now.squared >= best.squared) continue;
    const Box& box = boxes_[now.box];
    if (box.leaf()) {
      for (std::size_t i = box.first; i < box.first + box.count; ++i)
        if (const Nearest found = nearest_on(i, x); found.squared < best.squared) best = found;
      continue;
    }
    Visit near{box.first, boxes_[box.first].squared_distance(x)},
        far{box.first + 1, boxes_[box.first + 1].squared_distance(x)};
    if (far.squared < near.squared) std::swap(near, far);
    open[count++] = far;
    open[count++] = near;
  }
  return best;
}

Distance MeshDistance::operator()(const Vec3& x) const {
  const Nearest at = nearest(x);
  const Triangle& triangle = triangles_[at.triangle];
  const Vec3 gap = x - at.y;
  Distance out;
  if (at.edge == 3 && at.corner == 3) {
    const double height = triangle.normal.dot(gap);
    const double side = !closed_ && height < 0 ? -1 : 1;
    out.d = side * height;
    out.n = side * triangle.normal;
    return out;
  }
  const bool edge = at.edge < 3;
  const Vec3& around =
      edge ? triangle.edge_normal[at.edge] : corner_normal_[triangle.corners[at.corner]];
  const double size = std::sqrt(at.squared);
  out.d = closed_ && gap.dot(around) < 0 ? -size : size;
  out.n = size > 0 ? Vec3(gap / out.d) : Vec3(around.normalized());
  if (size == 0 || (edge && !triangle.sharp[at.edge])) return out;
  out.H = Mat3::Identity() - out.n * out.n.transpose();
  if (edge) {
    const Vec3 t = (corner(triangle, next(at.edge)) - corner(triangle, at.edge)).normalized();
    out.H -= t * t.transpose();
  }
  out.H /= out.d;
  return out;
}

}  // namespace cprsim
