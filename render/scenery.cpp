// SPDX-License-Identifier: BSD-3-Clause
#include "render/scenery.h"

#include <algorithm>
#include <cmath>

namespace cprsim {

namespace {

Pose pose_in_world(const FrameRef& frame, const Snapshot& now) {
  const auto body = static_cast<std::size_t>(frame.body);
  if (frame.body < 0 || body >= now.bodies.size()) return frame.X_BF;
  return now.bodies[body].X_WB * frame.X_BF;
}

/// A far light shines along its direction; a near one is taken as shining from where it is on the
/// middle.
Vec3 towards(const LightSpec& light, const Pose& X_WL, const Vec3& middle) {
  Vec3 d = light.kind == LightKind::kDirectional ? Vec3(-(X_WL.R * light.direction))
                                                 : Vec3(X_WL.p - middle);
  return d.norm() > 1e-9 ? Vec3(d.normalized()) : Vec3::UnitZ();
}

std::size_t key_light(const std::vector<LightSpec>& lights) {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].kind == LightKind::kDirectional && lights[i].cast_shadows) return i;
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].cast_shadows) return i;
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].kind == LightKind::kDirectional) return i;
  }
  return 0;
}

}  // namespace

bool Lighting::operator==(const Lighting& o) const {
  const auto same = [](const Other& a, const Other& b) {
    return a.place == b.place && a.axis == b.axis && a.color == b.color;
  };
  return to_key == o.to_key && key_color == o.key_color && ambient_up == o.ambient_up &&
         ambient_down == o.ambient_down && shadows == o.shadows &&
         std::equal(others.begin(), others.end(), o.others.begin(), o.others.end(), same);
}

Lighting make_lighting(const Scene& scene, const Snapshot& now, const Ball& bounds) {
  constexpr double kSpotCosine = 0.87;  // a spot's half angle of 30°, as SDF's usual outer angle
  Lighting light;
  light.shadows = scene.environment.shadows;
  const Vec3 ambient = scene.environment.ambient.cwiseMax(0.05).cwiseMin(0.9);
  // light from above is a little cooler than what the floor throws back
  light.ambient_up = 1.15 * ambient.cwiseProduct(Vec3(0.97, 1.0, 1.05));
  light.ambient_down = 0.62 * ambient.cwiseProduct(Vec3(1.04, 1.0, 0.95));
  std::vector<LightSpec> lights = scene.lights;
  if (lights.empty()) {
    LightSpec sun;
    sun.direction = Vec3(-0.45, 0.35, -0.85);
    lights.push_back(sun);
  }
  const std::size_t key = key_light(lights);
  double direct = 0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Pose X_WL = pose_in_world(lights[i].at, now);
    const Vec3 color = lights[i].diffuse * std::max(lights[i].intensity, 0.0);
    const Vec3 to_light = towards(lights[i], X_WL, bounds.centre);
    direct += color.maxCoeff();
    if (i == key) {
      light.to_key = to_light;
      light.key_color = color;
      continue;
    }
    if (light.others.size() >= 4) continue;
    Lighting::Other other;
    const bool far = lights[i].kind == LightKind::kDirectional;
    other.place << (far ? to_light : X_WL.p), (far ? 0.0 : 1.0);
    other.axis << (X_WL.R * lights[i].direction).normalized(),
        (lights[i].kind == LightKind::kSpot ? kSpotCosine : -2.0);
    other.color = color;
    light.others.push_back(other);
  }
  // what the ambient light leaves of full white is shared among the lights
  const double room = std::max(1.08 - light.ambient_up.maxCoeff(), 0.15);
  const double scale = direct > 0 ? room / std::max(direct, 0.5) : 0;
  light.key_color *= scale;
  for (Lighting::Other& other : light.others)
    other.color *= scale;
  return light;
}

Backdrop make_backdrop(const Scene& scene, const Ball& bounds, double ground_z) {
  Backdrop backdrop;
  backdrop.ground_z = ground_z;
  backdrop.grid = scene.environment.grid;
  backdrop.cell = nice_ceiling(bounds.radius / 3.5);
  backdrop.fade_from = 1.6 * bounds.radius;
  backdrop.fade_to = 9 * bounds.radius;
  backdrop.middle = bounds.centre;
  backdrop.ground_color = {0.80, 0.81, 0.825};
  backdrop.line_shade = -0.16;
  backdrop.horizon_color = {0.93, 0.945, 0.96};
  backdrop.zenith_color = {0.52, 0.64, 0.80};
  if (scene.environment.background_set) {
    const Vec3 color = scene.environment.background.cwiseMax(0).cwiseMin(1);
    backdrop.zenith_color = color;
    if (color.maxCoeff() < 0.4) backdrop.line_shade = 0.6;
    backdrop.horizon_color = 0.65 * color + 0.35 * Vec3::Ones() * color.maxCoeff();
    // near black, shadows would not show
    backdrop.ground_color = 0.8 * backdrop.horizon_color + Vec3::Constant(0.08);
  }
  return backdrop;
}

}  // namespace cprsim
