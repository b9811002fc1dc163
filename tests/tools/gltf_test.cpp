// SPDX-License-Identifier: BSD-3-Clause
// The animated model as assimp reads it: where its skin is at an instant is where the rod was.
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include "tests/tools/scratch_folder.h"
#include "tests/tools/synthetic.h"
#include "tools/sinks/gltf_sink.h"

namespace cprsim {
namespace {

constexpr double kFps = 25, kEnd = 4.8;  // 121 keyframes: two blocks of the spool, nearly
constexpr double kRadius = 0.01, kLength = 0.5;

double curvature_at(double t) {
  return 1 + 0.8 * t;
}

/// A circular arc in the x-z plane that bends ever more, and turns about z.
Pose arc(double t, double s) {
  const double k = curvature_at(t), angle = k * kLength * s;
  const Mat3 turn = Eigen::AngleAxisd(2 * t, Vec3::UnitZ()).toRotationMatrix();
  return {turn * Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix(),
          turn * Vec3((1 - std::cos(angle)) / k, 0, std::sin(angle) / k)};
}

Snapshot state_at(double t) {
  Snapshot state = synthetic_state(t);
  state.bodies[0].X_WB = {Eigen::AngleAxisd(3 * t, Vec3(1, 2, 3).normalized()).toRotationMatrix(),
                          Vec3(t, -t, 1)};
  state.bodies.emplace_back().X_WB.p = Vec3(0, 0, -0.1);
  RodSample& rod = state.rods[0];
  rod.points.clear();
  for (int i = 0; i <= 16; ++i) {
    RodPoint point;
    point.s = i / 16.0;
    point.position = arc(t, point.s).p;
    point.rotation = arc(t, point.s).R;
    point.curvature = Vec3(0, curvature_at(t), 0);
    rod.points.push_back(point);
  }
  return state;
}

Scene scene_with_looks() {
  Scene scene = synthetic_scene();
  VisualSpec box;
  box.shape.kind = ShapeKind::kBox;
  box.shape.size = Vec3(0.1, 0.2, 0.3);
  box.X_BV.p = Vec3(0, 0, 0.05);
  scene.bodies[0].visuals = {box, box};
  scene.bodies.emplace_back().name = "ground";
  scene.bodies.back().is_static = true;
  scene.bodies.back().visuals = {box};
  scene.cameras.emplace_back().name = "side";
  TendonSpec tendon;
  tendon.name = "cable";
  tendon.rod = 0;
  tendon.radius = 0.02;
  tendon.termination = 0.5;
  scene.tendons.push_back(tendon);
  return scene;
}

/// z up to y up.
Vec3 turned(const Vec3& p) {
  return {p.x(), p.z(), -p.y()};
}

class Gltf : public testing::Test {
 protected:
  void record(const std::string& name = "run.glb") {
    GltfSink sink(scene_, kFps, folder_ / name, name);
    Snapshot before = state_at(0);
    sink.begin(before);
    for (int k = 1; k <= kEnd * kFps + 1e-9; ++k) {
      const Snapshot now = state_at(k / kFps);
      sink.step(before, now);
      before = now;
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / name));
    sink.finish();
    ASSERT_EQ(sink.files().size(), 1u);
    EXPECT_EQ(sink.files()[0].count, 121);
  }

  const aiScene* read() {
    const aiScene* model = importer_.ReadFile((folder_ / "run.glb").string(), 0);
    EXPECT_NE(model, nullptr) << importer_.GetErrorString();
    return model;
  }

  ScratchFolder folder_;
  Scene scene_ = scene_with_looks();
  Assimp::Importer importer_;
};

/// Keyframe k of a node, or where it stands.
aiMatrix4x4 local(const aiScene& model, const aiNode& node, unsigned k) {
  const aiAnimation& run = *model.mAnimations[0];
  for (unsigned c = 0; c < run.mNumChannels; ++c) {
    const aiNodeAnim& channel = *run.mChannels[c];
    if (channel.mNodeName != node.mName) continue;
    EXPECT_EQ(channel.mNumPositionKeys, 121u);
    EXPECT_NEAR(channel.mPositionKeys[k].mTime / run.mTicksPerSecond, k / kFps, 1e-5);
    return {aiVector3D(1, 1, 1), channel.mRotationKeys[k].mValue, channel.mPositionKeys[k].mValue};
  }
  return node.mTransformation;
}

aiMatrix4x4 global(const aiScene& model, const aiNode* node, unsigned k) {
  aiMatrix4x4 pose;
  for (; node != nullptr; node = node->mParent)
    pose = local(model, *node, k) * pose;
  return pose;
}

Vec3 vec(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

const aiMesh& mesh_named(const aiScene& model, const std::string& name) {
  for (unsigned i = 0; i < model.mNumMeshes; ++i)
    if (model.mMeshes[i]->mName.C_Str() == name) return *model.mMeshes[i];
  throw std::runtime_error("no mesh " + name);
}

TEST_F(Gltf, HasANodeForEveryThingAndMovesWhatMoves) {
  record();
  const aiScene* model = read();
  ASSERT_NE(model, nullptr);
  ASSERT_EQ(model->mNumAnimations, 1u);
  const aiAnimation& run = *model->mAnimations[0];
  EXPECT_EQ(run.mNumChannels, 1u + 33);  // the ball and the joints of the rod
  EXPECT_NEAR(run.mDuration / run.mTicksPerSecond, kEnd, 1e-5);
  EXPECT_EQ(model->mNumMeshes, 3u + 2);
  EXPECT_EQ(model->mNumCameras, 1u);
  for (const char* name : {"world", "ball", "ball visual 0", "ball visual 1", "ground", "rod",
                           "rod joints", "rod 0", "rod 32", "cable", "side"})
    EXPECT_NE(model->mRootNode->FindNode(name), nullptr) << name;
  EXPECT_EQ(mesh_named(*model, "rod").mNumBones, 33u);
  for (const unsigned k : {0u, 63u, 64u, 120u}) {
    const Pose X = state_at(k / kFps).bodies[0].X_WB;
    const aiMatrix4x4 ball = global(*model, model->mRootNode->FindNode("ball"), k);
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      const auto at = static_cast<Eigen::Vector3f>(p.cast<float>());
      EXPECT_LT((vec(ball * aiVector3D(at.x(), at.y(), at.z())) - turned(X * p)).norm(), 2e-6);
    }
  }
}

/// Where the vertices of a skinned mesh are, and which joint each follows.
std::vector<std::pair<Vec3, int>> skinned(const aiScene& model, const aiMesh& mesh, unsigned k) {
  std::vector<std::pair<Vec3, int>> vertices(mesh.mNumVertices, {Vec3::Zero(), -1});
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const aiMatrix4x4 moved =
        global(model, model.mRootNode->FindNode(bone.mName), k) * bone.mOffsetMatrix;
    const std::string name = bone.mName.C_Str();
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const auto [vertex, weight] = bone.mWeights[w];
      if (weight == 0) continue;
      EXPECT_EQ(weight, 1);
      vertices[vertex] = {vec(moved * mesh.mVertices[vertex]),
                          std::stoi(name.substr(name.rfind(' ')))};
    }
  }
  return vertices;
}

