// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/frame_sink.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "tools/sinks/csv.h"
#include "tools/sinks/output_file.h"

namespace cprsim {

namespace {

/// As for recordings: steps add up to k speed / fps only up to rounding (in frames).
constexpr double kRoundOff = 1e-9;

std::string frame_name(long frame) {
  const std::string digits = std::to_string(frame);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits + ".png";
}

}  // namespace

FrameSink::FrameSink(const Scene& scene, const VideoSpec& video, std::filesystem::path folder,
                     std::string name)
    : view_(scene, video), folder_(std::move(folder)), name_(std::move(name) + "/") {
  const auto index = static_cast<std::size_t>(video.camera);
  const CameraSpec camera = video.camera < 0 ? CameraSpec{} : scene.cameras.at(index);
  std::string why_not;
  // H.264 wants even sizes
  renderer_ = Renderer::create(scene, camera.width & ~1, camera.height & ~1, {}, why_not);
  if (renderer_ == nullptr) throw std::runtime_error(why_not);
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw OutputError("cannot create " + folder_.string() + ": " + error.message());
}

void FrameSink::begin(const Snapshot& start) {
  draw(start);
}

void FrameSink::resume(const Snapshot& now) {
  const double period = view_.video().speed / view_.video().fps;
  frames_ = static_cast<long>(std::floor(now.time / period + kRoundOff)) + 1;
}

void FrameSink::step(const Snapshot& before, const Snapshot& now) {
  const double period = view_.video().speed / view_.video().fps;
  while (static_cast<double>(frames_) * period <= now.time + kRoundOff * period) {
    draw(interpolate(before, now, static_cast<double>(frames_) * period));
  }
}

void FrameSink::draw(const Snapshot& snapshot) {
  view_.follow(snapshot);
  const double film_time = static_cast<double>(frames_) / view_.video().fps;
  const Image image = renderer_->draw(snapshot, view_.camera(snapshot), view_.decor_at(film_time));
  write_png((folder_ / frame_name(frames_)).string(), image);
  ++frames_;
}

std::vector<WrittenFile> FrameSink::files() const {
  return {{name_, "frames", frames_}};
}

std::string encode_command(const VideoSpec& video, const std::filesystem::path& folder,
                           const std::filesystem::path& film) {
  return "ffmpeg -framerate " + shortest(video.fps) + " -i '" + (folder / "%06d.png").string() +
         "' -c:v libx264 -pix_fmt yuv420p -movflags +faststart '" + film.string() + "'";
}

}  // namespace cprsim
