// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/outputs.h"

#include <algorithm>
#include <stdexcept>

#include "render/film.h"
#include "tools/cprsim/stopwatch.h"
#include "tools/sinks/film_sink.h"
#include "tools/sinks/frame_sink.h"
#include "tools/sinks/gltf_sink.h"
#include "tools/sinks/output_file.h"
#include "tools/sinks/recording.h"
#include "tools/sinks/still_sink.h"
#include "tools/sinks/vtk.h"

namespace cprsim {

namespace fs = std::filesystem;

namespace {

/// A file named on the command line, as reports call it: relative if it lies in the output folder.
std::string report_name(const fs::path& file, const fs::path& folder) {
  const fs::path absolute = fs::absolute(file).lexically_normal();
  const fs::path relative = absolute.lexically_relative(fs::absolute(folder).lexically_normal());
  const bool inside = !relative.empty() && *relative.begin() != "..";
  return (inside ? relative : absolute).string();
}

}  // namespace

// What cannot be drawn is no OutputError.
OutputComplaint::OutputComplaint(const std::runtime_error& error) : text(error.what()) {
  const auto* const output = dynamic_cast<const OutputError*>(&error);
  code = output != nullptr ? output->code() : "E704";
}

Outputs::Outputs(const Scene& scene, const RunOptions& options, const fs::path& folder,
                 const Console& console)
    : folder_(folder), expectations_(scene) {
  claimed_.emplace_back("run.json");
  if (!options.no_record) add_recordings(scene);
  add_stills(scene, options);
  if (!options.no_video) add_films(scene, options, console);
}

void Outputs::add_recordings(const Scene& scene) {
  for (const RecordSpec& spec : scene.records) {
    if (spec.csv) claim(spec.prefix + ".csv");
    if (spec.hdf5) claim(spec.prefix + ".h5");
    if (spec.npz) claim(spec.prefix + ".npz");
    if (spec.vtk_every > 0) claim(spec.prefix + ".pvd");
    if (spec.vtk_every > 0 && writes_contacts(scene)) claim(spec.prefix + "_contacts.pvd");
    sinks_.push_back(std::make_unique<Recording>(scene, spec, folder_));
    if (spec.gltf_fps > 0) {
      const std::string name = spec.prefix + ".glb";
      sinks_.push_back(std::make_unique<GltfSink>(scene, spec.gltf_fps, claim(name), name));
    }
  }
}

void Outputs::add_stills(const Scene& scene, const RunOptions& options) {
  for (const StillOption& still : options.stills) {
    sinks_.push_back(std::make_unique<StillSink>(scene, still.time, still.file,
                                                 report_name(still.file, folder_)));
  }
}

void Outputs::add_films(const Scene& scene, const RunOptions& options, const Console& console) {
  videos_ = scene.videos;
  const bool asked_for = !options.video.empty();
  if (asked_for && videos_.empty()) videos_.emplace_back();
  for (std::size_t i = 0; i < videos_.size(); ++i) {
    const bool replaced = asked_for && i == 0;
    const fs::path file = replaced ? fs::path(options.video) : claim(videos_[i].file);
    try {
      add_film(scene, videos_[i], file, replaced, console);
    } catch (const std::runtime_error& error) {
      if (replaced) throw;
      console.warn("W701", "no film " + file.string() + ": " + error.what());
    }
  }
}

void Outputs::add_film(const Scene& scene, const VideoSpec& video, const fs::path& file,
                       bool insist, const Console& console) {
  const std::string why_not = film_unavailable();
  if (why_not.empty() || insist) {
    auto film = std::make_unique<FilmSink>(scene, video, file, report_name(file, folder_));
    drawn_by_ = film->device();
    sinks_.push_back(std::move(film));
    return;
  }
  fs::path frames = file;
  frames.replace_extension();
  frames += "_frames";
  auto sink = std::make_unique<FrameSink>(scene, video, frames, report_name(frames, folder_));
  drawn_by_ = sink->device();
  sinks_.push_back(std::move(sink));
  console.warn("W701", why_not + "; writing the frames of " + file.string() +
                           " instead, to be encoded by\n  " + encode_command(video, frames, file));
}

fs::path Outputs::claim(const std::string& name) {
  const fs::path path(name);
  const bool leaves = path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end();
  if (name.empty() || leaves) {
    throw OutputError("the scene names the file '" + name + "', which is not in the output folder",
                      "E703");
  }
  if (std::find(claimed_.begin(), claimed_.end(), name) != claimed_.end()) {
    throw OutputError("the scene writes " + name + " twice; give its recordings other prefixes",
                      "E703");
  }
  claimed_.push_back(name);
  std::error_code error;
  fs::create_directories((folder_ / path).parent_path(), error);
  if (error) throw OutputError("cannot create the folder of " + name + ": " + error.message());
  return folder_ / path;
}

template <typename Act>
void Outputs::each(const Act& act) {
  for (const auto& sink : sinks_) {
    const PhaseTimer timer(clock_, sink->draws() ? Phase::kPictures : Phase::kRecording);
    act(*sink);
  }
}

void Outputs::begin(const Snapshot& start) {
  const Stopwatch watch;
  expectations_.begin(start);
  extremes_.begin(start);
  each([&](Sink& sink) { sink.begin(start); });
  seconds_ += watch.seconds();
}

void Outputs::resume(const Snapshot& now) {
  expectations_.resume(now);
  extremes_.resume(now);
  each([&](Sink& sink) { sink.resume(now); });
}

void Outputs::visit(Archive& archive) {
  expectations_.visit(archive);
  extremes_.visit(archive);
  for (const auto& sink : sinks_)
    sink->visit(archive);
}

void Outputs::step(const Snapshot& before, const Snapshot& now) {
  const Stopwatch watch;
  {
    const PhaseTimer timer(clock_, Phase::kRecording);
    expectations_.step(before, now);
    extremes_.step(before, now);
  }
  each([&](Sink& sink) { sink.step(before, now); });
  seconds_ += watch.seconds();
}

OutputComplaint Outputs::finish() {
  const Stopwatch watch;
  OutputComplaint complaint;
  std::vector<std::unique_ptr<Sink>> finished;
  for (auto& sink : sinks_) {
    try {
      const PhaseTimer timer(clock_, sink->draws() ? Phase::kPictures : Phase::kRecording);
      sink->finish();
      finished.push_back(std::move(sink));
    } catch (const std::runtime_error& error) {
      if (complaint.text.empty()) complaint = OutputComplaint(error);
    }
  }
  sinks_ = std::move(finished);
  seconds_ += watch.seconds();
  return complaint;
}

std::vector<WrittenFile> Outputs::files() const {
  std::vector<WrittenFile> files;
  for (const auto& sink : sinks_) {
    for (WrittenFile& file : sink->files())
      files.push_back(std::move(file));
  }
  return files;
}

}  // namespace cprsim
