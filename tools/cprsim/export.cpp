// SPDX-License-Identifier: BSD-3-Clause
// cprsim export: a scene, simulated for the purpose, in the form that another program reads; or the
// channels of a recording as a table.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/interrupt.h"
#include "tools/cprsim/plot_panels.h"
#include "tools/cprsim/quiet_run.h"
#include "tools/cprsim/study_command.h"
#include "tools/series/read_series.h"
#include "tools/sinks/gltf_sink.h"
#include "tools/sinks/output_file.h"
#include "tools/sinks/recording.h"

namespace cprsim {

namespace {

namespace fs = std::filesystem;

constexpr double kUsualRate = 100, kUsualFps = 30;
constexpr double kMostSamples = 1e8, kMostFrames = 1e5;  ///< as in scenes

struct ExportOptions {
  ConsoleOptions console;
  SceneOptions scene;
  std::string source;
  std::vector<std::string> files, channels;
  std::optional<double> rate, fps;
};

bool can_be_simulated(const std::string& path) {
  const std::string extension = fs::path(path).extension();
  return path == "-" || extension == ".xml" || extension == ".sdf" || extension == ".world";
}

bool is_kind(const std::string& file, const char* extension) {
  return fs::path(file).extension() == extension;
}

void check_files(const ExportOptions& options) {
  for (const std::string& file : options.files) {
    const auto kinds = {".glb", ".h5", ".npz", ".csv", ".pvd"};
    const auto fits = [&](const char* kind) { return is_kind(file, kind); };
    if (std::none_of(kinds.begin(), kinds.end(), fits))
      throw UsageError(fmt::format("'{}' ends in none of {}", file, fmt::join(kinds, ", ")));
    if (!can_be_simulated(options.source) && !is_kind(file, ".csv"))
      throw UsageError(
          fmt::format("'{}' is no scene: of a recording only CSV can be made", options.source));
    if (std::count(options.files.begin(), options.files.end(), file) > 1)
      throw UsageError(fmt::format("'{}' is named twice", file));
  }
}

/// Those named, else those that the scene records.
std::vector<Channel> channels_to_export(const Scene& scene, const ExportOptions& options) {
  std::vector<Channel> channels;
  const auto add = [&](const std::vector<Channel>& some) {
    for (const Channel& channel : some)
      if (std::none_of(channels.begin(), channels.end(),
                       [&](const Channel& c) { return c.name == channel.name; }))
        channels.push_back(channel);
  };
  if (options.channels.empty())
    for (const RecordSpec& record : scene.records)
      add(record.channels);
  for (const std::string& name : options.channels) {
    const auto found = find_channels(scene, name);
    if (found.empty())
      throw UsageError(fmt::format("there is no channel '{}'; near it: {}", name,
                                   fmt::join(nearest_channels(scene, name), ", ")));
    add(found);
  }
  return channels;
}

/// What a file would be of in a scene.
RecordSpec record_for(const Scene& scene, const ExportOptions& options, const std::string& file) {
  RecordSpec spec;
  spec.rate = options.rate.value_or(scene.records.empty() ? kUsualRate : scene.records[0].rate);
  spec.prefix = fs::path(file).stem();
  spec.channels = channels_to_export(scene, options);
  spec.csv = is_kind(file, ".csv");
  spec.hdf5 = is_kind(file, ".h5");
  spec.npz = is_kind(file, ".npz");
  spec.vtk_every = is_kind(file, ".pvd") ? 1 : 0;
  spec.gltf_fps = is_kind(file, ".glb") ? options.fps.value_or(kUsualFps) : 0;
  if (spec.csv && spec.channels.empty())
    throw UsageError("the scene records nothing: name channels with -c");
  const double duration = scene.simulation.duration;
  if (spec.rate * duration > kMostSamples || spec.gltf_fps * duration > kMostFrames)
    throw UsageError(fmt::format("{} would have more than {:g} {}", file,
                                 spec.gltf_fps > 0 ? kMostFrames : kMostSamples,
                                 spec.gltf_fps > 0 ? "keyframes" : "samples"));
  return spec;
}

class Exporter {
 public:
  Exporter(const Scene& scene, const ExportOptions& options) {
    for (const std::string& file : options.files)
      specs_.push_back(record_for(scene, options, file));
    for (std::size_t i = 0; i < specs_.size(); ++i) {
      const fs::path file = options.files[i];
      if (specs_[i].gltf_fps > 0)
        sinks_.push_back(std::make_unique<GltfSink>(scene, specs_[i].gltf_fps, file, file));
      else
        sinks_.push_back(std::make_unique<Recording>(scene, specs_[i], file.parent_path()));
    }
  }

