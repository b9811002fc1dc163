// SPDX-License-Identifier: BSD-3-Clause
// Names of the command line looked up in the scene.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/model/channel.h"
#include "tools/cprsim/static_words.h"
#include "tools/cprsim/workspace_options.h"

namespace cprsim {

namespace {

constexpr int kCount = 11;               // values on an axis without a count of its own
constexpr std::size_t kMost = 10000000;  // points
constexpr const char* kFreedoms[] = {"x", "y", "z", "roll", "pitch", "yaw"};

std::optional<int> freedom_of(const std::string& name) {
  for (int f = 0; f < 6; ++f)
    if (name == kFreedoms[f]) return f;
  return std::nullopt;
}

int freedom_or_complain(const std::string& option, const std::string& name) {
  if (const auto freedom = freedom_of(name)) return *freedom;
  throw UsageError(
      fmt::format("{}: with --pose, '{}' is none of x, y, z, roll, pitch, yaw", option, name));
}

/// Channels of lengths and joints whose stem or whole name fits the pattern.
std::vector<Channel> numbers_named(const Scene& scene, const std::string& pattern) {
  std::vector<Channel> found;
  for (const std::string& each :
       {pattern, pattern + ".length", pattern + ".position", pattern + ".effort",
        pattern + ".tension", pattern + ".displacement"})
    for (const Channel& channel : find_channels(scene, each)) {
      const bool fits =
          channel.quantity == Quantity::kLength || channel.quantity == Quantity::kJointPosition ||
          channel.quantity == Quantity::kJointEffort || channel.entity == ChannelEntity::kTendon;
      if (fits) found.push_back(channel);
    }
  return found;
}

bool drives(const DriveSpec& drive, const Channel& channel) {
  if (channel.quantity == Quantity::kLength) return drive.rod == channel.index;
  if (channel.entity == ChannelEntity::kTendon)
    return drive.tendon == channel.index &&
           (drive.quantity == DriveQuantity::kTension) == (channel.quantity == Quantity::kTension);
  const bool effort = drive.quantity == DriveQuantity::kEffort;
  return drive.rod < 0 && drive.tendon < 0 && drive.joint == channel.index &&
         effort == (channel.quantity == Quantity::kJointEffort);
}

/// Indices of the drives that a pattern names.
std::vector<int> drives_named(const Scene& scene, const std::string& pattern) {
  std::vector<int> found;
  for (const Channel& channel : numbers_named(scene, pattern))
    for (std::size_t i = 0; i < scene.drives.size(); ++i)
      if (drives(scene.drives[i], channel) &&
          std::find(found.begin(), found.end(), static_cast<int>(i)) == found.end())
        found.push_back(static_cast<int>(i));
  return found;
}

/// @return whether the pattern names rods at all
bool add_length_drives(Scene& scene, const std::string& pattern) {
  bool any = false;
  for (const Channel& channel : numbers_named(scene, pattern)) {
    if (channel.quantity != Quantity::kLength) continue;
    any = true;
    const bool driven = std::any_of(scene.drives.begin(), scene.drives.end(),
                                    [&](const DriveSpec& drive) { return drives(drive, channel); });
    if (driven) continue;
    DriveSpec drive;
    drive.quantity = DriveQuantity::kLength;
    drive.rod = channel.index;
    ProfileTerm term;
    term.value = scene.rods[static_cast<std::size_t>(channel.index)].length;
    drive.profile.terms.push_back(term);
    scene.drives.push_back(drive);
  }
  return any;
}

[[noreturn]] void no_such_drive(const Scene& scene, const StaticStudy& study,
                                const std::string& option, const std::string& name) {
  std::vector<std::string> names;
  for (const Parameter& drive : study.drives())
    names.push_back(drive.name);
  for (const RodSpec& rod : scene.rods)
    if (std::find(names.begin(), names.end(), rod.name + ".length") == names.end())
      names.push_back(rod.name + ".length");
  std::string list;
  for (const std::string& each : names)
    list += "\n  " + each;
  throw UsageError(option + ": " + not_one_of(name, "a drive or a rod", names) +
                   "\nThere are:" + list);
}

/// The link that the tips of most rods hold.
std::string held_by_most(const Scene& scene) {
  std::vector<int> tips(scene.bodies.size(), 0);
  for (const RodSpec& rod : scene.rods)
    if (rod.tip.joint != EndJoint::kFree && rod.tip.at.body >= 0)
      ++tips[static_cast<std::size_t>(rod.tip.at.body)];
  const auto most = std::max_element(tips.begin(), tips.end());
  if (most == tips.end() || *most == 0) {
    throw UsageError("no link is held by the tip of a rod: name a link or frame with --frame");
  }
  return scene.bodies[static_cast<std::size_t>(most - tips.begin())].name;
}

WorkspaceAxis drive_axis(const StaticStudy& study, int drive, const VaryOption& vary) {
  const Scene& scene = study.scene();
  const DriveSpec& spec = scene.drives[static_cast<std::size_t>(drive)];
  const Parameter& parameter = study.drives()[static_cast<std::size_t>(drive)];
  WorkspaceAxis axis;
  axis.name = parameter.name;
  axis.unit = parameter.unit;
  axis.drive = drive;
  axis.count = vary.count.value_or(kCount);
  constexpr double kNone = std::numeric_limits<double>::infinity();
  axis.low = -kNone;
  axis.high = kNone;
  if (spec.joint >= 0) {
    const JointSpec& joint = scene.joints[static_cast<std::size_t>(spec.joint)];
    const bool effort = spec.quantity == DriveQuantity::kEffort;
    axis.low = effort ? -joint.effort_limit : joint.lower;
    axis.high = effort ? joint.effort_limit : joint.upper;
  }
  axis.low = vary.low.value_or(axis.low);
  axis.high = vary.high.value_or(axis.high);
  if (!std::isfinite(axis.low) || !std::isfinite(axis.high)) {
    throw UsageError(fmt::format(
        "{} has no limits in the scene: give its range, --vary {}=LOW:HIGH", axis.name, axis.name));
  }
  if (spec.quantity == DriveQuantity::kLength && axis.low <= 0) {
    throw UsageError(axis.name + " must be greater than 0");
  }
  return axis;
}

void add_axis(WorkspaceQuestion& question, const WorkspaceAxis& axis) {
  for (const WorkspaceAxis& each : question.axes)
    if (each.name == axis.name) throw UsageError(axis.name + " is varied twice");
  question.axes.push_back(axis);
}

void vary_drives(const StaticStudy& study, const WorkspaceOptions& options,
                 WorkspaceQuestion& question) {
  for (const VaryOption& vary : options.vary) {
    const std::vector<int> named = drives_named(study.scene(), vary.name);
    if (named.empty()) no_such_drive(study.scene(), study, "--vary", vary.name);
    for (const int drive : named)
      add_axis(question, drive_axis(study, drive, vary));
  }
  if (!options.vary.empty()) return;
  for (std::size_t i = 0; i < study.drives().size(); ++i)
    add_axis(question, drive_axis(study, static_cast<int>(i), {}));
  if (question.axes.empty())
    throw UsageError(
        "the scene has no drives: name rods whose lengths are varied, e.g. --vary ROD=LOW:HIGH");
}

void vary_freedoms(const StaticStudy& study, const WorkspaceOptions& options,
                   WorkspaceQuestion& question) {
  question.poses = true;
  if (study.drives().empty())
    throw UsageError("--pose: the scene has no drives; name rods that are with --drive ROD");
  if (options.vary.empty())
    throw UsageError("--pose: say what is varied, e.g. --vary x=-0.1:0.1:21");
  for (const VaryOption& vary : options.vary) {
    WorkspaceAxis axis;
    axis.freedom = freedom_or_complain("--vary", vary.name);
    if (!vary.low)
      throw UsageError(fmt::format("--vary {0}: give a range, {0}=LOW:HIGH", vary.name));
    axis.name = vary.name;
    axis.unit = axis.freedom < 3 ? "m" : "rad";
    axis.low = *vary.low;
    axis.high = *vary.high;
    axis.count = vary.count.value_or(kCount);
    add_axis(question, axis);
  }
  const bool enough = study.drives().size() >= 6;
  for (HeldFreedom& other : question.others)
    other.held = options.hold.empty() && enough;
  for (const NumberOption& hold : options.hold) {
    if (hold.name == "none") continue;
    HeldFreedom& other =
        question.others[static_cast<std::size_t>(freedom_or_complain("--hold", hold.name))];
    other = {true, hold.value};
  }
  for (const WorkspaceAxis& axis : question.axes)
    question.others[static_cast<std::size_t>(axis.freedom)] = {};
}

std::vector<double> effort_limits(const StaticStudy& study, const WorkspaceOptions& options) {
  std::vector<double> limits(study.drives().size(), std::numeric_limits<double>::infinity());
  for (const NumberOption& option : options.max_effort) {
    if (option.name.empty()) {
      std::fill(limits.begin(), limits.end(), *option.value);
      continue;
    }
    const std::vector<int> named = drives_named(study.scene(), option.name);
    if (named.empty()) no_such_drive(study.scene(), study, "--max-effort", option.name);
    for (const int drive : named)
      limits[static_cast<std::size_t>(drive)] = *option.value;
  }
  return limits;
}

void refuse_too_many(const WorkspaceQuestion& question) {
  std::size_t count = 1;
  for (const WorkspaceAxis& axis : question.axes) {
    count *= static_cast<std::size_t>(axis.count);
    if (count <= kMost) continue;
    throw UsageError(fmt::format(
        "a grid of more than {} points: give counts, e.g. --vary {}={}:{}:3, or take --random N",
        kMost, axis.name, axis.low, axis.high));
  }
}

}  // namespace

WorkspaceTask make_task(const Scene& scene, const WorkspaceOptions& options) {
  WorkspaceTask task;
  task.scene = scene;
  for (const std::string& rod : options.drives)
    if (!add_length_drives(task.scene, rod))
      throw UsageError("--drive: '" + rod + "' names no rod");
  if (options.pose.empty()) {
    if (!options.hold.empty()) throw UsageError("--hold is for poses: name a frame with --pose");
    for (const VaryOption& vary : options.vary) {
      if (freedom_of(vary.name))
        throw UsageError("--vary " + vary.name + " is for poses: name a frame with --pose");
      if (drives_named(task.scene, vary.name).empty()) add_length_drives(task.scene, vary.name);
    }
  }
  const StaticStudy study(task.scene);
  task.drives = study.drives();
  if (options.pose.empty()) {
    vary_drives(study, options, task.question);
  } else {
    vary_freedoms(study, options, task.question);
  }
  if (!options.pose.empty() && !options.frame.empty())
    throw UsageError("--frame: --pose names the frame already");
  task.frame_name = !options.pose.empty()    ? options.pose
                    : !options.frame.empty() ? options.frame
                                             : held_by_most(scene);
  task.question.frame =
      frame_named(scene, options.pose.empty() ? "--frame" : "--pose", task.frame_name);
  task.question.max_effort = effort_limits(study, options);
  if (options.random > 0) {
    for (const VaryOption& vary : options.vary)
      if (vary.count) throw UsageError("--vary: a count is for grids, not for --random");
    task.points = random_points(task.question.axes, static_cast<std::size_t>(options.random),
                                scene.simulation.seed);
  } else {
    refuse_too_many(task.question);
    task.points = grid_points(task.question.axes);
  }
  return task;
}

}  // namespace cprsim
