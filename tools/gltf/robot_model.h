// SPDX-License-Identifier: BSD-3-Clause
// A robot as a glTF model: bodies as nodes with their visuals as meshes, each rod as one skinned
// tube whose joints lie along its centreline, tendons as thin tubes on the same joints. A keyframe
// is a pose for every body that moves and every joint.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/model/scene.h"
#include "engine/run/snapshot.h"
#include "tools/gltf/glb.h"

namespace cprsim {

class RobotModel {
 public:
  /// As the robot is in `first`, which also is the pose in which tubes are bound to their joints.
  RobotModel(const Scene& scene, const Snapshot& first);

  /// Bytes of a keyframe in each array of keyframes(): the time, then a translation and a rotation
  /// for each thing that moves.
  std::vector<std::size_t> widths() const;

  void add_keyframe(const Snapshot& now);

  /// Per array, since the last clear_keyframes().
  const std::vector<std::vector<float>>& keyframes() const { return keyframes_; }

  void clear_keyframes();

  Glb& glb() { return glb_; }

 private:
  /// A node and whom it follows.
  struct Follower {
    int body = -1, rod = -1;
    double s = 0;  ///< on the rod, fraction of its length
    Vec4 last_quaternion = Vec4::Zero();
  };

  void add_bodies(const Scene& scene, const Snapshot& first);
  void add_rod(const Scene& scene, std::size_t index, const RodSample& rod);
  void add_cameras(const Scene& scene, const Snapshot& first);
  void follow(int node, const Follower& follower);

  Glb glb_;
  int world_ = -1;  ///< node in whose coordinates z is up
  std::vector<Follower> followers_;
  std::vector<std::vector<float>> keyframes_;
};

}  // namespace cprsim
