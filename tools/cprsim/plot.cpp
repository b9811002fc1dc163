// SPDX-License-Identifier: BSD-3-Clause
// cprsim plot: recordings, or scenes simulated for the purpose, as pictures.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "tools/cprsim/commands.h"
#include "tools/cprsim/exit_code.h"
#include "tools/cprsim/gnuplot.h"
#include "tools/cprsim/interrupt.h"
#include "tools/cprsim/output_folder.h"
#include "tools/cprsim/plot_heat.h"
#include "tools/cprsim/plot_panels.h"
#include "tools/cprsim/quiet_run.h"
#include "tools/cprsim/study_command.h"
#include "tools/cprsim/trajectory_match.h"
#include "tools/series/read_series.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

namespace fs = std::filesystem;

constexpr int kSamples = 1000;
constexpr int kHeatInstants = 201;

struct PlotOptions {
  ConsoleOptions console;
  SceneOptions scene;
  std::vector<std::string> sources, channels, paths, formats;
  std::string output, plane;
  std::string heat;  ///< a quantity of sections; empty: none
  bool energy = false, solver = false;
  int shapes = 0;

  bool whole_rods() const { return shapes > 0 || !heat.empty(); }
};

/// What a recording does not hold: rods from base to tip.
struct WholeRods {
  std::vector<RodShape> shapes;
  std::vector<HeatMap> heat;
};

/// Looks at evenly spaced instants of a run from its start to its end.
class Glances {
 public:
  using Look = std::function<void(const Snapshot& snapshot, double time)>;

  Glances(double end, int count, Look look) : end_(end), count_(count), look_(std::move(look)) {}

  void step(const Snapshot& before, const Snapshot& now) {
    for (; next_ < count_ && now.time >= due() * (1 - 1e-9); ++next_) {
      const double t = due();
      look_(t > before.time && t < now.time ? interpolate(before, now, t) : now, t);
    }
  }

 private:
  double due() const { return count_ > 1 ? end_ * next_ / (count_ - 1) : 0; }

  double end_;
  int count_, next_ = 0;
  Look look_;
};

bool is_scene(const std::string& path) {
  const std::string extension = fs::path(path).extension();
  return extension == ".xml" || extension == ".sdf" || extension == ".world";
}

/// What the picture shows, as channel names.
std::vector<std::string> wanted(const PlotOptions& options) {
  std::vector<std::string> names = options.channels;
  if (options.energy) names.emplace_back("energy.*");
  if (options.solver)
    for (const char* name : {"solver.step", "solver.iterations", "solver.residual"})
      names.emplace_back(name);
  names.insert(names.end(), options.paths.begin(), options.paths.end());
  return names;
}

std::vector<Channel> channels_for(const Scene& scene, const PlotOptions& options) {
  std::vector<Channel> channels;
  std::vector<std::string> names = wanted(options);
  if (names.empty())
    for (const RecordSpec& record : scene.records)
      channels.insert(channels.end(), record.channels.begin(), record.channels.end());
  for (const std::string& name : names) {
    const auto found = find_channels(scene, name);
    if (found.empty())
      throw UsageError(fmt::format("there is no channel '{}'; near it: {}", name,
                                   fmt::join(nearest_channels(scene, name), ", ")));
    channels.insert(channels.end(), found.begin(), found.end());
  }
  if (channels.empty() && !options.whole_rods())
    throw UsageError("the scene records nothing: name channels with -c");
  return channels;
}

/// The rods of a snapshot.
void add_shapes(const Scene& scene, const Snapshot& snapshot, double time,
                std::vector<RodShape>& shapes) {
  for (std::size_t r = 0; r < snapshot.rods.size(); ++r) {
    constexpr int kPoints = 41;
    RodShape shape{scene.rods[r].name, time, MatX(3, kPoints)};
    for (int k = 0; k < kPoints; ++k)
      shape.points.col(k) =
          point_at(snapshot.rods[r], static_cast<double>(k) / (kPoints - 1)).position;
    shapes.push_back(std::move(shape));
  }
}

