// SPDX-License-Identifier: BSD-3-Clause
// Snapshots to pictures, off-screen and without a display: the door of this folder for the tools.
// See also render/film.h (images to a video file) and render/film_recorder.h (a run to a video
// file).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "engine/run/snapshot.h"
#include "render/image.h"

namespace cprsim {

struct RenderOptions {
  /// Pixels are drawn as supersample × supersample finer ones and averaged (1 or 2), on top of
  /// 4 samples a pixel. A film takes 1, a still 2.
  int supersample = 1;
  int shadow_size = 512;  ///< edge of the shadow map in texels
};

/// The path a point has drawn, oldest first.
struct TraceLine {
  struct Point {
    Vec3 position;
    double time = 0;
  };

  std::vector<Point> points;
  double seconds = 0;  ///< points older than this have faded away; 0: the line stays whole
};

/// What is shown beside the robot itself. The time shown is that of the snapshot.
struct FrameDecor {
  std::string scene_name;  ///< empty: no title
  bool show_time = true;
  double speed = 1;  ///< shown if it is not 1
  std::string overlay;
  std::vector<TraceLine> traces;
  ColorBy color_by = ColorBy::kNone;
  std::optional<Vec2>
      color_range;       ///< empty: from this snapshot alone, rounded up to a 1-2-5 number
  double film_time = 0;  ///< s of film, turns an orbiting camera
  std::optional<double> contact_forces;  ///< as arrows, m/N
};

/// As a scene's film asks for, its traces still empty.
FrameDecor decor_of(const Scene& scene, const VideoSpec& video);

/// Draws one scene; lives and is used in one thread (it owns an OpenGL context).
class Renderer {
 public:
  /// @return nullptr if this machine cannot draw; why_not then says what is missing, naming
  /// packages
  static std::unique_ptr<Renderer> create(const Scene& scene, int width, int height,
                                          const RenderOptions& options, std::string& why_not);
  ~Renderer();

  Image draw(const Snapshot& now, const CameraSpec& camera, const FrameDecor& decor);

  std::string device() const;  ///< what draws, e.g. "llvmpipe (LLVM 15.0.6, 256 bits)"

 private:
  struct Parts;
  explicit Renderer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// The camera of index `camera`, or one that shows the whole of the scene if there is none.
CameraSpec camera_or_default(const Scene& scene, int camera, const Snapshot& now);

/// Draws one picture in best quality and writes it as PNG, in the camera's size.
/// Throws std::runtime_error if the machine cannot draw or the file cannot be written.
void write_still(const std::string& path, const Scene& scene, const Snapshot& now,
                 const CameraSpec& camera, const FrameDecor& decor);

/// A trace's next point: where the position channel `channel` (e.g. robot::platform.position) is
/// now. Empty if the scene has no such point.
std::optional<Vec3> traced_point(const Scene& scene, const Snapshot& now,
                                 const std::string& channel);

}  // namespace cprsim
