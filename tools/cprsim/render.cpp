// SPDX-License-Identifier: BSD-3-Clause
// cprsim render: films and pictures from what a run has recorded, without running again.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/section/along.h"
#include "render/film.h"
#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/interrupt.h"
#include "tools/cprsim/outputs.h"
#include "tools/cprsim/run_options.h"
#include "tools/cprsim/study_command.h"
#include "tools/series/hdf5_series.h"
#include "tools/series/read_series.h"
#include "tools/series/recorded_states.h"
#include "tools/sinks/film_sink.h"
#include "tools/sinks/frame_sink.h"
#include "tools/sinks/output_file.h"
#include "tools/sinks/still_sink.h"

namespace cprsim {

namespace {

namespace fs = std::filesystem;

struct RenderCommandOptions {
  ConsoleOptions console;
  std::string source, scene, camera, color_by;
  std::vector<std::string> files;
  std::optional<double> fps, speed;
};

struct Source {
  std::string scene, recording;
};

RunFiles files_in(const fs::path& folder) {
  try {
    return read_run_files(folder);
  } catch (const std::runtime_error& error) {
    throw UsageError(error.what());
  }
}

std::string recording_in(const RunFiles& run) {
  const std::vector<std::string> names = run.of_kind("hdf5");
  if (names.empty())
    throw UsageError(
        run.folder +
        " holds no HDF5 recording to draw from: <cprsim:record> with <hdf5/> makes one");
  if (names.size() > 1)
    throw UsageError(run.folder + " holds several HDF5 recordings; name one of them");
  return fs::path(run.folder) / names[0];
}

/// The recording and its scene, from the folder where the command line does not say.
Source find_recording(const RenderCommandOptions& options) {
  Source found;
  if (fs::is_directory(options.source)) {
    const RunFiles run = files_in(options.source);
    found = {run.scene, recording_in(run)};
  } else {
    if (!is_hdf5(options.source))
      throw UsageError(options.source + " is neither a run's folder nor an HDF5 file");
    found.recording = options.source;
    const fs::path folder = fs::path(options.source).parent_path();
    if (options.scene.empty() && fs::exists(folder / "run.json"))
      found.scene = files_in(folder.empty() ? "." : folder).scene;
  }
  if (!options.scene.empty()) found.scene = options.scene;
  if (found.scene.empty()) throw UsageError("which scene is it of? Name it with --scene");
  return found;
}

ColorBy color_named(const std::string& name) {
  const std::pair<const char*, ColorBy> known[] = {{"none", ColorBy::kNone},
                                                   {"curvature", ColorBy::kCurvature},
                                                   {"bending_moment", ColorBy::kBendingMoment},
                                                   {"tension", ColorBy::kTension},
                                                   {"strain_energy", ColorBy::kStrainEnergy}};
  std::vector<std::string> names;
  for (const auto& [word, value] : known) {
    if (name == word) return value;
    names.emplace_back(word);
  }
  throw UsageError(fmt::format("--color-by is one of {}", fmt::join(names, ", ")));
}

/// The scene's first film, with what the command line says in its place.
VideoSpec video_of(const Scene& scene, const RenderCommandOptions& options) {
  VideoSpec video = video_or_default(scene);
  if (!options.camera.empty()) {
    const auto camera = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                     [&](const CameraSpec& c) { return c.name == options.camera; });
    if (camera == scene.cameras.end()) {
      std::vector<std::string> names;
      for (const CameraSpec& c : scene.cameras)
        names.push_back(c.name);
      throw UsageError(fmt::format("the scene has no camera '{}'; it has: {}", options.camera,
                                   fmt::join(names, ", ")));
    }
    video.camera = static_cast<int>(camera - scene.cameras.begin());
  }
  video.fps = options.fps.value_or(video.fps);
  video.speed = options.speed.value_or(video.speed);
  if (!options.color_by.empty()) {
    video.color_by = color_named(options.color_by);
    video.color_range.reset();
  }
  // forces of contacts are not recorded
  video.contact_forces.reset();
  return video;
}

class Pictures {
 public:
  /// @param scene whose first film says how
  Pictures(const Scene& scene, const std::vector<std::string>& files) {
    for (const std::string& file : files) {
      const auto [name, time] = to_still(file);
      if (fs::path(name).extension() == ".png") {
        sinks_.push_back(std::make_unique<StillSink>(scene, time, name, name));
      } else if (file.ends_with('/')) {
        sinks_.push_back(std::make_unique<FrameSink>(scene, scene.videos[0], file, file));
      } else if (fs::path(file).extension() == ".mp4") {
        const std::string why_not = film_unavailable();
        if (!why_not.empty())
          throw OutputError(
              fmt::format("no film {}: {}; a name that ends in / has the frames", file, why_not),
              "E704");
        sinks_.push_back(std::make_unique<FilmSink>(scene, scene.videos[0], file, file));
      } else {
        throw UsageError(fmt::format(
            "'{}' ends in none of .png (a picture, .png@TIME), .mp4 (a film), / (its frames)",
            file));
      }
    }
  }

