// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/view.h"

namespace cprsim {

View::View(const Scene& scene, const VideoSpec& video) : scene_(scene), video_(video) {
  decor_.scene_name = scene.name;
  decor_.show_time = video.show_time;
  decor_.speed = video.speed;
  decor_.overlay = video.overlay;
  decor_.color_by = video.color_by;
  decor_.color_range = video.color_range;
  for (const TraceSpec& trace : video.traces)
    decor_.traces.push_back({{}, trace.seconds});
}

void View::follow(const Snapshot& now) {
  for (std::size_t i = 0; i < decor_.traces.size(); ++i) {
    const auto point = traced_point(scene_, now, video_.traces[i].channel);
    if (point) decor_.traces[i].points.push_back({*point, now.time});
  }
}

const FrameDecor& View::decor_at(double film_time) {
  decor_.film_time = film_time;
  return decor_;
}

VideoSpec video_or_default(const Scene& scene) {
  if (!scene.videos.empty()) return scene.videos.front();
  VideoSpec video;
  if (!scene.cameras.empty()) video.camera = 0;
  return video;
}

}  // namespace cprsim
