// SPDX-License-Identifier: BSD-3-Clause
// Inverse problems of statics: which drives put a frame where it is wanted, which wrench explains
// what was measured. Some parameters are free, some numbers of the equilibrium are prescribed.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "engine/model/channel.h"
#include "engine/study/static_study.h"

namespace cprsim {

/// What is asked of an equilibrium: rows that are to vanish, in units in which 1 is large.
using Goal = std::function<VecX(const StaticStudy&)>;

/// A frame at a pose, of which `asked` says the freedoms that count: x, y, z, then roll, pitch,
/// yaw. With all three angles the row is the rotation vector from the target, else differences of
/// angles.
struct PoseGoal {
  FrameRef at;
  Vec3 position = Vec3::Zero();
  Vec3 angles = Vec3::Zero();  ///< roll, pitch, yaw as in the scene file, rad
  std::array<bool, 6> asked{true, true, true, true, true, true};
};

/// The pose of a frame now.
Pose pose_of(const StaticStudy& study, const FrameRef& frame);

/// Roll, pitch, yaw of a rotation: R = Rz(yaw) Ry(pitch) Rx(roll).
Vec3 angles_of(const Mat3& R);

/// @param length unit of the position rows, m
Goal reach(const PoseGoal& goal, double length);

/// A channel has the given value; `unit` is the size of a large deviation.
struct ChannelGoal {
  Channel channel;
  double value = 0;
  double unit = 1;
};

Goal match(const std::vector<ChannelGoal>& goals);

/// All rows of several goals.
Goal both(std::vector<Goal> goals);

struct InverseOptions {
  double tolerance = 1e-11;  ///< of the largest row
  int max_iterations = 60;   ///< outer iterations over all parts of the way
};

struct InverseReport {
  bool reached = false;
  SolveReport solve;    ///< of the last equilibrium
  double residual = 0;  ///< largest row of the goal
  int iterations = 0;   ///< outer
  double weakest = 0;   ///< smallest over largest singular value of the rows by the parameters
  std::string why;      ///< a sentence when not reached
};

/// Derivatives of the goal's rows by the parameters (columns, per unit of `units`), by central
/// differences of single Newton steps: the equilibrium's own tangent, to second order in a change
/// of 1e-5 units. The equilibrium is left as it was.
/// @return false if the equilibrium is singular
bool goal_jacobian(StaticStudy& study, const std::vector<Parameter>& parameters, const VecX& units,
                   const Goal& goal, MatX& jacobian);

/// A natural size of a change of each parameter.
VecX parameter_units(const StaticStudy& study, const std::vector<Parameter>& parameters);

/// Changes the parameters until the goal is met (in the least-squares sense where there are more
/// rows than parameters, by the smallest change where there are fewer), from the present
/// equilibrium. Where Newton's method does not get there, the goal is approached in steps.
InverseReport solve_inverse(StaticStudy& study, const std::vector<Parameter>& parameters,
                            const Goal& goal, const InverseOptions& options = {});

}  // namespace cprsim
