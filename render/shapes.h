// SPDX-License-Identifier: BSD-3-Clause
// Triangles of the shapes that bodies are made of, with slightly rounded edges that catch the
// light.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/geometry.h"

namespace cprsim {

struct Vertex {
  Eigen::Vector3f position, normal;
  std::array<std::uint8_t, 4> color;  ///< display RGB and opacity
};

struct TriMesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three a triangle, counter-clockwise seen from outside
};

std::array<std::uint8_t, 4> to_bytes(const Eigen::Vector3f& color, double opacity);

/// The shape in its own frame. A mesh keeps its own vertex colours unless the look was set by the
/// scene.
TriMesh make_shape(const ShapeSpec& shape, const Look& look, const std::vector<MeshSpec>& meshes);

}  // namespace cprsim
