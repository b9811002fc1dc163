// SPDX-License-Identifier: BSD-3-Clause
#include "tools/gltf/tube_mesh.h"

namespace cprsim {

namespace {

class TubeMaker {
 public:
  TubeMaker(const std::vector<OutlinePoint>& outline, const std::vector<Pose>& poses,
            const std::vector<Vec2>& offsets)
      : outline_(outline), poses_(poses), offsets_(offsets) {}

  GlbMesh make() {
    const auto n = static_cast<std::uint32_t>(outline_.size());
    for (std::size_t ring = 0; ring < poses_.size(); ++ring)
      for (const OutlinePoint& q : outline_)
        add_vertex(ring, q.p, {q.n.x(), q.n.y(), 0});
    for (std::uint32_t i = 0; i + 1 < poses_.size(); ++i)
      for (std::uint32_t k = 0; k + 1 < n; ++k) {
        const std::uint32_t a = i * n + k, b = a + n;
        mesh_.indices.insert(mesh_.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
      }
    add_cap(0, -1);
    add_cap(poses_.size() - 1, 1);
    return std::move(mesh_);
  }

 private:
  void add_vertex(std::size_t ring, const Vec2& p, const Vec3& normal) {
    const Vec2 q = offsets_[ring] + p;
    mesh_.positions.push_back((poses_[ring] * Vec3(q.x(), q.y(), 0)).cast<float>());
    mesh_.normals.push_back((poses_[ring].R * normal).cast<float>());
    mesh_.joints.push_back(static_cast<std::uint16_t>(ring));
  }

  /// @param side  1 where the tangent points out of the tube, else -1
  void add_cap(std::size_t ring, int side) {
    const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
    const Vec3 normal(0, 0, side);
    add_vertex(ring, Vec2::Zero(), normal);
    for (const OutlinePoint& q : outline_)
      add_vertex(ring, q.p, normal);
    for (std::uint32_t k = 1; k < outline_.size(); ++k) {
      const std::uint32_t a = first + k, b = a + 1;
      mesh_.indices.insert(mesh_.indices.end(), {first, side > 0 ? a : b, side > 0 ? b : a});
    }
  }

  const std::vector<OutlinePoint>& outline_;
  const std::vector<Pose>& poses_;
  const std::vector<Vec2>& offsets_;
  GlbMesh mesh_;
};

}  // namespace

GlbMesh make_tube_mesh(const std::vector<OutlinePoint>& outline, const std::vector<Pose>& poses,
                       const std::vector<Vec2>& offsets) {
  return TubeMaker(outline, poses, offsets).make();
}

}  // namespace cprsim