  void draw(const RecordedStates& states, const Scene& scene) {
    std::vector<SectionsAlong> along;
    for (const RodSpec& rod : scene.rods)
      along.emplace_back(rod, false);
    Snapshot before = state(states, along, 0);
    for (const auto& sink : sinks_)
      sink->begin(before);
    for (std::size_t k = 1; k < states.times().size() && stop_signal() == 0; ++k) {
      Snapshot now = state(states, along, k);
      for (const auto& sink : sinks_)
        sink->step(before, now);
      before = std::move(now);
    }
    for (const auto& sink : sinks_)
      sink->finish();
  }

  long frames() const {
    long count = 0;
    for (const auto& sink : sinks_)
      for (const WrittenFile& file : sink->files())
        count += file.count;
    return count;
  }

 private:
  /// With the curvature without load, which only the scene knows.
  static Snapshot state(const RecordedStates& states, const std::vector<SectionsAlong>& along,
                        std::size_t k) {
    Snapshot snapshot = states.at(k);
    for (std::size_t r = 0; r < along.size(); ++r)
      for (RodPoint& point : snapshot.rods[r].points)
        point.rest_curvature = along[r].rest_curvature(point.s);
    return snapshot;
  }

  std::vector<std::unique_ptr<Sink>> sinks_;
};

int render(const Scene& given, const std::string& recording, const RenderCommandOptions& options,
           const Console& console) {
  Scene scene = given;
  const VideoSpec video = video_of(scene, options);
  scene.videos = {video};
  const RecordedStates states(recording, scene);
  if (!states.scene_hash().empty() && states.scene_hash() != scene.hash)
    console.warn(recording + " was recorded of another version of this scene");
  Pictures pictures(scene, options.files);
  pictures.draw(states, scene);
  if (stop_signal() != 0) return 128 + stop_signal();
  if (console.json()) {
    const nlohmann::ordered_json json = {{"schema", "cprsim-render/1"},
                                         {"recording", recording},
                                         {"files", options.files},
                                         {"pictures", pictures.frames()}};
    write_to_stdout(json.dump(2) + "\n");
  }
  console.say(fmt::format("{}: {} states, wrote {}\n", recording, states.times().size(),
                          fmt::join(options.files, ", ")));
  return kExitDone;
}

}  // namespace

int render_command(const Words& words) {
  RenderCommandOptions options;
  CommandLine line(
      "cprsim render",
      "Draws what a run has recorded, without running again: .mp4 a film, .png a picture "
      "of the\nlast state, .png@TIME of another, a name that ends in / the frames of a "
      "film. The recording\nis an HDF5 file (<cprsim:record> with <hdf5/>), or the folder "
      "of a run that has one.\n\n"
      "Examples\n"
      "  cprsim render out/robot slow.mp4 --speed 0.1\n"
      "  cprsim render robot.h5 start.png@0 end.png --scene scene.xml --camera top\n"
      "  cprsim render out/robot moment.mp4 --color-by bending_moment");
  line.argument("RECORDING", options.source, "A run's folder, or an HDF5 file");
  line.arguments("FILE", options.files, "What to draw; its ending says as what", true);
  line.text("--scene", options.scene, "SCENE", "Of which it is (default: what run.json says)");
  line.text("--camera", options.camera, "NAME", "From which (default: the first film's)");
  line.text("--color-by", options.color_by, "QUANTITY",
            "Of rods: curvature, bending_moment, tension, strain_energy, none");
  const auto positive = [](double value) { return value > 0 && value < 1e6; };
  line.number("--fps", options.fps, "Frames per second of film", "between 0 and 1e6", positive);
  line.number("--speed", options.speed, "Simulated seconds per second of film", "between 0 and 1e6",
              positive);
  add_console_options(line, options.console);
  if (const auto code = line.parse(words)) return *code;
  const Console console(options.console);
  try {
    return complain_of(console, [&] {
      const Source found = find_recording(options);
      return answer(found.scene, SceneOptions{}, console, [&](const Scene& scene) {
        return render(scene, found.recording, options, console);
      });
    });
  } catch (const std::runtime_error& error) {  // of disk, graphics, encoder
    const OutputComplaint complaint(error);
    console.error(complaint.code, complaint.text);
    return kExitEnvironment;
  }
}

}  // namespace cprsim