/// Simulates the scene for its picture.
PlotSource simulate(const Scene& scene, const std::string& label, const PlotOptions& options,
                    WholeRods& rods) {
  const double end = scene.simulation.mode == Mode::kStatic ? 0 : scene.simulation.duration;
  std::vector<double> instants{0};
  for (int k = 1; k <= kSamples && end > 0; ++k)
    instants.push_back(end * k / kSamples);
  SeriesRecorder recorder(scene, channels_for(scene, options), instants);
  Glances shapes(end, options.shapes, [&](const Snapshot& snapshot, double time) {
    add_shapes(scene, snapshot, time, rods.shapes);
  });
  std::vector<std::string> names;
  for (const RodSpec& rod : scene.rods)
    names.push_back(rod.name);
  Glances heat(end, options.heat.empty() ? 0 : kHeatInstants,
               [&](const Snapshot& snapshot, double time) {
                 add_heat(names, snapshot, time, *find_section_quantity(options.heat), rods.heat);
               });
  const Onlooker onlooker{[&](const Snapshot& start) {
                            recorder.begin(start);
                            shapes.step(start, start);
                            heat.step(start, start);
                          },
                          [&](const Snapshot& before, const Snapshot& now) {
                            recorder.step(before, now);
                            shapes.step(before, now);
                            heat.step(before, now);
                          }};
  const QuietRun run = run_quietly(scene, onlooker, [] { return stop_signal() != 0; });
  if (run.status == RunStatus::kFailed)
    throw NoEquilibrium(fmt::format("{} failed at t = {:.6g} s: {}", label, run.time, run.failure));
  return {label, recorder.series()};
}

PlotSource read(const std::string& path) {
  if (!fs::is_directory(path)) return {fs::path(path).stem().string(), read_series(path)};
  const RecordedRun run = read_run(path);
  if (run.recordings.size() > 1)
    throw UsageError(path +
                     " holds several recordings; name one of them: " + run.recordings[0].path);
  const std::string folder = fs::path(path).lexically_normal().filename().string();
  return {folder.empty() ? run.label : folder, run.recordings[0]};
}

std::string script_for(const std::vector<PlotSource>& sources, const WholeRods& rods,
                       const PlotOptions& options) {
  if (options.shapes > 0) return shape_script(rods.shapes, options.plane);
  if (!options.heat.empty()) return heat_script(rods.heat, *find_section_quantity(options.heat));
  if (!options.paths.empty()) return path_script(sources, options.paths, options.plane);
  const auto panels = time_panels(sources, wanted(options));
  if (!panels.empty()) return time_script(sources, panels);
  std::vector<std::string> names;
  for (const PlotSource& source : sources)
    for (const SeriesQuantity& quantity : quantities_of(source.series))
      names.push_back(quantity.name);
  throw UsageError(
      fmt::format("nothing to draw: recorded are {}; what was not recorded can be drawn "
                  "from the scene itself",
                  fmt::join(names, ", ")));
}

int draw(const std::vector<PlotSource>& sources, const WholeRods& rods, const PlotOptions& options,
         const Console& console) {
  const std::string script = script_for(sources, rods, options);
  const OutputFolder folder(choose_output_folder(options.output, sources[0].label + "_plot"),
                            {"plot.json", "cprsim-plot/"});
  std::vector<std::string> files{"plot.gp"};
  if (options.shapes > 0) {
    write_file(folder.path() / "shapes.csv", table_of(rods.shapes));
    files.emplace_back("shapes.csv");
  } else if (!options.heat.empty()) {
    write_file(folder.path() / "heat.csv",
               table_of(rods.heat, *find_section_quantity(options.heat)));
    files.emplace_back("heat.csv");
  } else {
    for (std::size_t s = 0; s < sources.size(); ++s) {
      files.push_back(fmt::format("source_{}.csv", s + 1));
      write_file(folder.path() / files.back(), table_of(sources[s].series));
    }
  }
  const auto formats = options.formats.empty() ? std::vector<std::string>{"svg"} : options.formats;
  for (const std::string& format : formats)
    files.push_back("plot." + format);
  nlohmann::ordered_json report = {{"schema", "cprsim-plot/1"},
                                   {"sources", options.sources},
                                   {"files", nlohmann::json::array()}};
  for (const std::string& file : files)
    report["files"].push_back({{"name", file}});
  write_file(folder.path() / "plot.json", report.dump(2) + "\n");
  if (!draw_with_gnuplot(folder.path(), "plot", script, console, formats)) return kExitEnvironment;
  if (console.json()) write_to_stdout(report.dump(2) + "\n");
  console.say(fmt::format("{}: wrote {}/plot.{}\n", sources[0].label, folder.path().string(),
                          fmt::join(formats, "," + std::string("plot."))));
  return kExitDone;
}

