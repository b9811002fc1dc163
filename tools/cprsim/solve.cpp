// SPDX-License-Identifier: BSD-3-Clause
// cprsim solve: the robot at rest. Forward: drives given, pose found. Inverse: pose given, drives
// found. Force sensing: reactions measured, wrench found.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "engine/run/observe.h"
#include "engine/study/inverse.h"
#include "engine/study/stability.h"
#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/scene_options.h"
#include "tools/cprsim/static_words.h"
#include "tools/cprsim/study_command.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kPerDegree = 180 / std::numbers::pi;

struct SolveWords {
  std::string path;
  SceneOptions scene;
  ConsoleOptions console;
  std::vector<std::string> drives, poses, free, wrenches, measured, channels;
  std::string unknown_wrench;
  std::optional<double> at;
  bool as_it_is = false;
};

struct Solved {
  SolveReport report;
  bool inverse = false;
  InverseReport inverse_report;
  Stability stability;

  bool good() const { return report.converged() && (!inverse || inverse_report.reached); }
};

std::optional<int> read_words(SolveWords& w, const Words& words) {
  CommandLine line(
      "cprsim solve",
      "Finds the robot's equilibrium and says whether it is stable. With a pose, here or as a "
      "<cprsim:target> of\nthe scene, finds the drives that lead there; with measured channels and "
      "an unknown wrench, the wrench that explains "
      "them.\n\n"
      "Examples\n"
      "  cprsim solve scene.xml\n"
      "  cprsim solve scene.xml --drive robot::leg_1.length=0.41 --wrench robot::platform=0,0,-1\n"
      "  cprsim solve scene.xml --pose robot::platform=0,0,0.4,0,10deg,0\n"
      "  cprsim solve scene.xml --pose 'robot::platform=0.02,0,0.39,*,*,0' --free "
      "robot::leg_1,...\n"
      "  cprsim solve scene.xml --unknown-wrench robot::platform --measured CHANNEL=VALUE ...");
  line.scene(w.path);
  line.texts("--drive", w.drives, "NAME=VALUE",
             "Sets a drive: m, rad, N, N m; angles may end in deg");
  line.texts("--pose", w.poses, "NAME=X,Y,Z[,R,P,Y]",
             "Prescribes a link's or frame's pose; * leaves a freedom open");
  line.list("--free", w.free, "NAMES", "Drives that --pose may change (default all)");
  line.flag("--as-it-is", w.as_it_is, "Forward, even if the scene has a <cprsim:target>");
  line.exclude("--as-it-is", "--pose");
  line.texts("--wrench", w.wrenches, "NAME=FX,FY,FZ[,TX,TY,TZ]",
             "Force (and torque) at a link's or frame's origin, world axes");
  line.text("--unknown-wrench", w.unknown_wrench, "NAME",
            "Estimates the wrench on this link or frame");
  line.texts("--measured", w.measured, "CHANNEL=VALUE",
             "What a channel reads, for --unknown-wrench");
  line.texts("--channel", w.channels, "PATTERN", "Also prints these channels (with * globs)");
  line.number("--at", w.at, "Time at which drives and loads are read (default 0)", "of seconds",
              [](double t) { return t >= 0; });
  add_scene_options(line, w.scene);
  add_console_options(line, w.console);
  return line.parse(words);
}

/// Poses on the command line; without them those of the scene.
std::vector<PoseGoal> pose_goals(const SolveWords& w, const Scene& scene) {
  std::vector<PoseGoal> goals;
  for (const std::string& text : w.poses)
    goals.push_back(pose_goal(scene, text));
  if (goals.empty() && !w.as_it_is)
    for (const TargetSpec& target : scene.targets)
      goals.push_back(pose_goal(target));
  return goals;
}

/// Drives that may change so that poses are reached.
std::vector<Parameter> yielding_drives(const SolveWords& w, const StaticStudy& study) {
  if (!w.poses.empty() || !w.free.empty()) return drives_or_all(study, w.free);
  std::vector<Parameter> drives;
  for (const Parameter& drive : study.drives()) {
    const auto asks_for = [&](const TargetSpec& target) {
      return std::count(target.drives.begin(), target.drives.end(), drive.index) > 0;
    };
    const auto& targets = study.scene().targets;
    if (std::any_of(targets.begin(), targets.end(), asks_for)) drives.push_back(drive);
  }
  return drives;
}

Goal goal_of(const SolveWords& w, const std::vector<PoseGoal>& poses, const StaticStudy& study) {
  std::vector<Goal> goals;
  for (const PoseGoal& pose : poses)
    goals.push_back(reach(pose, study.robot().scale.length));
  std::vector<ChannelGoal> measured;
  for (const std::string& text : w.measured) {
    ChannelGoal goal = measured_channel(study.scene(), text);
    const RobotScale& scale = study.robot().scale;
    goal.unit = goal.channel.unit == "N"     ? scale.force
                : goal.channel.unit == "N m" ? scale.moment()
                : goal.channel.unit == "m"   ? scale.length
                                             : 1;
    measured.push_back(goal);
  }
  if (!measured.empty()) goals.push_back(match(measured));
  return both(goals);
}

