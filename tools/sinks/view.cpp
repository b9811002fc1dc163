// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/view.h"

namespace cprsim {

View::View(const Scene& scene, const VideoSpec& video)
    : scene_(scene), video_(video), decor_(decor_of(scene, video)) {}

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
