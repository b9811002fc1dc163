// SPDX-License-Identifier: BSD-3-Clause
// Layout: Khronos, glTF 2.0 Specification (2021), 4.4 (the binary form), 3.6 (buffers), 3.7.3
// (skins), 3.11 (animations). Written here rather than through tinygltf, which wants all keyframes
// of a run in memory at once.
#include "tools/gltf/glb.h"

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;

enum ComponentType { kShort = 5123, kInt = 5125, kFloat = 5126 };

enum Target { kNoTarget = 0, kVertices = 34962, kIndices = 34963 };

template <class Vector>
Json list_of(const Vector& v) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < v.size(); ++i)
    list.push_back(v[i]);
  return list;
}

std::string little_endian(std::uint32_t value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

std::uint64_t padded(std::uint64_t size) {
  return (size + 3) / 4 * 4;
}

/// Column after column.
std::array<float, 16> matrix_of(const Pose& pose) {
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  m.topLeftCorner<3, 3>() = pose.R.cast<float>();
  m.topRightCorner<3, 1>() = pose.p.cast<float>();
  std::array<float, 16> numbers;
  std::copy(m.data(), m.data() + 16, numbers.begin());
  return numbers;
}

}  // namespace

struct Glb::Document {
  struct Track {
    int node;
    GlbPath path;
    std::size_t array;
  };

  Json json;
  std::string bytes;  ///< of the binary chunk, before the keyframes
  std::vector<Track> tracks;

  int add(const char* list, Json entry) {
    json[list].push_back(std::move(entry));
    return static_cast<int>(json[list].size()) - 1;
  }

  int add_accessor(int view, ComponentType component, std::uint64_t count, const char* type) {
    return add(
        "accessors",
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
  }

  /// What is kept in memory. @param width numbers of an element
  template <class T>
  int add_data(const std::vector<T>& elements, Target target, ComponentType component,
               const char* type) {
    const std::size_t size = elements.size() * sizeof(T);
    Json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}};
    if (target != kNoTarget) view["target"] = target;
    bytes.append(reinterpret_cast<const char*>(elements.data()), size);
    bytes.resize(padded(bytes.size()));
    return add_accessor(add("bufferViews", view), component, elements.size(), type);
  }

  /// What follows from the spool, at this place of the binary chunk.
  int add_keyframes(const Spool& spool, std::size_t array, std::uint64_t offset, const char* type) {
    const Json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", spool.bytes(array)}};
    return add_accessor(add("bufferViews", view), kFloat, spool.rows(), type);
  }

  std::uint64_t add_animation(const Spool& spool, float first_time, float last_time);
};

Glb::Glb(const std::string& scene, const std::string& hash)
    : document_(std::make_unique<Document>()) {
  document_->json = {{"asset",
                      {{"version", "2.0"},
                       {"generator", "cprsim"},
                       {"extras", {{"scene", scene}, {"scene_hash", hash}}}}},
                     {"scene", 0},
                     {"scenes", {{{"name", scene}, {"nodes", Json::array()}}}}};
}

Glb::~Glb() = default;

int Glb::add_material(const GlbMaterial& material) {
  Json json = {{"pbrMetallicRoughness",
                {{"baseColorFactor", list_of(material.color)},
                 {"metallicFactor", 0},
                 {"roughnessFactor", material.roughness}}}};
  if (material.color.w() < 1) json["alphaMode"] = "BLEND";
  if (material.double_sided) json["doubleSided"] = true;
  return document_->add("materials", json);
}

int Glb::add_mesh(const std::string& name, const GlbMesh& mesh, int material) {
  Document& d = *document_;
  Json attributes;
  attributes["POSITION"] = d.add_data(mesh.positions, kVertices, kFloat, "VEC3");
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : mesh.positions)
    box.extend(p);
  d.json["accessors"].back()["min"] = list_of(box.min());
  d.json["accessors"].back()["max"] = list_of(box.max());
  attributes["NORMAL"] = d.add_data(mesh.normals, kVertices, kFloat, "VEC3");
  if (!mesh.colors.empty())
    attributes["COLOR_0"] = d.add_data(mesh.colors, kVertices, kFloat, "VEC4");
  if (!mesh.joints.empty()) {
    std::vector<std::array<std::uint16_t, 4>> joints;
    for (const std::uint16_t joint : mesh.joints)
      joints.push_back({joint, 0, 0, 0});
    attributes["JOINTS_0"] = d.add_data(joints, kVertices, kShort, "VEC4");
    // not as bytes, which the format allows and assimp 5.2 misreads
    const std::vector<std::array<float, 4>> weights(joints.size(), {1, 0, 0, 0});
    attributes["WEIGHTS_0"] = d.add_data(weights, kVertices, kFloat, "VEC4");
  }
  const int indices = d.add_data(mesh.indices, kIndices, kInt, "SCALAR");
  return d.add("meshes",
               {{"name", name},
                {"primitives",
                 {{{"attributes", attributes}, {"indices", indices}, {"material", material}}}}});
}

