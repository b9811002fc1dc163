// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/path_words.h"

#include <fmt/core.h>

#include "tools/cprsim/static_words.h"
#include "tools/cprsim/study_command.h"

namespace cprsim {

namespace {

constexpr const char* kAbout =
    R"(Follows equilibria while a drive, a load or a prescribed pose changes, through folds and branch
points, and says where stability is lost.

Examples
  cprsim path robot.xml --drive robot::leg_1.length --to 0.45
  cprsim path robot.xml --drive robot::left=40deg --drive robot::right=140deg
  cprsim path scenes/paths/euler_column.xml --load column::slider.force.z --to -12 --branch
  cprsim path scenes/paths/lees_frame.xml --load frame::beam.force.z --to -20000
  cprsim path scenes/paths/csg_translated.xml --pose robot::platform --from 0,0,0.5,0,0,0 \
      --to 0.2,0,0.5,0,0,0 --release --events 1

A path ends at --to, where it has gone back by --back, or after --points or --events.
Writes path.csv, path.json and path.svg (stable solid, unstable dashed).

Exit codes: 0 followed to an end; 2 usage; 3 scene; 4 no equilibrium at the start, or no further
point was found; 5 files
)";

void check_kind(const PathWords& w) {
  const int kinds =
      (w.drives.empty() ? 0 : 1) + (w.load.empty() ? 0 : 1) + (w.pose.empty() ? 0 : 1);
  if (kinds != 1) throw UsageError("a path needs one of --drive, --load and --pose");
  const bool line =
      w.drives.size() > 1 || (w.drives.size() == 1 && w.drives[0].find('=') != std::string::npos);
  if (line && !(w.to.empty() && w.from.empty()))
    throw UsageError("--drive NAME=VALUE needs no --from and --to");
  if (!line && w.to.empty()) throw UsageError("--to is missing");
}

PathSetup one_parameter(StaticStudy& study, const PathWords& w, const Parameter& parameter,
                        const std::string& name, const std::string& option) {
  PathSetup setup;
  setup.scale = {name, parameter.unit, study.value(parameter), number_of("--to", w.to)};
  if (!w.from.empty()) setup.scale.from = number_of("--from", w.from);
  if (setup.scale.from == setup.scale.to)
    throw UsageError(fmt::format("{}: {} is at {} already", option, name, setup.scale.to));
  require_equilibrium(study.follow());
  study.set(parameter, setup.scale.from);
  require_equilibrium(study.follow());
  setup.problem = along_line(study, {parameter}, VecX::Constant(1, setup.scale.from),
                             VecX::Constant(1, setup.scale.to));
  return setup;
}

PathSetup drive_line(StaticStudy& study, const PathWords& w) {
  std::vector<Parameter> parameters;
  VecX from(static_cast<Eigen::Index>(w.drives.size())), to = from;
  for (const std::string& text : w.drives) {
    const auto [name, value] = split_assignment("--drive", text);
    const auto i = static_cast<Eigen::Index>(parameters.size());
    parameters.push_back(study.drives()[drive_named(study, name)]);
    from[i] = study.value(parameters.back());
    to[i] = number_of("--drive", value);
  }
  if ((to - from).norm() == 0) throw UsageError("--drive: the drives are there already");
  require_equilibrium(study.follow());
  PathSetup setup;
  setup.problem = along_line(study, parameters, from, to);
  if (parameters.size() == 1)
    setup.scale = {parameters[0].name, parameters[0].unit, from[0], to[0]};
  return setup;
}

PathSetup pose_line(StaticStudy& study, const PathWords& w) {
  const PoseGoal to = pose_goal(study.scene(), w.pose + "=" + w.to);
  const std::vector<Parameter> drives = drives_or_all(study, w.free);
  require_equilibrium(study.follow());
  PoseGoal from = to;
  if (!w.from.empty()) {
    from = pose_goal(study.scene(), w.pose + "=" + w.from);
    if (from.asked != to.asked)
      throw UsageError("--from and --to must leave the same freedoms open");
    const InverseReport report =
        solve_inverse(study, drives, reach(from, study.robot().scale.length));
    if (!report.reached)
      throw NoEquilibrium(
          fmt::format("--from is not reached: {}; the largest row that remains is {:.3g}",
                      report.why, report.residual));
  } else {
    const Pose now = pose_of(study, to.at);
    from.position = now.p;
    from.angles = angles_of(now.R);
  }
  PathSetup setup;
  try {
    setup.problem = along_pose(study, drives, from, to);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--pose: ") + error.what() + "; choose drives with --free");
  }
  // a translation along one axis is told by its coordinate
  static constexpr const char* kNames[] = {"x", "y", "z"};
  const Vec3 way = to.position - from.position;
  for (int i = 0; i < 3; ++i)
    if (to.asked[static_cast<std::size_t>(i)] && std::abs(way[i]) == way.norm() && way.norm() > 0 &&
        to.angles == from.angles)
      setup.scale = {w.pose + ".position." + kNames[i], "m", from.position[i], to.position[i]};
  return setup;
}

}  // namespace