Solved solve(StaticStudy& study, const SolveWords& w, const std::vector<Parameter>& wrench) {
  for (const std::string& text : w.drives) {
    const auto [name, value] = split_assignment("--drive", text);
    study.set(study.drives()[drive_named(study, name)], number_of("--drive", value));
  }
  const std::vector<PoseGoal> poses = pose_goals(w, study.scene());
  const Goal goal = goal_of(w, poses, study);
  std::vector<Parameter> parameters = wrench;
  if (!poses.empty())
    for (const Parameter& drive : yielding_drives(w, study))
      parameters.push_back(drive);
  Solved solved;
  solved.report = study.solve();
  if (!solved.report.converged() || study.touches()) return solved;
  solved.inverse = !poses.empty() || !w.measured.empty();
  if (solved.inverse) solved.inverse_report = solve_inverse(study, parameters, goal);
  solved.stability = judge(study);
  return solved;
}

/// What a drive exerts: a joint's effort, or the tension with which a rod leaves its feed.
double effort_of(const Scene& scene, const Snapshot& now, const Parameter& drive) {
  const DriveSpec& spec = scene.drives[static_cast<std::size_t>(drive.index)];
  if (spec.tendon >= 0) return now.tendons[static_cast<std::size_t>(spec.tendon)].tension;
  if (spec.quantity != DriveQuantity::kLength)
    return now.joints[static_cast<std::size_t>(spec.joint)].effort[spec.freedom];
  const RodPoint& base = now.rods[static_cast<std::size_t>(spec.rod)].points.front();
  return base.force.dot(base.rotation.col(2));
}

std::string effort_unit(const Parameter& drive) {
  return drive.unit == "rad" || drive.unit == "N m" ? "N m" : "N";
}

std::string numbers_text(const Vec3& v) {
  return fmt::format("{:14.10g} {:14.10g} {:14.10g}", v.x(), v.y(), v.z());
}

std::string stability_text(const StaticStudy& study, const Stability& s) {
  std::string text = fmt::format("  {}", to_string(s.verdict));
  if (s.unstable > 0) {
    text += fmt::format(", {} direction{} in which energy falls", s.unstable,
                        s.unstable == 1 ? "" : "s");
    for (std::size_t i = 0; i < s.in_rods.size(); ++i)
      if (s.in_rods[i] > 0)
        text += fmt::format(" ({} inside {})", s.in_rods[i], study.scene().rods[i].name);
  }
  if (!s.potential) text += ", as far as loads without a potential allow to say";
  text += fmt::format(
      "\n  softest     {:.6g} N/m (force per root mean square displacement of the rods)\n",
      s.softest);
  for (std::size_t b = 0; b < s.softest_bodies.size(); ++b) {
    const Vec6& m = s.softest_bodies[b];
    const int link = study.robot().bodies[b].links.front();
    text += fmt::format(
        "              {} moves by ({:.3g} {:.3g} {:.3g}), turns by ({:.3g} {:.3g} "
        "{:.3g}) rad/m\n",
        study.scene().bodies[static_cast<std::size_t>(link)].name, m[3], m[4], m[5], m[0], m[1],
        m[2]);
  }
  return text;
}

/// What may leave a surface or slide along it is stable or not by more than its stiffness says.
std::string contact_text(const ContactSample& touching) {
  return fmt::format(
      "  touching    at {} points, pressed by {:.6g} N, friction {:.6g} N\n"
      "  stability   not judged where rods touch something\n",
      touching.count, touching.force, touching.friction);
}

std::string text_of(const std::string& label, const StaticStudy& study, const Solved& solved,
                    const std::vector<Parameter>& wrench, const std::vector<Channel>& channels) {
  const Scene& scene = study.scene();
  const Snapshot now = study.snapshot();
  std::string text =
      fmt::format("{}: equilibrium by {}, {} iterations, residual {:.1e}\n", label,
                  to_string(solved.report.stage), solved.report.iterations, solved.report.residual);
  if (solved.inverse)
    text += fmt::format(
        "  goal        {} after {} iterations, largest row {:.1e}, weakest direction "
        "{:.1e}\n",
        solved.inverse_report.reached ? "reached" : "NOT reached", solved.inverse_report.iterations,
        solved.inverse_report.residual, solved.inverse_report.weakest);
  text += study.touches() ? contact_text(now.contact) : stability_text(study, solved.stability);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (study.robot().links[i].body < 0) continue;
    const Pose& X = now.bodies[i].X_WB;
    text += fmt::format("  {:<24} {} m\n  {:<24} {} deg (roll pitch yaw)\n", scene.bodies[i].name,
                        numbers_text(X.p), "", numbers_text(kPerDegree * angles_of(X.R)));
  }
  for (const Parameter& drive : study.drives())
    text +=
        fmt::format("  {:<24} {:14.10f} {:<4} effort {:12.6g} {}\n", drive.name, study.value(drive),
                    drive.unit, effort_of(scene, now, drive), effort_unit(drive));
  for (const Parameter& part : wrench)
    text += fmt::format("  {:<24} {:14.10g} {}\n", part.name, study.value(part), part.unit);
  for (const Channel& channel : channels)
    text += fmt::format("  {:<40} {:14.10g} {}\n", channel.name, evaluate(channel, scene, now),
                        channel.unit);
  return text;
}

