// SPDX-License-Identifier: BSD-3-Clause
#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "render/camera.h"
#include "render/drawing.h"
#include "render/egl_context.h"
#include "render/gl_painter.h"
#include "render/overlay.h"
#include "render/scenery.h"
#include "render/tiles.h"

namespace cprsim {

namespace {

constexpr int kLargestEdge = 16384;  // of a picture in Mesa's software renderer

bool has_light_background(const Backdrop& backdrop) {
  return Vec3(0.3, 0.59, 0.11).dot(backdrop.ground_color) > 0.45;
}

/// The camera stays where it is while only the scene's moving things move.
bool rests(const CameraSpec& camera, const std::vector<bool>& still) {
  if (camera.orbit_rate != 0) return false;
  if (!camera.look_at_frame || camera.look_at_frame->body < 0) return true;
  const auto body = static_cast<std::size_t>(camera.look_at_frame->body);
  return body < still.size() && still[body];
}

/// Puts a part of the picture in its place; `rows` come from the bottom and fill the region `from`.
void put(Image& image, const Region& part, const Region& from,
         const std::vector<std::uint8_t>& rows) {
  const auto bytes = [](int pixels) { return 4 * static_cast<std::size_t>(pixels); };
  for (int y = part.y0; y < part.y1; ++y) {
    std::memcpy(image.at(part.x0, image.height - 1 - y),
                rows.data() + bytes((y - from.y0) * from.width() + part.x0 - from.x0),
                bytes(part.width()));
  }
}

}  // namespace

struct Renderer::Parts {
  Parts(const Scene& described, int w, int h, const RenderOptions& wanted)
      : scene(described),
        options(wanted),
        width(w),
        height(h),
        visuals(make_parts(described)),
        still(still_bodies(described)) {}

  // GL objects are freed in their own context
  ~Parts() {
    if (context) context->make_current();
  }

  void settle(const Drawing& drawing);
  void grow_shadow_ball(const Ball& bounds);
  Image draw_anew(const Frame& frame);
  Image draw_moving(const Frame& frame);
  void store(const Frame& frame);
  bool is_stored(const Frame& frame) const;

  const Scene& scene;
  RenderOptions options;
  int width, height;  // of the picture, before supersampling
  std::vector<Part> visuals;
  std::vector<bool> still;
  std::unique_ptr<EglContext> context;
  std::unique_ptr<GlPainter> painter;
  std::unique_ptr<Overlay> overlay;

  // fixed by the first snapshot, so that nothing but the robot moves in a film
  bool settled = false;
  Ball bounds;
  Backdrop backdrop;
  Ball shadow_ball;

  // what store() was last called with
  std::unique_ptr<TileMap> tiles;
  View stored_view;
  Lighting stored_light;
  Ball stored_ball;
  std::vector<Pose> stored_poses;
  Image still_picture;

