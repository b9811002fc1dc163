// SPDX-License-Identifier: BSD-3-Clause
// Channels: the one grammar by which recordings, expectations and plots name a number of the robot,
// `entity[.part].quantity[.component]` or `contact(entity,entity).quantity[.component]`. Names are
// resolved against a scene before anything runs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/model/touch.h"

namespace cprsim {

struct Scene;

enum class ChannelEntity {
  kBody,
  kFrame,
  kJoint,
  kRodPoint,
  kRod,
  kTendon,
  kEnergy,
  kSolver,
  kContact,
  kContactPair
};

enum class Quantity {
  kPosition,
  kOrientation,  ///< quaternion x y z w
  kLinearVelocity,
  kAngularVelocity,
  kForce,         ///< internal force n (base.wrench: see docs), world axes
  kMoment,        ///< internal moment m, world axes
  kCurvature,     ///< u, section axes
  kShearStretch,  ///< v, section axes
  kLength,
  kTension,       ///< of a tendon at its motor
  kEndTension,    ///< of a tendon where it is fastened: less, with friction
  kDisplacement,  ///< of a tendon: what its motor has pulled in
  kJointPosition,
  kJointVelocity,
  kJointEffort,
  kJointLimit,  ///< effort of the stops at the limits
  kEnergyKinetic,
  kEnergyElastic,
  kEnergyGravity,
  kEnergyMagnetic,
  kEnergyDissipated,
  kEnergyWork,
  kEnergyTotal,
  kEnergyBalance,
  kSolverIterations,
  kSolverResidual,
  kSolverStep,
  kSolverWallTime,
  kContactCount,
  kContactPenetration,
  kContactForce,
  kContactFriction,
  kContactSlip,
  kContactGap  ///< of a pair
};

/// One scalar of the robot's state.
struct Channel {
  std::string name;  ///< full, e.g. robot::platform.position.x
  std::string unit;  ///< "m", "rad/s", "1"
  ChannelEntity entity = ChannelEntity::kBody;
  int index = -1;  ///< of the body, frame, joint, rod or tendon in the scene
  double s = 0;    ///< rod points: fraction of the length, 0 base .. 1 tip
  Quantity quantity = Quantity::kPosition;
  int component = 0;  ///< x y z (w)
  ContactPair pair;   ///< of kContactPair
};

/// All scalar channels that `pattern` (with * globs) names; empty if none.
std::vector<Channel> find_channels(const Scene& scene, std::string_view pattern);

/// The known channel stems nearest to a misspelt one, best first, at most `count`.
std::vector<std::string> nearest_channels(const Scene& scene, std::string_view pattern,
                                          std::size_t count = 3);

}  // namespace cprsim
