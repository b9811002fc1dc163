// SPDX-License-Identifier: BSD-3-Clause
// Drawn as the scene's first video would show it, from the first camera if there is no video.
#include "tools/sinks/still_sink.h"

#include <utility>

namespace cprsim {

StillSink::StillSink(const Scene& scene, std::optional<double> time, std::filesystem::path file,
                     std::string name)
    : scene_(scene), time_(time), file_(std::move(file)), name_(std::move(name)) {
  decor_.scene_name = scene.name;
  if (!scene.cameras.empty()) camera_ = 0;
  if (scene.videos.empty()) return;
  const VideoSpec& video = scene.videos.front();
  camera_ = video.camera;
  decor_.show_time = video.show_time;
  decor_.overlay = video.overlay;
  decor_.color_by = video.color_by;
  decor_.color_range = video.color_range;
  for (const TraceSpec& trace : video.traces)
    decor_.traces.push_back({{}, trace.seconds});
}

void StillSink::begin(const Snapshot& start) {
  follow_traces(start);
  if (time_ && *time_ <= start.time) draw(start);
  last_ = start;
  begun_ = true;
}

void StillSink::step(const Snapshot&, const Snapshot& now) {
  if (drawn_) return;
  if (time_ && *time_ <= now.time) {
    const Snapshot instant = interpolate(last_, now, *time_);
    follow_traces(instant);
    draw(instant);
    return;
  }
  follow_traces(now);
  last_ = now;
}

void StillSink::finish() {
  if (begun_ && !drawn_) draw(last_);
}

void StillSink::follow_traces(const Snapshot& now) {
  for (std::size_t i = 0; i < decor_.traces.size(); ++i) {
    const auto point = traced_point(scene_, now, scene_.videos.front().traces[i].channel);
    if (point) decor_.traces[i].points.push_back({*point, now.time});
  }
}

void StillSink::draw(const Snapshot& snapshot) {
  decor_.film_time = snapshot.time;
  write_still(file_.string(), scene_, snapshot, camera_or_default(scene_, camera_, snapshot),
              decor_);
  drawn_ = true;
}

std::vector<WrittenFile> StillSink::files() const {
  if (!drawn_) return {};
  return {{name_, "still", 1}};
}

}  // namespace cprsim
