// SPDX-License-Identifier: BSD-3-Clause
// Mesh files through assimp, as Gazebo reads them: node transforms and COLLADA's unit are applied,
// axes are left as they are in the file. Files may come from strangers: only four kinds are read,
// only regular files below the asset root are opened, and sizes, nesting, indices and numbers are
// checked.
#include "scenes/loader/meshes.h"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "scenes/loader/mesh_checks.h"

namespace cprsim {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTriangles = 4'000'000;
constexpr float kCrease = 40;  // degrees; sharper edges stay edges when normals are made
constexpr std::array<const char*, 5> kKinds{"stl", "obj", "dae", "gltf", "glb"};
constexpr std::array<const char*, 2> kCompanions{"mtl", "bin"};

std::string extension_of(const fs::path& path) {
  std::string text = path.extension().string();
  if (!text.empty()) text.erase(0, 1);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

template <std::size_t N>
bool is_one_of(const std::string& word, const std::array<const char*, N>& words) {
  return std::any_of(words.begin(), words.end(), [&](const char* w) { return word == w; });
}

/// A file in memory, read only.
class MemoryStream : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::vector<char> bytes) : bytes_(std::move(bytes)) {}

  std::size_t Read(void* to, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
    if (whole > 0) std::memcpy(to, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }

  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    std::size_t target = offset;
    if (origin == aiOrigin_CUR) target = at_ + offset;
    if (origin == aiOrigin_END) target = bytes_.size() - std::min(offset, bytes_.size());
    if (target > bytes_.size()) return aiReturn_FAILURE;
    at_ = target;
    return aiReturn_SUCCESS;
  }

  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }

  std::size_t Tell() const override { return at_; }

  std::size_t FileSize() const override { return bytes_.size(); }

  void Flush() override {}

 private:
  std::vector<char> bytes_;
  std::size_t at_ = 0;
};

/// Opens the mesh itself and its material and buffer files, if they lie below the root; nothing
/// else.
class FencedFiles : public Assimp::IOSystem {
 public:
  FencedFiles(fs::path mesh, fs::path root) : mesh_(std::move(mesh)), root_(std::move(root)) {}

  bool Exists(const char* name) const override { return !allowed(name).empty(); }

  char getOsSeparator() const override { return '/'; }

  Assimp::IOStream* Open(const char* name, const char* mode) override {
    const fs::path path = allowed(name);
    if (path.empty() || std::strpbrk(mode, "wa+") != nullptr) return nullptr;
    std::error_code problem;
    const auto size = fs::file_size(path, problem);
    if (problem || size > kLargestMeshFile - opened_) return nullptr;
    std::vector<char> bytes(size);
    std::ifstream in(path, std::ios::binary);
    if (!in.read(bytes.data(), static_cast<std::streamsize>(size))) return nullptr;
    if (path != mesh_) opened_ += size;
    return new MemoryStream(std::move(bytes));
  }

  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  fs::path allowed(const char* name) const {
    std::error_code problem;
    fs::path path = fs::canonical(name, problem);
    if (problem || !fs::is_regular_file(path, problem)) return {};
    const bool below =
        std::mismatch(root_.begin(), root_.end(), path.begin(), path.end()).first == root_.end();
    if (!below || (path != mesh_ && !is_one_of(extension_of(path), kCompanions))) return {};
    return path;
  }

  fs::path mesh_, root_;
  std::size_t opened_ = 0;
};

/// assimp would fall back on any of its fifty readers if the content looked like theirs.
void keep_only_known_kinds(Assimp::Importer& importer) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc* info = importer.GetImporterInfo(i);
    const std::string extensions = info && info->mFileExtensions ? info->mFileExtensions : "";
    const bool known = std::any_of(kKinds.begin(), kKinds.end(), [&](const char* kind) {
      return (" " + extensions + " ").find(std::string(" ") + kind + " ") != std::string::npos;
    });
    if (known) continue;
    Assimp::BaseImporter* unwanted = importer.GetImporter(i);
    importer.UnregisterLoader(unwanted);
    delete unwanted;
  }
}

/// Collects the triangles of a scene's nodes into one mesh.
class Gatherer {
 public:
  Gatherer(const aiScene& scene, MeshSpec& mesh, bool linear_colors)
      : scene_(scene), mesh_(mesh), linear_colors_(linear_colors) {}

  std::string gather(const Vec3& scale, const std::string& submesh);

