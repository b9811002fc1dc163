// SPDX-License-Identifier: BSD-3-Clause
// How a video shows the scene: camera, colours, captions, and the traces drawn so far.
#pragma once

#include "engine/model/scene.h"
#include "render/renderer.h"

namespace cprsim {

class View {
 public:
  View(const Scene& scene, const VideoSpec& video);

  /// Lengthens the traces to where their points are now.
  void follow(const Snapshot& now);

  CameraSpec camera(const Snapshot& now) const {
    return camera_or_default(scene_, video_.camera, now);
  }

  const VideoSpec& video() const { return video_; }

  /// @param film_time s of film, turns an orbiting camera
  const FrameDecor& decor_at(double film_time);

 private:
  const Scene& scene_;
  VideoSpec video_;
  FrameDecor decor_;
};

/// The scene's first video, or one from its first camera.
VideoSpec video_or_default(const Scene& scene);

}  // namespace cprsim