TEST_F(Gltf, TheSkinIsWhereTheRodIs) {
  record();
  const aiScene* model = read();
  ASSERT_NE(model, nullptr);
  for (const unsigned k : {0u, 40u, 120u}) {
    const double t = k / kFps;
    Eigen::AlignedBox3d box;
    for (const auto& [p, joint] : skinned(*model, mesh_named(*model, "rod"), k)) {
      ASSERT_GE(joint, 0);
      const Pose X = arc(t, joint / 32.0);
      const double distance = (p - turned(X.p)).norm();
      // on the outline, or the middle of a cap; between its points a rod sample is interpolated
      EXPECT_LT(std::min(std::abs(distance - kRadius), distance), 1e-5) << joint;
      EXPECT_LT(std::abs((p - turned(X.p)).dot(turned(X.R.col(2)))), 1e-5) << "in the section";
      box.extend(p);
    }
    const Vec3 tip = turned(arc(t, 1).p);
    EXPECT_LT(box.exteriorDistance(tip), 1e-6);
    EXPECT_NEAR(box.min().y(), 0, kRadius + 1e-5) << "y is up";
    const double bend = std::min(curvature_at(t) * kLength, 0.5 * std::numbers::pi);
    EXPECT_NEAR(box.max().y(), std::sin(bend) / curvature_at(t), kRadius + 1e-5);
    // the cable lies 2 cm beside the rod, up to its middle
    int last = 0;
    for (const auto& [p, joint] : skinned(*model, mesh_named(*model, "cable"), k)) {
      const Pose X = arc(t, joint / 32.0);
      EXPECT_LT((p - turned(X * Vec3(0.02, 0, 0))).norm(), 0.2 * kRadius);
      last = std::max(last, joint);
    }
    EXPECT_EQ(last, 16);
  }
}

TEST_F(Gltf, TrianglesFaceOutwards) {
  record();
  const aiScene* model = read();
  ASSERT_NE(model, nullptr);
  for (const char* name : {"rod", "cable", "ball visual 0"}) {
    const aiMesh& mesh = mesh_named(*model, name);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const unsigned* i = mesh.mFaces[f].mIndices;
      const Vec3 a = vec(mesh.mVertices[i[0]]), b = vec(mesh.mVertices[i[1]]),
                 c = vec(mesh.mVertices[i[2]]);
      const Vec3 normal = vec(mesh.mNormals[i[0]] + mesh.mNormals[i[1]] + mesh.mNormals[i[2]]);
      EXPECT_GT((b - a).cross(c - a).dot(normal), 0) << name << " " << f;
    }
  }
}

TEST_F(Gltf, IsTheSameFileEveryTime) {
  record("a.glb");
  record("b.glb");
  EXPECT_TRUE(contents(folder_ / "a.glb") == contents(folder_ / "b.glb"));
}

TEST_F(Gltf, OfAnInstantStandsStill) {
  GltfSink sink(scene_, kFps, folder_ / "run.glb", "run.glb");
  sink.begin(state_at(0));
  sink.finish();
  const aiScene* model = read();
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->mNumAnimations, 0u);
  EXPECT_EQ(model->mNumMeshes, 5u);
}

TEST_F(Gltf, OfAnEmptySceneIsAFileAllTheSame) {
  scene_ = Scene();
  GltfSink sink(scene_, kFps, folder_ / "run.glb", "run.glb");
  sink.begin(Snapshot());
  sink.finish();
  const std::string bytes = contents(folder_ / "run.glb");
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(bytes.size() % 4, 0u);
}

}  // namespace
}  // namespace cprsim
