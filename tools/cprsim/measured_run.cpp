// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/measured_run.h"

#include <algorithm>
#include <optional>

#include "tools/cprsim/asked_run.h"
#include "tools/cprsim/trajectory_match.h"

namespace cprsim {

namespace {

constexpr int kInstants = 1000;
constexpr double kLong = 0.5;  // s: longer runs are timed once

std::vector<double> evenly(double end) {
  std::vector<double> instants;
  const int count = end > 0 ? kInstants : 0;
  for (int k = 0; k <= count; ++k)
    instants.push_back(count > 0 ? end * k / count : 0);
  return instants;
}

std::vector<Channel> channels_named(const Scene& scene, const std::vector<std::string>& names) {
  std::vector<Channel> channels;
  for (const std::string& name : names)
    for (const Channel& channel : find_channels(scene, name))
      channels.push_back(channel);
  return channels;
}

/// Runs once; the series is that of this run. What finding out its error takes counts as its cost.
QuietRun run_once(const Scene& scene, bool as_asked, const Looking& looking, MeasuredRun& result,
                  const std::function<bool()>& stop) {
  const double end = scene.simulation.mode == Mode::kStatic ? 0 : scene.simulation.duration;
  std::optional<SeriesRecorder> recorder;
  const auto look = [&] {
    recorder.emplace(scene, channels_named(scene, looking.channels),
                     looking.instants.value_or(evenly(end)));
    return onlooker(*recorder);
  };
  QuietRun run;
  if (as_asked) {
    const AskedRun all = run_as_asked(scene, look, stop);
    run = all.last;
    run.cpu_seconds = all.cpu_seconds;
    run.statistics.section_evaluations = all.section_evaluations;
  } else {
    run = run_quietly(scene, look(), stop);
  }
  result.series = recorder->series();
  return run;
}

}  // namespace

std::string reason_of(const std::vector<Diagnostic>& diagnostics) {
  for (const Diagnostic& d : diagnostics)
    if (d.severity == Severity::kError) return d.code + ": " + d.message;
  return "the scene is invalid";
}

std::string settings_text(const Settings& settings) {
  std::string text;
  for (const auto& [name, value] : settings)
    text += (text.empty() ? "" : ", ") + name + "=" + value;
  return text;
}

MeasuredRun measured_run(const std::string& path, const SceneOptions& options,
                         const Settings& settings, const Looking& looking,
                         const std::function<bool()>& stop) {
  MeasuredRun result;
  LoadOptions load = load_options(options);
  load.set.insert(load.set.end(), settings.begin(), settings.end());
  const LoadResult loaded = load_scene(path, load);
  if (loaded.scene == nullptr) {
    result.refusal = reason_of(loaded.diagnostics);
    return result;
  }
  try {
    watch_pairs(*loaded.scene, channels_named(*loaded.scene, looking.channels));
    const bool as_asked = std::any_of(settings.begin(), settings.end(),
                                      [](const auto& s) { return s.first == "accuracy"; });
    for (int i = 0; i < looking.repetitions; ++i) {
      const QuietRun run = run_once(*loaded.scene, as_asked, looking, result, stop);
      result.cpu_seconds = i == 0 ? run.cpu_seconds : std::min(result.cpu_seconds, run.cpu_seconds);
      result.statistics = run.statistics;
      result.end_time = run.end_time;
      if (run.status == RunStatus::kFailed) result.failure = run.failure;
      if (run.status == RunStatus::kRunning) result.failure = "stopped";
      if (!result.done() || run.cpu_seconds > kLong) break;
    }
  } catch (const std::invalid_argument& error) {
    result.refusal = error.what();
  }
  return result;
}

}  // namespace cprsim
