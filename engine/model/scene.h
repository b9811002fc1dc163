// SPDX-License-Identifier: BSD-3-Clause
// What a scene file says: plain structs in SI units, every name resolved to an index, every pose in
// the world or in a body. Filled by scenes/loader, frozen into a Robot by engine/robot/build.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/accuracy_goal.h"
#include "engine/model/action_spec.h"
#include "engine/model/body_spec.h"
#include "engine/model/effects.h"
#include "engine/model/geometry.h"
#include "engine/model/record_spec.h"
#include "engine/model/rod_spec.h"
#include "engine/model/solver_spec.h"
#include "engine/model/sweep_spec.h"
#include "engine/model/tendon_spec.h"
#include "engine/model/tie_spec.h"
#include "engine/model/touch.h"
#include "engine/model/view_spec.h"

namespace cprsim {

/// A named <frame> (explicit), kept for channels and cameras.
struct NamedFrame {
  std::string name;  ///< scoped
  FrameRef at;
};

struct Scene {
  // Compiled once, in scene.cpp: dozens of files make and copy one.
  Scene();
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(const Scene&);
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  std::string name;
  std::vector<std::string>
      files;         ///< [0] the scene itself, then what it includes; Place::file indexes
  std::string hash;  ///< of the bytes of all files, hex

  Vec3 gravity{0, 0, -9.81};
  Vec3 wind = Vec3::Zero();                        ///< current of the fluid that drag is of, m/s
  std::vector<MagneticFieldSpec> magnetic_fields;  ///< their sum acts
  double max_step_size = 0.001;
  Effects effects;
  SimulationSpec simulation;
  std::optional<Vec3> planar_normal;  ///< motion across it only; unit, world axes
  SolverSpec solver;
  std::optional<AccuracyGoal> accuracy_goal;  ///< of solver.accuracy, if not distances in metres

  std::vector<MeshSpec> meshes;
  std::vector<BodySpec> bodies;
  std::vector<NamedFrame> frames;
  std::vector<JointSpec> joints;
  std::vector<RodSpec> rods;
  std::vector<TendonSpec> tendons;
  std::vector<TieSpec> ties;
  std::vector<DriveSpec> drives;
  std::vector<LoadSpec> loads;
  std::vector<TargetSpec> targets;

  EnvironmentSpec environment;
  std::vector<LightSpec> lights;
  std::vector<CameraSpec> cameras;
  std::vector<VideoSpec> videos;
  std::vector<RecordSpec> records;
  std::vector<ExpectSpec> expects;
  std::vector<SweepSpec> sweeps;
  std::vector<ContactPair> watched;  ///< see watch_pairs()
};

/// m; 1 without rods.
inline double longest_rod(const Scene& scene) {
  double length = 0;
  for (const RodSpec& rod : scene.rods)
    length = std::max(length, rod.length);
  return length > 0 ? length : 1;
}

}  // namespace cprsim
