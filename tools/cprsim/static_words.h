// SPDX-License-Identifier: BSD-3-Clause
// Words of the commands that study a robot at rest: frames, poses, drives, wrenches by name. All
// functions throw UsageError, naming the option, for words that mean nothing in the scene.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "engine/study/inverse.h"
#include "tools/cprsim/command_line.h"

namespace cprsim {

/// "NAME=REST"
std::pair<std::string, std::string> split_assignment(const std::string& option,
                                                     const std::string& text);

/// A number, or an angle with the suffix deg (in rad).
double number_of(const std::string& option, const std::string& text);

/// Numbers between commas.
std::vector<double> numbers_of(const std::string& option, const std::string& text);

/// A link or frame by its scoped name, or "world".
FrameRef frame_named(const Scene& scene, const std::string& option, const std::string& name);

/// "robot::platform=0,0,0.4,0,10deg,0": x, y, z, roll, pitch, yaw; * leaves a freedom open; three
/// entries leave the rotation open.
PoseGoal pose_goal(const Scene& scene, const std::string& text);

/// What a <cprsim:target> of the scene asks.
PoseGoal pose_goal(const TargetSpec& target);

/// "robot::platform=0,0,-1" or with three torques more.
ProbeWrench wrench_of(const Scene& scene, const std::string& text);

/// The drive of that name ("robot::leg_1.length", or without its last part). Its index.
std::size_t drive_named(const StaticStudy& study, const std::string& name);

/// The drives of these names; without names all of them.
std::vector<Parameter> drives_or_all(const StaticStudy& study,
                                     const std::vector<std::string>& names);

/// All channels that the pattern names.
std::vector<Channel> channels_named(const Scene& scene, const std::string& option,
                                    const std::string& pattern);

/// "CHANNEL=VALUE".
ChannelGoal measured_channel(const Scene& scene, const std::string& text);

}  // namespace cprsim