std::variant<PathWords, int> read_path_words(const Words& words) {
  PathWords w;
  CommandLine line("cprsim path", kAbout);
  line.scene(w.path);
  line.texts("--drive", w.drives, "NAME[=VALUE]",
             "The drive that changes; with =VALUE several change together");
  line.text("--load", w.load, "NAME.COMPONENT",
            "The component of a load that changes: NAME.force.z, NAME.torque.x");
  line.text("--pose", w.pose, "NAME",
            "The link or frame whose pose is prescribed; all drives yield");
  line.text("--from", w.from, "VALUE|X,Y,Z,R,P,Y",
            "Where the path starts (default: as the scene is)");
  line.text("--to", w.to, "VALUE|X,Y,Z,R,P,Y",
            "Where it leads; angles may end in deg, * leaves a freedom open");
  line.list("--free", w.free, "NAMES", "Drives that yield to --pose (default all)");
  line.flag("--branch", w.branch, "Also follows what crosses the path at its branch points");
  line.flag("--release", w.release,
            "Where stability is lost, lets the robot go: where does it jump to?");
  line.texts("--channel", w.channels, "PATTERN",
             "Columns of path.csv (with * globs; default: poses of links)");
  line.text("--plot", w.plot, "CHANNEL",
            "The channel that path.svg shows (default: the one that changes most)");
  line.number("--largest-step", w.largest_step,
              "Largest step of arclength (default 0.1, dimensionless)", "greater than 0",
              [](double v) { return v > 0; });
  line.number("--back", w.back,
              "A path that goes back ends this many ways before its start (default 1)",
              "of at least 0", [](double v) { return v >= 0; });
  line.count("--points", w.max_points, 2, "At most so many points (default 500)");
  line.count("--events", w.max_events, 1, "Ends after so many events (default 50)");
  line.number("--at", w.at, "Time at which drives and loads are read (default 0)", "of seconds",
              [](double t) { return t >= 0; });
  line.text("-o,--output", w.output, "DIR", "Where results go (default out/<scene>_path)");
  line.flag("--no-plot", w.no_plot, "Write no path.svg");
  add_scene_options(line, w.scene);
  add_console_options(line, w.console);
  if (const auto code = line.parse(words)) return *code;
  return w;
}

LoadWords load_words(const std::string& text) {
  static constexpr const char* kKinds[] = {".force.", ".torque."};
  for (int k = 0; k < 2; ++k) {
    const std::size_t at = text.rfind(kKinds[k]);
    if (at == std::string::npos || at == 0) continue;
    const std::string axis = text.substr(at + std::string(kKinds[k]).size());
    if (axis != "x" && axis != "y" && axis != "z") break;
    return {text.substr(0, at), k == 0 ? Parameter::Kind::kForce : Parameter::Kind::kTorque,
            axis[0] - 'x'};
  }
  throw UsageError(
      fmt::format("--load: '{}' is not of the form NAME.force.x or NAME.torque.z", text));
}

int load_at_target(const Scene& scene, const std::string& target) {
  int found = -1;
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    const LoadSpec& load = scene.loads[i];
    const std::string& name = load.rod >= 0 ? scene.rods[static_cast<std::size_t>(load.rod)].name
                              : load.at.body >= 0
                                  ? scene.bodies[static_cast<std::size_t>(load.at.body)].name
                                  : target;
    if (name != target) continue;
    if (found >= 0) throw UsageError("--load: several loads act on " + target);
    found = static_cast<int>(i);
  }
  if (found >= 0) return found;
  for (const RodSpec& rod : scene.rods)
    if (rod.name == target)
      throw UsageError("--load: no load acts on the rod " + target +
                       "; give it one in the scene, <cprsim:load at=\"...\">");
  return -1;
}

PathSetup set_up(StaticStudy& study, const PathWords& w, const std::vector<Parameter>& probe) {
  check_kind(w);
  if (!w.pose.empty()) return pose_line(study, w);
  if (!w.load.empty()) {
    const LoadWords load = load_words(w.load);
    const int index = load_at_target(study.scene(), load.target);
    const bool force = load.kind == Parameter::Kind::kForce;
    const Parameter parameter =
        probe.empty() ? Parameter{load.kind, index, load.component, "", force ? "N" : "N m"}
                      : probe[static_cast<std::size_t>(load.component + (force ? 0 : 3))];
    return one_parameter(study, w, parameter, w.load, "--load");
  }
  if (w.drives[0].find('=') != std::string::npos || w.drives.size() > 1)
    return drive_line(study, w);
  const Parameter& drive = study.drives()[drive_named(study, w.drives[0])];
  return one_parameter(study, w, drive, drive.name, "--drive");
}

}  // namespace cprsim
