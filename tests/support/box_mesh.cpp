// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/box_mesh.h"

namespace cprsim {

MeshSpec box_mesh(const Vec3& size, const Vec3& at) {
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