  std::size_t dropped() const { return dropped_; }

 private:
  std::string add(const aiMesh& part, const aiMatrix4x4& X, const Vec3& scale);
  Eigen::Vector3f color_of(const aiMesh& part, unsigned vertex);
  bool has_color(const aiMesh& part) const;

  const aiScene& scene_;
  MeshSpec& mesh_;
  bool linear_colors_;
  bool colored_ = false;
  std::size_t dropped_ = 0;
};

bool Gatherer::has_color(const aiMesh& part) const {
  if (part.HasVertexColors(0)) return true;
  if (part.mMaterialIndex >= scene_.mNumMaterials) return false;
  const aiMaterial& material = *scene_.mMaterials[part.mMaterialIndex];
  aiString name;
  aiColor4D color;
  const bool made_up = material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS &&
                       std::strcmp(name.C_Str(), AI_DEFAULT_MATERIAL_NAME) == 0;
  return !made_up && material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS;
}

Eigen::Vector3f Gatherer::color_of(const aiMesh& part, unsigned vertex) {
  aiColor4D color(0.8F, 0.8F, 0.8F, 1);
  if (part.HasVertexColors(0)) {
    color = part.mColors[0][vertex];
  } else if (has_color(part)) {
    scene_.mMaterials[part.mMaterialIndex]->Get(AI_MATKEY_COLOR_DIFFUSE, color);
  }
  Eigen::Vector3f rgb(color.r, color.g, color.b);
  if (!rgb.allFinite()) rgb.setConstant(0.8F);
  rgb = rgb.cwiseMax(0.0F).cwiseMin(1.0F);
  return linear_colors_ ? Eigen::Vector3f(rgb.cwiseSqrt()) : rgb;
}

std::string Gatherer::add(const aiMesh& part, const aiMatrix4x4& X, const Vec3& scale) {
  Eigen::Matrix4d M;
  M << X.a1, X.a2, X.a3, X.a4, X.b1, X.b2, X.b3, X.b4, X.c1, X.c2, X.c3, X.c4, X.d1, X.d2, X.d3,
      X.d4;
  const Mat3 A = scale.asDiagonal() * M.topLeftCorner<3, 3>();
  const Vec3 b = scale.cwiseProduct(M.topRightCorner<3, 1>());
  if (!A.allFinite() || !b.allFinite()) return "a transform is not a finite number";
  // normals turn with the cofactors; a mirrored part turns its triangles round
  const bool mirrored = A.determinant() < 0;
  Mat3 N;
  N << A.col(1).cross(A.col(2)), A.col(2).cross(A.col(0)), A.col(0).cross(A.col(1));
  if (mirrored) N = -N;
  const auto first = static_cast<unsigned>(mesh_.positions.size());
  if (mesh_.triangles.size() + part.mNumFaces > kMostTriangles) {
    return "more than " + std::to_string(kMostTriangles) + " triangles";
  }
  colored_ = colored_ || has_color(part);
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    const Vec3 p = A * Vec3(v.x, v.y, v.z) + b;
    if (!p.allFinite() || p.norm() > 1e6) return "a vertex is not a finite number";
    Vec3 n = Vec3::Zero();
    if (part.HasNormals()) n = N * Vec3(part.mNormals[i].x, part.mNormals[i].y, part.mNormals[i].z);
    const bool good = n.allFinite() && n.norm() > 0;
    mesh_.positions.push_back(p.cast<float>());
    mesh_.normals.push_back(good ? Eigen::Vector3f(n.normalized().cast<float>())
                                 : Eigen::Vector3f::UnitZ());
    mesh_.colors.push_back(color_of(part, i));
  }
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices != 3) continue;
    std::array<unsigned, 3> t{face.mIndices[0], face.mIndices[1], face.mIndices[2]};
    if (std::any_of(t.begin(), t.end(), [&](unsigned i) { return i >= part.mNumVertices; })) {
      return "a triangle names a vertex that is not there";
    }
    for (unsigned& i : t)
      i += first;
    if (mirrored) std::swap(t[1], t[2]);
    const auto at = [&](unsigned i) { return mesh_.positions[i].cast<double>(); };
    const Vec3 u = at(t[1]) - at(t[0]), v = at(t[2]) - at(t[0]);
    // relative to the edges, so that small parts in metres are not mistaken for flat ones
    const bool flat = !(u.cross(v).norm() > 1e-9 * std::max(u.squaredNorm(), v.squaredNorm()));
    if (flat) {
      ++dropped_;
    } else {
      mesh_.triangles.push_back(t);
    }
  }
  return "";
}

