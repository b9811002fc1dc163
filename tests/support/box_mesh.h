// SPDX-License-Identifier: BSD-3-Clause
// A box as a mesh.
#pragma once

#include "engine/model/geometry.h"

namespace cprsim {

/// Twelve triangles, each side with corners of its own, as files have them.
/// @param at the middle, m
inline MeshSpec box_mesh(const Vec3& size, const Vec3& at = Vec3::Zero()) {
  MeshSpec mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const Vec3 n = side * Vec3::Unit(axis), u = Vec3::Unit((axis + 1) % 3), v = n.cross(u);
      const auto first = static_cast<unsigned>(mesh.positions.size());
      for (const Vec3& p : {Vec3(n - u - v), Vec3(n + u - v), Vec3(n + u + v), Vec3(n - u + v)})
        mesh.positions.emplace_back((at + 0.5 * size.cwiseProduct(p)).cast<float>());
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
  return mesh;
}

}  // namespace cprsim
