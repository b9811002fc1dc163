// SPDX-License-Identifier: BSD-3-Clause
// A glTF 2.0 file in its binary form: meshes, nodes, skins and one animation, whose keyframes come
// from a spool. Lengths in m, angles in rad, y up; colours are linear.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/math/types.h"
#include "tools/sinks/output_file.h"
#include "tools/sinks/spool.h"

namespace cprsim {

struct GlbMaterial {
  Eigen::Vector4f color{1, 1, 1, 1};  ///< linear RGB, opacity
  float roughness = 0.5F;
  bool double_sided = false;
};

/// Triangles, counter-clockwise seen from outside; as many normals as positions.
struct GlbMesh {
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<Eigen::Vector4f> colors;  ///< per vertex, times the material's; or none
  std::vector<std::uint16_t> joints;    ///< of a skin, the one that each vertex follows; or none
  std::vector<std::uint32_t> indices;
};

/// A pose below a parent; what is -1 it has not.
struct GlbNode {
  std::string name;
  int parent = -1;
  Pose X_PN = {};
  int mesh = -1, skin = -1, camera = -1;
};

enum class GlbPath { kTranslation, kRotation };

class Glb {
 public:
  Glb(const std::string& scene, const std::string& hash);
  ~Glb();
  Glb(const Glb&) = delete;
  Glb& operator=(const Glb&) = delete;

  int add_material(const GlbMaterial& material);
  int add_mesh(const std::string& name, const GlbMesh& mesh, int material);
  /// @param vertical_fov  rad
  int add_camera(const std::string& name, double vertical_fov, double aspect);
  int add_node(const GlbNode& node);
  /// @param inverse_binds  from mesh coordinates to those of each joint where the mesh is at rest
  int add_skin(const std::string& name, int root, const std::vector<int>& joints,
               const std::vector<Pose>& inverse_binds);

  /// Keyframes of a node: an array of the spool, floats x y z or quaternions x y z w. Times are the
  /// spool's array 0, in s.
  void animate(int node, GlbPath path, std::size_t array);

  /// @throws OutputError also if the file would be larger than its format allows (4 GiB)
  void write(OutputFile& file, const Spool& keyframes, float first_time, float last_time);

 private:
  struct Document;
  std::unique_ptr<Document> document_;
};

}  // namespace cprsim
