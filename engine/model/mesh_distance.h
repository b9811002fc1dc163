// SPDX-License-Identifier: BSD-3-Clause
// Distance of a point to a triangle mesh with its first two derivatives. The nearest point y lies
// on a feature: inside a triangle, on an edge (tangent t) or at a corner. With n = (x - y) / d,
// outwards,
//   H = 0 off a triangle,  (I - t t^T - n n^T) / d off an edge,  (I - n n^T) / d off a corner  (1)
// The distance of a convex mesh has a continuous slope outside; that of a hollow one has kinks
// where two features are equally near.
//
// A mesh is closed if its edges cancel: each runs once in either direction. Then d is negative
// inside, by the sign of (x - y) . N with the normals of the triangles around the feature summed,
// weighted by their angles (Baerentzen, Aanaes, IEEE Trans. Vis. Comput. Graph. 11, 2005). An open
// one is a sheet without an inside: d is not negative and n points to where x is.
//
// Triangles are found through a tree of boxes, split in halves along the longest side. Bullet's
// trees are not used: their boxes are quantized and they do not look for what is nearest.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "engine/model/distance.h"

namespace cprsim {

class MeshDistance {
 public:
  explicit MeshDistance(const MeshSpec& mesh);

  bool closed() const { return closed_; }

  /// @param x in the mesh's frame, m.
  Distance operator()(const Vec3& x) const;

 private:
  struct Triangle {
    std::array<std::size_t, 3> corners{};
    Vec3 normal = Vec3::Zero();  ///< unit
    /// summed, of corners i and i + 1
    std::array<Vec3, 3> edge_normal{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    std::array<bool, 3> sharp{};  ///< whether the surface bends at the edge
  };

  /// The nearest point of a triangle; edge 3 is none, likewise corner.
  struct Nearest {
    Vec3 y = Vec3::Zero();
    double squared = 0;
    std::size_t triangle = 0, edge = 3, corner = 3;
  };

  struct Box {
    Vec3 low, high;
    std::size_t first = 0,
                count = 0;  ///< triangles; of inner boxes the children first and first + 1

    bool leaf() const { return count > 0; }

    double squared_distance(const Vec3& x) const {
      return (x - x.cwiseMax(low).cwiseMin(high)).squaredNorm();
    }
  };

  void join_triangles();
  void build(std::size_t box, std::size_t first, std::size_t count);
  Nearest nearest(const Vec3& x) const;
  Nearest nearest_on(std::size_t triangle, const Vec3& x) const;

  const Vec3& corner(const Triangle& triangle, std::size_t i) const {
    return corners_[triangle.corners[i]];
  }

  std::vector<Vec3> corners_;
  std::vector<Vec3> corner_normal_;  ///< weighted sums
  std::vector<Triangle> triangles_;
  std::vector<Box> boxes_;
  bool closed_ = false;
};

}  // namespace cprsim
