// SPDX-License-Identifier: BSD-3-Clause
// Every link, frame and joint pose against SDFormat's own library.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sdf/sdf.hh>

#include "tests/scenes/scene_text.h"

namespace cprsim {
namespace {

const char* const kTangled = R"(<?xml version="1.0"?>
<sdf version="1.9" xmlns:cprsim="urn:cprsim:1">
  <world name="w">
    <cprsim:simulation mode="static"/>
    <frame name="corner"><pose>1 2 3 0.1 0.2 0.3</pose></frame>
    <frame name="shelf" attached_to="corner"><pose degrees="true">0 0 1 0 45 90</pose></frame>
    <model name="a" canonical_link="second" placement_frame="grip">
      <static>true</static>
      <pose relative_to="shelf">0.5 -0.5 0.25 0.3 -0.2 0.1</pose>
      <link name="first"><pose>1 0 0 0 0 1.1</pose></link>
      <link name="second"><pose relative_to="first">0 1 0 0.4 0 0</pose></link>
      <frame name="grip" attached_to="second"><pose>0.1 0.2 0.3 0.7 0.8 0.9</pose></frame>
      <frame name="plain"><pose>0 0 2 0 1 0</pose></frame>
      <frame name="on_joint" attached_to="hinge"><pose>0.01 0 0 0 0 0.2</pose></frame>
      <joint name="hinge" type="revolute">
        <pose>0.3 0.2 0.1 0 0 0.5</pose>
        <parent>first</parent><child>second</child><axis><xyz>0 1 0</xyz></axis>
      </joint>
      <model name="inner" placement_frame="end">
        <pose relative_to="grip" rotation_format="quat_xyzw">0 0 1 0.1825741858350554 0.3651483716701107 0.5477225575051661 0.7302967433402214</pose>
        <link name="body"><pose>0.2 0.1 0 1 2 3</pose></link>
        <frame name="end" attached_to="body"><pose>0 0.5 0 0.2 0 0</pose></frame>
      </model>
      <frame name="reach" attached_to="inner::end"><pose>0 0 0.125 0 0 0</pose></frame>
    </model>
    <model name="b">
      <static>true</static>
      <pose relative_to="a">1 1 1 0.6 0.5 0.4</pose>
      <link name="only"><pose relative_to="__model__">0.1 0 0 0 0 0</pose></link>
    </model>
  </world>
</sdf>
)";

void compare(const std::string& name, const ignition::math::Pose3d& theirs, const Pose& ours) {
  const Quat q(theirs.Rot().W(), theirs.Rot().X(), theirs.Rot().Y(), theirs.Rot().Z());
  EXPECT_LT((Vec3(theirs.Pos().X(), theirs.Pos().Y(), theirs.Pos().Z()) - ours.p).norm(), 1e-12)
      << name;
  EXPECT_LT((q.normalized().toRotationMatrix() - ours.R).norm(), 1e-12) << name;
}

ignition::math::Pose3d resolved(const sdf::SemanticPose& pose, const std::string& to = "") {
  ignition::math::Pose3d X;
  const sdf::Errors errors = pose.Resolve(X, to);
  EXPECT_TRUE(errors.empty()) << errors.front().Message();
  return X;
}

Pose pose_of(const Scene& scene, const FrameRef& at) {
  return at.body == kWorld ? at.X_BF
                           : scene.bodies[static_cast<std::size_t>(at.body)].X_WB * at.X_BF;
}

int compare_model(const Scene& scene, const sdf::Model& model, const ignition::math::Pose3d& X_WM,
                  const std::string& prefix) {
  int count = 0;
  for (std::uint64_t k = 0; k < model.LinkCount(); ++k) {
    const std::string name = prefix + model.LinkByIndex(k)->Name();
    for (const BodySpec& body : scene.bodies)
      if (body.name == name) {
        compare(name, X_WM * resolved(model.LinkByIndex(k)->SemanticPose(), "__model__"),
                body.X_WB);
        ++count;
      }
  }
  for (std::uint64_t k = 0; k < model.FrameCount(); ++k) {
    const std::string name = prefix + model.FrameByIndex(k)->Name();
    for (const NamedFrame& frame : scene.frames)
      if (frame.name == name) {
        compare(name, X_WM * resolved(model.FrameByIndex(k)->SemanticPose(), "__model__"),
                pose_of(scene, frame.at));
        ++count;
      }
  }
  for (std::uint64_t k = 0; k < model.JointCount(); ++k) {
    const std::string name = prefix + model.JointByIndex(k)->Name();
    for (const JointSpec& joint : scene.joints)
      if (joint.name == name) {
        compare(name, X_WM * resolved(model.JointByIndex(k)->SemanticPose(), "__model__"),
                pose_of(scene, {joint.child, joint.X_CJ}));
        ++count;
      }
  }
  for (std::uint64_t k = 0; k < model.ModelCount(); ++k) {
    const sdf::Model& inner = *model.ModelByIndex(k);
    count += compare_model(scene, inner, X_WM * resolved(inner.SemanticPose(), "__model__"),
                           prefix + inner.Name() + "::");
  }
  return count;
}

int compare_scene(const std::string& text, const std::string& name) {
  const LoadResult ours = load_scene_text(text, name);
  EXPECT_TRUE(ours.scene) << to_text(ours.diagnostics);
  sdf::Root root;
  // what a scene includes lies beside it
  const std::filesystem::path folder = std::filesystem::path(name).parent_path();
  sdf::ParserConfig config = sdf::ParserConfig::GlobalConfig();
  config.SetFindCallback([&](const std::string& uri) { return (folder / uri).string(); });
  const sdf::Errors errors = root.LoadSdfString(text, config);
  for (const auto& error : errors)
    ADD_FAILURE() << name << ": " << error.Message();
  const sdf::World* world = root.WorldByIndex(0);
  if (!ours.scene || !world) return 0;
  int count = 0;
  for (std::uint64_t k = 0; k < world->FrameCount(); ++k)
    for (const NamedFrame& frame : ours.scene->frames)
      if (frame.name == world->FrameByIndex(k)->Name()) {
        compare(frame.name, resolved(world->FrameByIndex(k)->SemanticPose()),
                pose_of(*ours.scene, frame.at));
        ++count;
      }
  for (std::uint64_t k = 0; k < world->ModelCount(); ++k) {
    const sdf::Model& model = *world->ModelByIndex(k);
    count += compare_model(*ours.scene, model, resolved(model.SemanticPose()), model.Name() + "::");
  }
  const auto ours_alone = [](const JointSpec& joint) {
    return joint.kind == JointKind::kCylindrical || joint.kind == JointKind::kPlanar;
  };
  const std::vector<JointSpec>& joints = ours.scene->joints;
  const auto all =
      ours.scene->bodies.size() + ours.scene->frames.size() + joints.size() -
      static_cast<std::size_t>(std::count_if(joints.begin(), joints.end(), ours_alone));
  EXPECT_EQ(static_cast<std::size_t>(count), all) << name;
  return count;
}

TEST(FramePoses, EqualThoseOfSdformatInATangledScene) {
  EXPECT_EQ(compare_scene(kTangled, "tangled.xml"), 12);
}

TEST(FramePoses, EqualThoseOfSdformatInEveryShippedScene) {
  for (const auto& path : shipped_scenes())
    compare_scene(file_text(path), path.string());
}

}  // namespace
}  // namespace cprsim
