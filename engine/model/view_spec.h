// SPDX-License-Identifier: BSD-3-Clause
// Cameras, lights and films.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/body_spec.h"
#include "engine/model/place.h"

namespace cprsim {

struct CameraSpec {
  std::string name;
  Place place;
  Vec3 eye{1, -1, 0.8};
  std::optional<FrameRef> look_at_frame;  ///< follows this frame; look_at is then in its axes
  Vec3 look_at = Vec3::Zero();
  Vec3 up = Vec3::UnitZ();
  double horizontal_fov = 1.0;  ///< rad
  int width = 1280, height = 720;
  double orbit_rate = 0;  ///< rad/s about `up` through look_at, in film time
};

enum class LightKind { kDirectional, kPoint, kSpot };

struct LightSpec {
  std::string name;
  Place place;
  LightKind kind = LightKind::kDirectional;
  FrameRef at;
  Vec3 direction{0, 0, -1};  ///< in the axes of `at`
  Vec3 diffuse{1, 1, 1}, specular{0.2, 0.2, 0.2};
  double intensity = 1;
  bool cast_shadows = false;
};

enum class ColorBy { kNone, kBendingMoment, kCurvature, kTension, kStrainEnergy };

struct TraceSpec {
  std::string channel;  ///< a position channel, e.g. robot::platform.position
  double seconds = 0;   ///< 0: the whole run
};

struct VideoSpec {
  Place place;
  std::string file;
  int camera = -1;  ///< index into Scene::cameras
  double fps = 30, speed = 1;
  std::vector<TraceSpec> traces;
  ColorBy color_by = ColorBy::kNone;
  std::optional<Vec2> color_range;
  bool show_time = true;
  std::string overlay;                   ///< extra caption
  std::optional<double> contact_forces;  ///< as arrows, m/N
};

struct EnvironmentSpec {
  Vec3 ambient{0.4, 0.4, 0.4};
  Vec3 background{0.7, 0.7, 0.7};
  bool background_set = false;
  bool shadows = true;
  bool grid = true;
};

}  // namespace cprsim