  void begin(const Snapshot& start) {
    for (const auto& sink : sinks_)
      sink->begin(start);
  }

  void step(const Snapshot& before, const Snapshot& now) {
    for (const auto& sink : sinks_)
      sink->step(before, now);
  }

  void finish() {
    for (const auto& sink : sinks_)
      sink->finish();
  }

 private:
  std::vector<RecordSpec> specs_;  ///< sinks refer to these
  std::vector<std::unique_ptr<Sink>> sinks_;
};

int say_what_was_written(const ExportOptions& options, const Console& console) {
  if (console.json()) {
    const nlohmann::ordered_json json = {
        {"schema", "cprsim-export/1"}, {"source", options.source}, {"files", options.files}};
    write_to_stdout(json.dump(2) + "\n");
  }
  console.say(fmt::format("{}: wrote {}\n", options.source, fmt::join(options.files, ", ")));
  return kExitDone;
}

int export_scene(const Scene& given, const ExportOptions& options, const Console& console) {
  Scene scene = given;
  watch_pairs(scene, channels_to_export(scene, options));
  Exporter exporter(scene, options);
  const QuietRun run = run_quietly(scene, onlooker(exporter), [] { return stop_signal() != 0; });
  exporter.finish();  // what was computed is kept
  if (stop_signal() != 0) return 128 + stop_signal();
  if (run.status == RunStatus::kFailed)
    throw NoEquilibrium(fmt::format("the run failed at t = {:.6g} s: {}", run.time, run.failure));
  return say_what_was_written(options, console);
}

/// The columns asked for, of a file or of a run's only recording.
Series series_for(const ExportOptions& options) {
  Series series;
  if (fs::is_directory(options.source)) {
    RecordedRun run = read_run(options.source);
    if (run.recordings.size() > 1)
      throw UsageError(options.source +
                       " holds several recordings; name one of them: " + run.recordings[0].path);
    series = std::move(run.recordings[0]);
  } else {
    series = read_series(options.source);
  }
  if (options.channels.empty()) return series;
  std::vector<SeriesColumn> chosen;
  for (const std::string& name : options.channels) {
    const std::size_t before = chosen.size();
    for (const SeriesColumn& column : series.columns)
      if (column.name == name || column.name.starts_with(name + ".")) chosen.push_back(column);
    if (chosen.size() == before)
      throw UsageError(fmt::format("{} holds no channel '{}'", options.source, name));
  }
  series.columns = std::move(chosen);
  return series;
}

int export_recording(const ExportOptions& options, const Console& console) {
  const std::string table = table_of(series_for(options));
  for (const std::string& file : options.files)
    write_file(file, table);
  return say_what_was_written(options, console);
}

}  // namespace

int export_command(const Words& words) {
  ExportOptions options;
  CommandLine line("cprsim export",
                   "Writes a scene, simulated for the purpose, in the form that another program "
                   "reads:\n"
                   ".glb an animated model, .h5 and .npz channels and whole rods as arrays, .csv "
                   "channels,\n"
                   ".pvd rods for ParaView. Of a recording (a run's folder, HDF5, TUM): .csv.\n\n"
                   "Examples\n"
                   "  cprsim export scene.xml robot.glb\n"
                   "  cprsim export scene.xml rods.h5 tip.csv -c robot::leg_1.tip.position --rate "
                   "500\n"
                   "  cprsim export out/robot/robot.h5 robot.csv");
  line.argument("SOURCE", options.source, "A scene, or a recording");
  line.arguments("FILE", options.files, "What to write; its ending says in which form", true);
  line.list("-c,--channel", options.channels, "CHANNEL", "Which (default: what the scene records)");
  const auto positive = [](double value) { return value > 0; };
  line.number("--rate", options.rate, "Samples per simulated second (default: the scene's, or 100)",
              "greater than 0", positive);
  line.number("--fps", options.fps, "Keyframes per simulated second of .glb (default 30)",
              "greater than 0", positive);
  add_scene_options(line, options.scene);
  add_console_options(line, options.console);
  if (const auto code = line.parse(words)) return *code;
  const Console console(options.console);
  return complain_of(console, [&] {
    check_files(options);
    if (!can_be_simulated(options.source)) return export_recording(options, console);
    return answer(options.source, options.scene, console,
                  [&](const Scene& scene) { return export_scene(scene, options, console); });
  });
}

}  // namespace cprsim
