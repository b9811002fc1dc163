// SPDX-License-Identifier: BSD-3-Clause
// What acts on the robot from outside: drives, loads, magnetic fields; and where drives are to
// bring it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/body_spec.h"
#include "engine/model/place.h"
#include "engine/model/place_law.h"
#include "engine/model/profile.h"

namespace cprsim {

enum class DriveQuantity { kPosition, kVelocity, kEffort, kLength, kTension, kDisplacement };

struct DriveSpec {
  Place place;
  DriveQuantity quantity = DriveQuantity::kPosition;
  int joint = -1;   ///< index into Scene::joints, or
  int rod = -1;     ///< index into Scene::rods (length), or
  int tendon = -1;  ///< index into Scene::tendons (tension, displacement)
  int freedom = 0;  ///< which coordinate of the joint, from 0
  Profile profile;
};

/// A force and torque at a point of a body, or of a rod at s = rod_s · length, or per length on a
/// part of a rod; times profile(t) (constant 1 if the scene gives no time function).
struct LoadSpec {
  Place place;
  int rod = -1;  ///< index into Scene::rods, or -1: acts on `at`
  double rod_s = 0;
  std::optional<double> to;  ///< spread evenly from rod_s to here; force N/m, torque N
  FrameRef at;
  bool follower = false;  ///< components in the axes of `at` or of the section instead of the world
  Mat3 R_expressed = Mat3::Identity();  ///< non-follower: axes of expressed_in at t = 0 in the
                                        ///< world; follower: in the axes of `at` or of the section
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< in the expressed_in axes
  int law = -1;  ///< along a rod: index into kPlaceLaws, instead of force and torque
  std::array<double, kLawNumbers> law_values{};
  bool has_profile = false;
  Profile profile;
};

/// A magnetic field that magnetised rods are in, world axes: uniform, or that of a dipole; times
/// profile(t) (constant 1 if the scene gives no time function).
struct MagneticFieldSpec {
  Place place;
  bool dipole = false;
  Vec3 uniform = Vec3::Zero();                          ///< T
  Vec3 position = Vec3::Zero(), moment = Vec3::Zero();  ///< of the dipole, m and A m²
  bool has_profile = false;
  Profile profile;
};

/// A frame that drives are to bring to a pose: a question to `cprsim solve`, without effect on a
/// run.
struct TargetSpec {
  Place place;
  FrameRef at;
  Pose X_WT;
  std::array<bool, 6> asked{true, true, true, true, true, true};  ///< x y z roll pitch yaw
  std::vector<int> drives;  ///< indices into Scene::drives of those that may change
};

}  // namespace cprsim