  std::vector<std::uint8_t> rows;
};

void Renderer::Parts::settle(const Drawing& drawing) {
  bounds = bounds_of(visuals, drawing);
  const double ground = ground_height(scene, visuals, drawing);
  backdrop = make_backdrop(scene, bounds, ground);
  shadow_ball = {bounds.centre, 1.1 * bounds.radius};
  overlay = std::make_unique<Overlay>(has_light_background(backdrop));
  settled = true;
}

void Renderer::Parts::grow_shadow_ball(const Ball& now) {
  const double needed = (now.centre - shadow_ball.centre).norm() + now.radius;
  // in large steps: every growth changes the grain of the shadows a little
  while (needed > 1.05 * shadow_ball.radius && std::isfinite(needed))
    shadow_ball.radius *= 1.4;
}

bool Renderer::Parts::is_stored(const Frame& frame) const {
  if (!tiles || !(frame.view == stored_view) || !(frame.light == stored_light)) return false;
  if (frame.shadow_ball.radius != stored_ball.radius) return false;
  for (std::size_t i = 0; i < visuals.size(); ++i) {
    const Pose &a = frame.drawing.part_poses[i], &b = stored_poses[i];
    // 1e-9: far below a pixel, far above the rounding of a solver that holds a body still
    if (!visuals[i].moves && ((a.R - b.R).norm() > 1e-9 || (a.p - b.p).norm() > 1e-9)) return false;
  }
  return true;
}

Image Renderer::Parts::draw_anew(const Frame& frame) {
  const TileMap map(frame.view, frame.backdrop.ground_z, painter->light_clip(frame));
  painter->paint(frame, map.changes(visuals, frame.drawing, GlPainter::softness()));
  const Region whole{0, 0, frame.view.width, frame.view.height};
  painter->read(whole, rows);
  Image image(whole.width(), whole.height());
  put(image, whole, whole, rows);
  return image;
}

void Renderer::Parts::store(const Frame& frame) {
  painter->store_still(frame);
  const Region whole{0, 0, frame.view.width, frame.view.height};
  std::vector<float> range;
  painter->read_still(rows, range);
  still_picture = Image(whole.width(), whole.height());
  put(still_picture, whole, whole, rows);
  tiles = std::make_unique<TileMap>(frame.view, range, painter->light_clip(frame));
  stored_view = frame.view;
  stored_light = frame.light;
  stored_ball = frame.shadow_ball;
  stored_poses = frame.drawing.part_poses;
}

Image Renderer::Parts::draw_moving(const Frame& frame) {
  if (!is_stored(frame)) store(frame);
  const Changes changes = tiles->changes(visuals, frame.drawing, GlPainter::softness());
  Image image = still_picture;
  if (changes.runs.empty()) return image;
  painter->paint_moving(frame, changes);
  painter->read(changes.all, rows);
  for (const TileRun& run : changes.runs)
    put(image, run.region, changes.all, rows);
  return image;
}

Renderer::Renderer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Renderer::~Renderer() = default;

FrameDecor decor_of(const Scene& scene, const VideoSpec& video) {
  FrameDecor decor;
  decor.scene_name = scene.name;
  decor.show_time = video.show_time;
  decor.speed = video.speed;
  decor.overlay = video.overlay;
  decor.color_by = video.color_by;
  decor.color_range = video.color_range;
  decor.contact_forces = video.contact_forces;
  for (const TraceSpec& trace : video.traces)
    decor.traces.push_back({{}, trace.seconds});
  return decor;
}

std::unique_ptr<Renderer> Renderer::create(const Scene& scene, int width, int height,
                                           const RenderOptions& options, std::string& why_not) {
  const int finer = std::clamp(options.supersample, 1, 4);
  if (width < 16 || height < 16 || width * finer > kLargestEdge || height * finer > kLargestEdge) {
    why_not = "a picture of " + std::to_string(width) + " x " + std::to_string(height) +
              " pixels cannot be drawn: each edge must be between 16 and " +
              std::to_string(kLargestEdge / finer);
    return nullptr;
  }
  try {
    auto parts = std::make_unique<Parts>(scene, width, height, options);
    parts->options.supersample = finer;
    parts->context = EglContext::create(why_not);
    if (!parts->context) return nullptr;
    parts->painter = std::make_unique<GlPainter>(
        parts->context->gl(), width * finer, height * finer,
        std::clamp(options.shadow_size, 64, 8192), scene.lights.size() > 1, parts->visuals);
    return std::unique_ptr<Renderer>(new Renderer(std::move(parts)));
  } catch (const std::runtime_error& error) {
    why_not = error.what();
    return nullptr;
  }
}

Image Renderer::draw(const Snapshot& now, const CameraSpec& camera, const FrameDecor& decor) {
  Parts& parts = *parts_;
  parts.context->make_current();
  const Vec2 range = decor.color_range
                         ? *decor.color_range
                         : range_of(decor.color_by, largest_value(decor.color_by, now));
  const Drawing drawing = make_drawing(parts.scene, parts.visuals, now, decor, range);
  if (!parts.settled) parts.settle(drawing);
  parts.grow_shadow_ball(bounds_of(parts.visuals, drawing));
  const int finer = parts.options.supersample;
  View view = make_view(camera, now, decor.film_time, 4 * parts.bounds.radius, parts.width * finer,
                        parts.height * finer);
  view.fineness = finer;
  const Frame frame{view, drawing, make_lighting(parts.scene, now, parts.bounds), parts.backdrop,
                    parts.shadow_ball};
  Image image =
      rests(camera, parts.still) && finer == 1 ? parts.draw_moving(frame) : parts.draw_anew(frame);
  if (finer > 1) image = shrink(image, finer);
  parts.overlay->draw(image, decor, now.time, range);
  return image;
}

std::string Renderer::device() const {
  return parts_->context->device();
}

CameraSpec camera_or_default(const Scene& scene, int camera, const Snapshot& now) {
  const auto i = static_cast<std::size_t>(camera);
  if (camera >= 0 && i < scene.cameras.size()) return scene.cameras[i];
  const std::vector<Part> visuals = make_parts(scene);
  const Ball bounds = bounds_of(visuals, make_drawing(scene, visuals, now, {}, Vec2(0, 1)));
  CameraSpec whole;
  whole.name = "default";
  whole.horizontal_fov = 0.6;
  whole.look_at = bounds.centre;
  // the ball and some room fit into the picture's smaller, vertical angle
  const double distance =
      0.92 * bounds.radius / std::sin(std::atan(std::tan(0.3) * whole.height / whole.width));
  whole.eye = bounds.centre + distance * Vec3(0.62, -0.70, 0.36).normalized();
  return whole;
}

void write_still(const std::string& path, const Scene& scene, const Snapshot& now,
                 const CameraSpec& camera, const FrameDecor& decor) {
  RenderOptions best;
  best.supersample = 2;
  best.shadow_size = 2048;
  std::string why_not;
  const std::unique_ptr<Renderer> renderer =
      Renderer::create(scene, camera.width, camera.height, best, why_not);
  if (!renderer) throw std::runtime_error(path + ": cannot draw: " + why_not);
  write_png(path, renderer->draw(now, camera, decor));
}

}  // namespace cprsim