int plot(const PlotOptions& options, const Console& console) {
  std::vector<PlotSource> sources;
  WholeRods rods;
  for (const std::string& path : options.sources) {
    if (!is_scene(path)) {
      if (options.whole_rods())
        throw UsageError(std::string(options.shapes > 0 ? "--shapes" : "--heat") +
                         " needs a scene: recordings hold channels, not whole rods");
      sources.push_back(read(path));
      continue;
    }
    const LoadedScene loaded = load_and_show(path, options.scene, console);
    if (loaded.scene == nullptr) return kExitSceneInvalid;
    if (!options.heat.empty() && (loaded.scene->rods.empty() || options.sources.size() > 1 ||
                                  loaded.scene->simulation.mode == Mode::kStatic))
      throw UsageError("--heat needs one scene, with rods and a duration");
    watch_pairs(*loaded.scene, channels_for(*loaded.scene, options));
    sources.push_back(simulate(*loaded.scene, label_of(path, *loaded.scene), options, rods));
    if (stop_signal() != 0) return 128 + stop_signal();
  }
  return draw(sources, rods, options, console);
}

void check_words(const PlotOptions& options) {
  const int kinds = (options.shapes > 0 ? 1 : 0) + (options.heat.empty() ? 0 : 1) +
                    (options.paths.empty() ? 0 : 1) +
                    (!options.channels.empty() || options.energy || options.solver ? 1 : 0);
  if (kinds > 1)
    throw UsageError("--shapes, --heat, --path and curves over time are different pictures");
  if (!options.heat.empty() && find_section_quantity(options.heat) == nullptr)
    throw UsageError("--heat: '" + options.heat + "' is none of " + section_quantities());
  for (const std::string& format : options.formats)
    if (format != "svg" && format != "png" && format != "pdf")
      throw UsageError("--format: '" + format + "' is none of svg, png, pdf");
  const bool plane = options.plane.empty() || options.plane == "xy" || options.plane == "xz" ||
                     options.plane == "yz";
  if (!plane) throw UsageError("--plane: '" + options.plane + "' is none of xy, xz, yz");
}

}  // namespace

int plot_command(const Words& words) {
  PlotOptions options;
  CommandLine line(
      "cprsim plot",
      "Draws what runs recorded, several over each other; a scene is simulated for it.\n\n"
      "Examples\n"
      "  cprsim plot out/planar\n"
      "  cprsim plot a b reference.csv -c robot::platform.position --format svg,pdf\n"
      "  cprsim plot out/planar --path robot::platform.position\n"
      "  cprsim plot scene.xml --energy\n"
      "  cprsim plot scene.xml --shapes 12\n"
      "  cprsim plot scene.xml --heat curvature");
  line.arguments("SOURCE", options.sources, "Folders of runs, CSV, HDF5 or TUM files, scenes",
                 true);
  line.list("-c,--channel", options.channels, "CHANNEL",
            "Over time (default: all that is recorded)");
  line.list("--path", options.paths, "POSITION", "The path of a position in a plane");
  line.flag("--energy", options.energy, "All energies, and their balance");
  line.flag("--solver", options.solver, "Steps, iterations and residuals of the solver");
  line.count("--shapes", options.shapes, 1, "All rods at so many instants; needs a scene");
  line.text("--heat", options.heat, "QUANTITY",
            "Along rods and over time: " + section_quantities() + "; needs a scene");
  line.text("--plane", options.plane, "PLANE", "xy, xz or yz (default: the widest)");
  line.list("--format", options.formats, "WHICH", "svg (default), png, pdf");
  line.text("-o,--output", options.output, "DIR", "Folder (default out/<source>_plot)");
  add_scene_options(line, options.scene);
  add_console_options(line, options.console);
  if (const auto code = line.parse(words)) return *code;
  const Console console(options.console);
  return complain_of(console, [&] {
    check_words(options);
    return plot(options, console);
  });
}

}  // namespace cprsim