Json vector_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json json_of(const StaticStudy& study, const Solved& solved, const std::vector<Parameter>& wrench,
             const std::vector<Channel>& channels) {
  const Scene& scene = study.scene();
  Json json = {{"schema", "cprsim-solve/1"},
               {"scene", {{"name", scene.name}, {"hash", scene.hash}}},
               {"converged", solved.report.converged()},
               {"stage", to_string(solved.report.stage)},
               {"iterations", solved.report.iterations},
               {"residual", solved.report.residual},
               {"worst_row", solved.report.worst_row}};
  if (!solved.report.converged()) return json;
  const Snapshot now = study.snapshot();
  if (solved.inverse)
    json["goal"] = {{"reached", solved.inverse_report.reached},
                    {"iterations", solved.inverse_report.iterations},
                    {"residual", solved.inverse_report.residual},
                    {"weakest", solved.inverse_report.weakest},
                    {"why", solved.inverse_report.why}};
  const Stability& s = solved.stability;
  if (study.touches())
    json["contact"] = {{"count", now.contact.count},
                       {"force", now.contact.force},
                       {"friction", now.contact.friction},
                       {"penetration", now.contact.penetration}};
  else
    json["stability"] = {{"verdict", to_string(s.verdict)},
                         {"unstable_directions", s.unstable},
                         {"softest_N_per_m", s.softest},
                         {"potential_loads", s.potential}};
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (study.robot().links[i].body < 0) continue;
    const Pose& X = now.bodies[i].X_WB;
    json["links"][scene.bodies[i].name] = {{"position", vector_of(X.p)},
                                           {"roll_pitch_yaw", vector_of(angles_of(X.R))}};
  }
  for (const Parameter& drive : study.drives())
    json["drives"][drive.name] = {{"value", study.value(drive)},
                                  {"unit", drive.unit},
                                  {"effort", effort_of(scene, now, drive)},
                                  {"effort_unit", effort_unit(drive)}};
  for (const Parameter& part : wrench)
    json["wrench"][part.name] = study.value(part);
  for (const Channel& channel : channels)
    json["channels"][channel.name] = evaluate(channel, scene, now);
  return json;
}

std::vector<Channel> channels_of(const Scene& scene, const std::vector<std::string>& patterns) {
  std::vector<Channel> all;
  for (const std::string& pattern : patterns)
    for (const Channel& channel : channels_named(scene, "--channel", pattern))
      all.push_back(channel);
  return all;
}

int run(const SolveWords& w, const Scene& scene, const Console& console) {
  std::vector<ProbeWrench> probes;
  if (w.unknown_wrench.empty() != w.measured.empty())
    throw UsageError("--unknown-wrench and --measured go together");
  if (!w.unknown_wrench.empty())
    probes.push_back(
        {frame_named(scene, "--unknown-wrench", w.unknown_wrench), {0, 0, 0}, {0, 0, 0}});
  for (const std::string& text : w.wrenches)
    probes.push_back(wrench_of(scene, text));
  const std::vector<Channel> channels = channels_of(scene, w.channels);
  const std::vector<PoseGoal> poses = pose_goals(w, scene);
  StaticStudy study(scene, w.at.value_or(0), probes, poses.empty() && w.measured.empty());
  if (!w.poses.empty() && study.drives().empty())
    throw UsageError("--pose needs drives that may change, and the scene has none");
  const std::vector<Parameter> wrench =
      w.unknown_wrench.empty() ? std::vector<Parameter>{} : study.probe(0);
  const Solved solved = solve(study, w, wrench);
  if (console.json()) write_to_stdout(json_of(study, solved, wrench, channels).dump(2) + "\n");
  if (!solved.report.converged()) {
    console.error(fmt::format("no equilibrium found: {} after {} iterations, residual {:.1e} in {}",
                              to_string(solved.report.status), solved.report.iterations,
                              solved.report.residual, solved.report.worst_row));
    return kExitSimulationFailed;
  }
  console.say(text_of(label_of(w.path, scene), study, solved, wrench, channels));
  if (solved.good()) return kExitDone;
  console.error(fmt::format("the goal is not reached: {}; the largest row that remains is {:.3g}",
                            solved.inverse_report.why, solved.inverse_report.residual));
  return kExitSimulationFailed;
}

}  // namespace

int solve_command(const Words& words) {
  SolveWords w;
  if (const auto code = read_words(w, words)) return *code;
  const Console console(w.console);
  return answer(w.path, w.scene, console,
                [&](const Scene& scene) { return run(w, scene, console); });
}

}  // namespace cprsim