std::string Gatherer::gather(const Vec3& scale, const std::string& submesh) {
  struct Visit {
    const aiNode* node;
    aiMatrix4x4 X;
    bool wanted;
  };

  std::vector<Visit> open{{scene_.mRootNode, aiMatrix4x4(), submesh.empty()}};
  while (!open.empty()) {
    const Visit now = open.back();
    open.pop_back();
    const aiMatrix4x4 X = now.X * now.node->mTransformation;
    const bool wanted = now.wanted || submesh == now.node->mName.C_Str();
    for (unsigned i = 0; i < now.node->mNumMeshes; ++i) {
      const unsigned index = now.node->mMeshes[i];
      if (index >= scene_.mNumMeshes) return "a node names a mesh that is not there";
      const aiMesh& part = *scene_.mMeshes[index];
      if (!wanted && submesh != part.mName.C_Str()) continue;
      const std::string problem = add(part, X, scale);
      if (!problem.empty()) return problem;
    }
    // in reverse, so that the first child is visited first
    for (unsigned i = now.node->mNumChildren; i-- > 0;) {
      open.push_back({now.node->mChildren[i], X, wanted});
    }
  }
  if (!colored_) mesh_.colors.clear();
  if (!mesh_.triangles.empty()) return "";
  if (dropped_ > 0) return "all its " + std::to_string(dropped_) + " triangles are without area";
  return submesh.empty() ? "it has no triangles" : "it has no submesh '" + submesh + "'";
}

void centre(MeshSpec& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : mesh.positions)
    box.extend(p);
  const Eigen::Vector3f middle = box.center();
  for (Eigen::Vector3f& p : mesh.positions)
    p -= middle;
}

std::string read(const fs::path& path, const fs::path& root, const Vec3& scale,
                 const std::string& submesh, MeshSpec& mesh, std::size_t* dropped) {
  const std::string kind = extension_of(path);
  Assimp::Importer importer;
  keep_only_known_kinds(importer);
  importer.SetIOHandler(new FencedFiles(path, root));  // which the importer then owns
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kCrease);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  unsigned steps = aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_GenSmoothNormals |
                   aiProcess_JoinIdenticalVertices;
  // an STL's normals are those of its facets and would hide that a surface is round
  if (kind == "stl") {
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS);
    steps |= aiProcess_RemoveComponent;
  }
  const aiScene* scene = importer.ReadFile(path.string(), steps);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string words = importer.GetErrorString();
    return "cannot be read" + (words.empty() ? std::string() : ": " + words);
  }
  Gatherer gatherer(*scene, mesh, kind == "gltf" || kind == "glb");
  const std::string problem = gatherer.gather(scale, submesh);
  if (dropped != nullptr) *dropped = gatherer.dropped();
  return problem;
}

}  // namespace

MeshSpec load_mesh(const std::string& path, const std::string& asset_root, const Vec3& scale,
                   const std::string& submesh, bool center, std::string& error,
                   std::size_t* dropped) {
  MeshSpec mesh;
  error.clear();
  if (dropped != nullptr) *dropped = 0;
  const std::string kind = extension_of(path);
  std::error_code problem;
  const fs::path file = fs::canonical(path, problem);
  if (!is_one_of(kind, kKinds)) {
    error = "the format '" + kind + "' is not read; use stl, obj, dae, gltf or glb";
  } else if (problem) {
    error = "cannot be opened: " + problem.message();
  } else if (!scale.allFinite() || scale.cwiseAbs().minCoeff() <= 0) {
    error = "a scale must not be 0";
  } else {
    const fs::path given = asset_root.empty() ? file.parent_path() : fs::path(asset_root);
    const fs::path root = fs::canonical(given, problem);
    error = problem ? "its folder cannot be opened: " + problem.message() : refusal(file, kind);
    try {
      if (error.empty()) error = read(file, root, scale, submesh, mesh, dropped);
    } catch (const std::exception& thrown) {
      error = std::string("cannot be read: ") + thrown.what();
    }
  }
  if (!error.empty()) return {};
  mesh.source = path;
  if (center) centre(mesh);
  return mesh;
}

}  // namespace cprsim