int Glb::add_camera(const std::string& name, double vertical_fov, double aspect) {
  return document_->add(
      "cameras",
      {{"name", name},
       {"type", "perspective"},
       {"perspective", {{"aspectRatio", aspect}, {"yfov", vertical_fov}, {"znear", 0.01}}}});
}

int Glb::add_node(const GlbNode& node) {
  Document& d = *document_;
  Json json = {{"name", node.name}};
  json["translation"] = list_of(node.X_PN.p);
  json["rotation"] = list_of(Quat(node.X_PN.R).normalized().coeffs());
  if (node.mesh >= 0) json["mesh"] = node.mesh;
  if (node.skin >= 0) json["skin"] = node.skin;
  if (node.camera >= 0) json["camera"] = node.camera;
  const int index = d.add("nodes", json);
  if (node.parent < 0)
    d.json["scenes"][0]["nodes"].push_back(index);
  else
    d.json["nodes"][static_cast<std::size_t>(node.parent)]["children"].push_back(index);
  return index;
}

int Glb::add_skin(const std::string& name, int root, const std::vector<int>& joints,
                  const std::vector<Pose>& inverse_binds) {
  std::vector<std::array<float, 16>> matrices;
  for (const Pose& pose : inverse_binds)
    matrices.push_back(matrix_of(pose));
  const int binds = document_->add_data(matrices, kNoTarget, kFloat, "MAT4");
  return document_->add(
      "skins",
      {{"name", name}, {"skeleton", root}, {"joints", joints}, {"inverseBindMatrices", binds}});
}

void Glb::animate(int node, GlbPath path, std::size_t array) {
  document_->tracks.push_back({node, path, array});
}

/// @return the size of the binary chunk
std::uint64_t Glb::Document::add_animation(const Spool& spool, float first_time, float last_time) {
  std::uint64_t at = bytes.size();
  const int time = add_keyframes(spool, 0, at, "SCALAR");
  json["accessors"].back()["min"] = {first_time};
  json["accessors"].back()["max"] = {last_time};
  at += spool.bytes(0);
  Json samplers = Json::array(), channels = Json::array();
  for (const Track& track : tracks) {
    const bool rotation = track.path == GlbPath::kRotation;
    const int output = add_keyframes(spool, track.array, at, rotation ? "VEC4" : "VEC3");
    at += spool.bytes(track.array);
    channels.push_back(
        {{"sampler", samplers.size()},
         {"target", {{"node", track.node}, {"path", rotation ? "rotation" : "translation"}}}});
    samplers.push_back({{"input", time}, {"output", output}, {"interpolation", "LINEAR"}});
  }
  add("animations", {{"name", "run"}, {"channels", channels}, {"samplers", samplers}});
  return at;
}

void Glb::write(OutputFile& file, const Spool& keyframes, float first_time, float last_time) {
  Document& d = *document_;
  const bool moves = !d.tracks.empty() && keyframes.rows() > 1;
  const std::uint64_t binary =
      moves ? d.add_animation(keyframes, first_time, last_time) : d.bytes.size();
  if (binary > 0) d.json["buffers"] = {{{"byteLength", binary}}};
  std::string text = d.json.dump();
  text.resize(padded(text.size()), ' ');
  const std::uint64_t total = 12 + 8 + text.size() + (binary > 0 ? 8 + padded(binary) : 0);
  if (total > std::numeric_limits<std::uint32_t>::max())
    throw OutputError("cannot write " + file.path().string() +
                      ": larger than glTF allows (4 GiB); ask for fewer frames");
  const auto size = [](std::uint64_t bytes) {
    return little_endian(static_cast<std::uint32_t>(bytes));
  };
  file.write("glTF" + little_endian(2) + size(total));
  file.write(size(text.size()) + "JSON" + text);
  if (binary == 0) return;
  file.write(size(padded(binary)) + std::string("BIN\0", 4) + d.bytes);
  const auto stream = [&](std::size_t array) {
    for_each_piece(keyframes, array, [&](const char* data, std::size_t bytes) {
      file.write({data, bytes});
    });
  };
  if (moves) {
    stream(0);
    for (const Document::Track& track : d.tracks)
      stream(track.array);
  }
  file.write(std::string(padded(binary) - binary, '\0'));
}

}  // namespace cprsim
