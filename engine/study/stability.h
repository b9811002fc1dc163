// SPDX-License-Identifier: BSD-3-Clause
// Is an equilibrium stable? By the signs of its second variation: those of the robot's stiffness,
// condensed to its bodies and joints, and the number of unstable directions inside each rod whose
// ends are held (Haynsworth: the signs of a matrix are those of a block and of its Schur
// complement).
#pragma once

#include <string>
#include <vector>

#include "engine/study/robot_variation.h"
#include "engine/study/static_study.h"

namespace cprsim {

enum class StabilityVerdict { kStable, kUnstable, kSingular };

const char* to_string(StabilityVerdict verdict);

struct Stability {
  StabilityVerdict verdict = StabilityVerdict::kStable;
  int unstable = 0;  ///< directions in which energy falls
  /// Of these inside rods with their ends held, per rod of the scene.
  std::vector<int> in_rods;
  /// The softest motion and its stiffness, N/m: motions are measured as the root mean square
  /// displacement of all rods' material.
  double softest = 0;
  std::vector<Vec6> softest_bodies;  ///< (rotation, translation) per body of the Newton system
  VecX stiffnesses;  ///< so measured, ascending: all below some stable ones; by judge() alone
  /// Stiffness of bodies, each about its centre of mass (rotation, translation), and of joint
  /// coordinates, with rods in equilibrium; world axes; N/m, N, N m.
  MatX body_stiffness;
  /// Loads that have no potential (torques that keep their direction, followers) enter by their
  /// symmetric part: the verdict then is about divergence, not flutter.
  bool potential = true;
};

/// Stiffnesses below this count as none, N/m.
double no_stiffness(const StaticStudy& study);

/// Stiffness of bodies and joint coordinates with every rod in equilibrium, before rigid joints.
MatX condensed_stiffness(const RobotVariation& variation);

/// Judges the present equilibrium.
Stability judge(const StaticStudy& study);

/// Only the verdict and counts, an order of magnitude faster: for sweeps.
Stability count_unstable(const Robot& robot);

}  // namespace cprsim
