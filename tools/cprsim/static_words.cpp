// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/static_words.h"

#include <fmt/core.h>

#include <numbers>

#include "scenes/loader/values.h"

namespace cprsim {

std::pair<std::string, std::string> split_assignment(const std::string& option,
                                                     const std::string& text) {
  const std::size_t at = text.find('=');
  if (at == std::string::npos || at == 0)
    throw UsageError(fmt::format("{}: '{}' is not of the form NAME=VALUE", option, text));
  return {text.substr(0, at), text.substr(at + 1)};
}

double number_of(const std::string& option, const std::string& text) {
  const bool degrees = text.ends_with("deg");
  const auto value =
      parse_number(std::string_view(text).substr(0, text.size() - (degrees ? 3 : 0)));
  if (!value) throw UsageError(fmt::format("{}: '{}' is not a number", option, text));
  return degrees ? *value * std::numbers::pi / 180 : *value;
}

std::vector<double> numbers_of(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& part : split(text, ','))
    numbers.push_back(number_of(option, part));
  return numbers;
}

FrameRef frame_named(const Scene& scene, const std::string& option, const std::string& name) {
  if (name == "world") return {};
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return {static_cast<int>(i), Pose{}};
    names.push_back(scene.bodies[i].name);
  }
  for (const NamedFrame& frame : scene.frames) {
    if (frame.name == name) return frame.at;
    names.push_back(frame.name);
  }
  throw UsageError(option + ": " + not_one_of(name, "a link or frame of the scene", names));
}

PoseGoal pose_goal(const Scene& scene, const std::string& text) {
  const auto [name, values] = split_assignment("--pose", text);
  PoseGoal goal;
  goal.at = frame_named(scene, "--pose", name);
  const std::vector<std::string> parts = split(values, ',');
  if (parts.size() != 3 && parts.size() != 6)
    throw UsageError(fmt::format("--pose: '{}' has {} entries, not x,y,z or x,y,z,roll,pitch,yaw",
                                 values, parts.size()));
  for (std::size_t i = 0; i < 6; ++i) {
    goal.asked[i] = i < parts.size() && parts[i] != "*";
    if (!goal.asked[i]) continue;
    const double value = number_of("--pose", parts[i]);
    (i < 3 ? goal.position[static_cast<Eigen::Index>(i)]
           : goal.angles[static_cast<Eigen::Index>(i - 3)]) = value;
  }
  return goal;
}

PoseGoal pose_goal(const TargetSpec& target) {
  return {target.at, target.X_WT.p, angles_of(target.X_WT.R), target.asked};
}

ProbeWrench wrench_of(const Scene& scene, const std::string& text) {
  const auto [name, values] = split_assignment("--wrench", text);
  ProbeWrench wrench;
  wrench.at = frame_named(scene, "--wrench", name);
  const std::vector<double> numbers = numbers_of("--wrench", values);
  if (numbers.size() != 3 && numbers.size() != 6)
    throw UsageError(fmt::format(
        "--wrench: '{}' has {} entries, not three forces (N) or these and three torques (N m)",
        values, numbers.size()));
  wrench.force = {numbers[0], numbers[1], numbers[2]};
  if (numbers.size() == 6) wrench.torque = {numbers[3], numbers[4], numbers[5]};
  return wrench;
}

std::size_t drive_named(const StaticStudy& study, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < study.drives().size(); ++i) {
    const std::string& full = study.drives()[i].name;
    if (full == name || full.substr(0, full.rfind('.')) == name) return i;
    names.push_back(full);
  }
  throw UsageError(not_one_of(name, "a drive of the scene", names));
}

std::vector<Parameter> drives_or_all(const StaticStudy& study,
                                     const std::vector<std::string>& names) {
  if (names.empty()) return study.drives();
  std::vector<Parameter> drives;
  for (const std::string& name : names)
    drives.push_back(study.drives()[drive_named(study, name)]);
  return drives;
}

std::vector<Channel> channels_named(const Scene& scene, const std::string& option,
                                    const std::string& pattern) {
  std::vector<Channel> found = find_channels(scene, pattern);
  if (found.empty())
    throw UsageError(option + ": " +
                     not_one_of(pattern, "a channel", nearest_channels(scene, pattern)));
  return found;
}

ChannelGoal measured_channel(const Scene& scene, const std::string& text) {
  const auto [name, value] = split_assignment("--measured", text);
  const std::vector<Channel> found = channels_named(scene, "--measured", name);
  if (found.size() != 1)
    throw UsageError(fmt::format("--measured: '{}' is {} channels, not one", name, found.size()));
  return {found.front(), number_of("--measured", value), 1};
}

}  // namespace cprsim
