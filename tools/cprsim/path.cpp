// SPDX-License-Identifier: BSD-3-Clause
// cprsim path: equilibria followed through folds and branch points.
#include "engine/study/path.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "engine/run/observe.h"
#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/interrupt.h"
#include "tools/cprsim/output_folder.h"
#include "tools/cprsim/path_words.h"
#include "tools/cprsim/static_words.h"
#include "tools/cprsim/stopwatch.h"
#include "tools/cprsim/study_command.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

/// Those asked for; else poses of all links that move, or the tips of rods.
std::vector<Channel> channels_of(const StaticStudy& study, const PathWords& w) {
  std::vector<std::string> patterns = w.channels;
  const Scene& scene = study.scene();
  if (patterns.empty())
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      if (study.robot().links[i].body >= 0) {
        patterns.push_back(scene.bodies[i].name + ".position.*");
        patterns.push_back(scene.bodies[i].name + ".orientation.*");
      }
  if (patterns.empty())
    for (const RodSpec& rod : scene.rods)
      patterns.push_back(rod.name + ".tip.position.*");
  if (!w.plot.empty()) patterns.push_back(w.plot);
  std::vector<Channel> all;
  for (const std::string& pattern : patterns)
    for (Channel& channel : channels_named(scene, "--channel", pattern))
      if (std::none_of(all.begin(), all.end(),
                       [&](const Channel& c) { return c.name == channel.name; }))
        all.push_back(std::move(channel));
  return all;
}

/// Of the channels, the one that changes most over all paths, compared within its unit: a position
/// wins against an orientation by its weight in metres over the robot's length.
Channel plotted(StaticStudy& study, const PathWords& w, const PathResult& result,
                const PathScale& scale, const std::vector<Channel>& channels) {
  if (!w.plot.empty()) return channels_named(study.scene(), "--plot", w.plot).front();
  std::vector<double> low(channels.size(), 1e300), high(channels.size(), -1e300);
  for (const NamedPath& named : result.paths)
    for (const PathPoint& point : named.path.points) {
      study.restore(point.state);
      const Snapshot now = study.snapshot();
      for (std::size_t i = 0; i < channels.size(); ++i) {
        const double value = evaluate(channels[i], study.scene(), now);
        low[i] = std::min(low[i], value);
        high[i] = std::max(high[i], value);
      }
    }
  std::size_t best = 0;
  double most = -1;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const double unit = channels[i].unit == "m" ? study.robot().scale.length : 1;
    const double change = (high[i] - low[i]) / unit;
    if (change <= most || channels[i].name == scale.name) continue;
    most = change;
    best = i;
  }
  return channels[best];
}

void follow_branches(StaticStudy& study, const PathSetup& setup, const PathOptions& options,
                     PathResult& result, const Console& console) {
  const Path main = result.paths.front().path;
  int number = 0;
  for (const PathEvent& event : main.events) {
    if (event.kind != PathEventKind::kBranchPoint) continue;
    ++number;
    for (const int side : {1, -1}) {
      if (stop_signal() != 0) return;
      const std::string name = fmt::format("branch {}{}", number, side > 0 ? '+' : '-');
      Path branch = follow_branch(study, setup.problem, event, side, options);
      if (branch.points.empty())
        console.warn(name + ": no point was found on it");
      else
        result.paths.push_back({name, std::move(branch)});
    }
  }
}

/// After every loss of stability of the path itself, from the first point beyond it.
void let_go(StaticStudy& study, const PathSetup& setup, PathResult& result,
            const Console& console) {
  const Path& path = result.paths.front().path;
  int number = 0;
  for (const PathEvent& event : path.events) {
    ++number;
    if (event.before != 0 || event.after == 0) continue;
    const auto beyond =
        std::find_if(path.points.begin(), path.points.end(),
                     [&](const PathPoint& p) { return p.s > event.point.s && p.unstable > 0; });
    if (beyond == path.points.end()) continue;
    for (const int side : {1, -1}) {
      NamedRelease named{fmt::format("{} {}", to_string(event.kind), number), side, beyond->lambda,
                         release(study, setup.problem, *beyond, event, side)};
      if (!named.release.solve.converged())
        console.warn(fmt::format("let go after {}, it came to no rest: {}", named.event,
                                 to_string(named.release.solve.status)));
      result.releases.push_back(std::move(named));
    }
  }
}

int exit_code_of(const PathResult& result, const Console& console) {
  if (stop_signal() != 0) return 128 + stop_signal();
  int code = kExitDone;
  for (const NamedPath& named : result.paths)
    if (!named.path.complete()) {
      console.error(named.path.points.empty()
                        ? named.name + ": no equilibrium to begin with"
                        : named.name + ": no further point was found with the smallest step");
      code = kExitSimulationFailed;
    }
  for (const NamedRelease& named : result.releases)
    if (!named.release.solve.converged()) code = kExitSimulationFailed;
  return code;
}

int run(const PathWords& w, const Scene& scene, const Console& console) {
  std::vector<ProbeWrench> probes;
  if (!w.load.empty()) {
    const LoadWords load = load_words(w.load);
    if (load_at_target(scene, load.target) < 0)
      probes.push_back({frame_named(scene, "--load", load.target), {0, 0, 0}, {0, 0, 0}});
  }
  const Stopwatch watch;
  StaticStudy study(scene, w.at.value_or(0), probes);
  const std::vector<Channel> channels = channels_of(study, w);
  const PathSetup setup =
      set_up(study, w, probes.empty() ? std::vector<Parameter>{} : study.probe(0));
  const std::string label = label_of(w.path, scene);
  const OutputFolder folder(choose_output_folder(w.output, label + "_path"),
                            {"path.json", "cprsim-path/"});

  PathOptions options;
  options.largest_step = w.largest_step.value_or(options.largest_step);
  options.low = -w.back.value_or(1);
  options.max_points = w.max_points;
  options.max_events = w.max_events;
  options.observe = [](const PathPoint&) { return stop_signal() == 0; };
  PathResult result;
  result.paths.push_back({"path", follow_path(study, setup.problem, options)});
  if (w.branch) follow_branches(study, setup, options, result, console);
  if (w.release && stop_signal() == 0) let_go(study, setup, result, console);
  result.seconds = watch.seconds();

  write_file(folder.path() / "path.csv", path_csv(study, result, setup.scale, channels));
  result.files.emplace_back("path.csv");
  if (!w.no_plot && !result.paths.front().path.points.empty()) {
    const Channel channel = plotted(study, w, result, setup.scale, channels);
    result.files.emplace_back("path.gp");
    if (draw_path(study, result, setup.scale, channel, label, folder.path().string(), console))
      result.files.emplace_back("path.svg");
  }
  result.files.emplace_back("path.json");
  const std::string json = path_json(study, result, setup.scale, w);
  write_file(folder.path() / "path.json", json);
  if (console.json()) write_to_stdout(json);
  console.say(path_text(study, result, setup.scale, label, folder.path().string()));
  return exit_code_of(result, console);
}

}  // namespace

int path_command(const Words& words) {
  const auto read = read_path_words(words);
  if (const int* code = std::get_if<int>(&read)) return *code;
  const PathWords& w = std::get<PathWords>(read);
  const Console console(w.console);
  return answer(w.path, w.scene, console,
                [&](const Scene& scene) { return run(w, scene, console); });
}

}  // namespace cprsim
