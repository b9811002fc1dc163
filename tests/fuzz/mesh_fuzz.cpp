// SPDX-License-Identifier: BSD-3-Clause
// A mesh is loaded with finite vertices and triangles among them, or refused. The first byte
// chooses the format.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "scenes/loader/meshes.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cprsim;
  namespace fs = std::filesystem;
  if (size == 0) return 0;
  static const fs::path folder =
      fs::temp_directory_path() / ("cprsim_mesh_fuzz." + std::to_string(::getpid()));
  fs::create_directories(folder);
  constexpr const char* kEndings[] = {"stl", "obj", "dae", "gltf", "glb"};
  const fs::path path = folder / (std::string("mesh.") + kEndings[data[0] % 5]);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data + 1), static_cast<std::streamsize>(size - 1));
  std::string error;
  const MeshSpec mesh = load_mesh(path.string(), folder.string(), Vec3::Ones(), "", false, error);
  fs::remove_all(folder);
  if (!error.empty()) return 0;
  require(mesh.normals.size() == mesh.positions.size(), "every vertex has a normal");
  for (const auto& p : mesh.positions)
    require(p.allFinite(), "vertices are finite");
  for (const auto& triangle : mesh.triangles)
    for (const unsigned corner : triangle)
      require(corner < mesh.positions.size(), "corners are vertices");
  return 0;
}
